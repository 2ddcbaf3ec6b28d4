// Colorize: the film's facts through a view, a range and a colour map or tone map.
#include "tracer/render/colorize.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "tracer/choice.h"
#include "tracer/error.h"
#include "tracer/render/colormap.h"
#include "tracer/render/tone_map.h"
#include "tracer/render/value_scale.h"
#include "tracer/render/views.h"

namespace tracer {
namespace {

constexpr int color_steps = 1024;
constexpr int max_bars = 64;
constexpr uint32_t not_traced = 0xff202020u;

// The rows that the options name.
struct Chosen {
  const ViewRow& view;
  const CounterRow& counter;
  const ColormapRow& colormap;
  const ToneMapRow& tone_map;
  int ray_class;  // ray_class_count: all
};

template <class Row>
const Row& row_of(std::span<const Row> rows, std::string_view id, std::string_view kind) {
  if (const Row* row = find_row(rows, id)) return *row;
  throw Error(fmt::format("unknown {} '{}'; known: {}", kind, id, known_ids(rows)));
}

int ray_class_of(std::string_view id) {
  if (id == "all") return ray_class_count;
  const std::span<const RayClassRow> rows = ray_classes();
  const RayClassRow* row = find_row(rows, id);
  if (row == nullptr) {
    throw Error(fmt::format("unknown ray class '{}'; known: all, {}", id, known_ids(rows)));
  }
  return int(row - rows.data());
}

Chosen chosen(const ViewOptions& options) {
  return {row_of(views(), options.view, "view"), row_of(counters(), options.counter, "counter"),
          row_of(colormaps(), options.colormap, "colour map"),
          row_of(tone_maps(), options.tone_map, "tone map"), ray_class_of(options.ray_class)};
}

uint32_t checkerboard(int x, int y) {
  return (x >> 3 ^ y >> 3) & 1 ? 0xff5c5c5cu : 0xff484848u;
}

uint32_t pack(const vec3& srgb) {
  const vec3 bytes = glm::clamp(srgb, vec3(0.0f), vec3(1.0f)) * 255.0f + 0.5f;
  return 0xff000000u | uint32_t(bytes.z) << 16 | uint32_t(bytes.y) << 8 | uint32_t(bytes.x);
}

struct TileArea {
  int x0, y0, x1, y1;
};
TileArea area(const Film& film, size_t tile) {
  const int columns = tile_columns(film.width);
  const int x0 = int(tile % columns) * tile_size;
  const int y0 = int(tile / columns) * tile_size;
  return {x0, y0, std::min(x0 + tile_size, film.width), std::min(y0 + tile_size, film.height)};
}

// Calls `sample(index, block)` once for every sample of a tile, with the block of pixels that shows
// it; not at all if nothing was traced there yet.
template <class Sample>
void for_each_sample(const Film& film, size_t tile, const Sample& sample) {
  if (!film.tiles[tile] || !film.tiles[tile]->facts) return;
  const int stride = film.tiles[tile]->facts->stride;
  const TileArea all = area(film, tile);
  size_t index = 0;
  for (int y = all.y0; y < all.y1; y += stride) {
    for (int x = all.x0; x < all.x1; x += stride) {
      sample(index++, TileArea{x, y, std::min(x + stride, all.x1), std::min(y + stride, all.y1)});
    }
  }
}

ViewPixel view_pixel(const ViewInput& input, const TileFacts& facts, size_t sample, int x, int y) {
  return {input, x, y, facts.hits[sample], facts.counters[sample], facts.depth[sample]};
}

template <class Value>
void fill(std::vector<Value>& plane, int width, const TileArea& block, Value value) {
  for (int y = block.y0; y < block.y1; ++y) {
    Value* row = &plane[size_t(y) * width];
    for (int x = block.x0; x < block.x1; ++x)
      row[x] = value;
  }
}

void show_radiance(const Film& film, const Chosen& rows, float exposure, Image& image) {
  const DisplayCurve curve(rows.tone_map, exposure);
  tbb::parallel_for(size_t(0), film.tiles.size(), [&](size_t tile) {
    for_each_sample(film, tile, [&](size_t sample, const TileArea& block) {
      fill(image.pixels, image.width, block, curve(radiance_at(*film.tiles[tile], sample)));
    });
  });
}

void checker(Image& image, const TileArea& block) {
  for (int y = block.y0; y < block.y1; ++y) {
    for (int x = block.x0; x < block.x1; ++x) {
      image.pixels[size_t(y) * image.width + x] = checkerboard(x, y);
    }
  }
}

void show_colors(const Film& film, const Chosen& rows, const ViewInput& input, Image& image) {
  tbb::parallel_for(size_t(0), film.tiles.size(), [&](size_t tile) {
    for_each_sample(film, tile, [&](size_t sample, const TileArea& block) {
      const TileFacts& facts = *film.tiles[tile]->facts;
      if (!is_hit(facts.hits[sample])) return checker(image, block);
      const ViewPixel pixel = view_pixel(input, facts, sample, block.x0, block.y0);
      fill(image.pixels, image.width, block, pack(rows.view.color(pixel)));
    });
  });
}

// The values of one tile or of all; pixels without a value left out.
struct Summary {
  float lo = infinity;
  float hi = -infinity;
  double sum = 0.0;
  uint64_t values = 0;
};

// NaN where there is no value, also where nothing was traced yet.
std::vector<float> values_of(const Film& film, const Chosen& rows, const ViewInput& input,
                             Summary& summary) {
  std::vector<float> values(size_t(film.width) * film.height,
                            std::numeric_limits<float>::quiet_NaN());
  std::vector<Summary> summaries(film.tiles.size());
  tbb::parallel_for(size_t(0), film.tiles.size(), [&](size_t tile) {
    Summary mine;
    for_each_sample(film, tile, [&](size_t sample, const TileArea& block) {
      const TileFacts& facts = *film.tiles[tile]->facts;
      const float value = rows.view.value(view_pixel(input, facts, sample, block.x0, block.y0));
      if (!std::isfinite(value)) return;
      fill(values, film.width, block, value);
      const int pixels = (block.x1 - block.x0) * (block.y1 - block.y0);
      mine.lo = std::min(mine.lo, value);
      mine.hi = std::max(mine.hi, value);
      mine.sum += double(value) * pixels;
      mine.values += pixels;
    });
    summaries[tile] = mine;
  });
  // In the order of the tiles: the sum is the same for any number of threads.
  for (const Summary& tile : summaries) {
    summary.lo = std::min(summary.lo, tile.lo);
    summary.hi = std::max(summary.hi, tile.hi);
    summary.sum += tile.sum;
    summary.values += tile.values;
  }
  return values;
}

// Smallest to largest. A few pixels with many times the cost of all others would leave the rest
// dark: then the range ends at the value that 99.5 % of the pixels do not exceed, unless the range
// is short enough for a field of its own for each number.
ValueRange fitted(const std::vector<float>& values, const ValueRange& range, bool counts) {
  constexpr size_t step = 7;  // looking at each seventh pixel is enough
  if (counts && range.hi <= 16.0f) return range;
  std::vector<float> some;
  some.reserve(values.size() / step + 1);
  for (size_t i = 0; i < values.size(); i += step) {
    if (std::isfinite(values[i])) some.push_back(values[i]);
  }
  if (some.empty()) return range;
  const auto high = some.begin() + ptrdiff_t(0.995 * double(some.size() - 1));
  std::nth_element(some.begin(), high, some.end());
  const bool heavy_tail = range.hi - range.lo > 2.0f * (*high - range.lo) && *high > range.lo;
  return {range.lo, heavy_tail ? *high : range.hi};
}

// How many bars, and how a value finds its bar.
struct Bars {
  int count = max_bars;
  int numbers_a_bar = 0;  // whole numbers each bar stands for; 0: bars divide the scale evenly
  float first = 0.0f;

  int of(float value, float position) const {
    const float bar =
        numbers_a_bar > 0 ? (value - first) / float(numbers_a_bar) : position * float(count);
    return std::clamp(int(bar), 0, count - 1);
  }
};

Bars bars_for(const ValueRange& range, bool counts, bool logarithmic) {
  if (!counts || logarithmic) return {};
  const float numbers = std::floor(range.hi) - std::ceil(range.lo) + 1.0f;
  if (!(numbers >= 1.0f && numbers < 1e6f)) return {};
  Bars bars;
  bars.first = std::ceil(range.lo);
  bars.numbers_a_bar = (int(numbers) + max_bars - 1) / max_bars;
  bars.count = (int(numbers) + bars.numbers_a_bar - 1) / bars.numbers_a_bar;
  return bars;
}

void show_values(const Film& film, const std::vector<float>& values, const Chosen& rows,
                 bool logarithmic, Picture& picture) {
  std::array<uint32_t, color_steps> colors;
  for (int i = 0; i < color_steps; ++i) {
    colors[i] = pack(rows.colormap.color(float(i) / (color_steps - 1)));
  }
  const ValueScale scale(picture.range, logarithmic, rows.view.counts);
  const Bars bars = bars_for(picture.range, rows.view.counts, logarithmic);
  using TileBars = std::array<uint32_t, max_bars>;
  std::vector<TileBars> tile_bars(film.tiles.size(), TileBars{});
  const ValueRange range = picture.range;

  tbb::parallel_for(size_t(0), film.tiles.size(), [&](size_t tile) {
    if (!film.tiles[tile] || !film.tiles[tile]->facts) return;
    const TileArea block = area(film, tile);
    for (int y = block.y0; y < block.y1; ++y) {
      for (int x = block.x0; x < block.x1; ++x) {
        const size_t index = size_t(y) * film.width + x;
        const float value = values[index];
        if (std::isnan(value)) {
          picture.image.pixels[index] = checkerboard(x, y);
          continue;
        }
        const float position = std::clamp(scale.position(value), 0.0f, 1.0f);
        picture.image.pixels[index] = colors[int(position * (color_steps - 1) + 0.5f)];
        if (value >= range.lo && value <= range.hi) ++tile_bars[tile][bars.of(value, position)];
      }
    }
  });

  picture.histogram.bars.assign(bars.count, 0);
  for (const TileBars& tile : tile_bars) {
    for (int i = 0; i < bars.count; ++i)
      picture.histogram.bars[i] += tile[i];
  }
}

std::string title_of(const Chosen& rows) {
  std::string title(rows.view.label);
  if (rows.view.id == "counter") title = rows.counter.label;
  if (!rows.view.by_ray_class) return title;
  const std::string_view rays =
      rows.ray_class == ray_class_count ? "All rays" : ray_classes()[rows.ray_class].label;
  return fmt::format("{}, {}{}", title, char(rays[0] - 'A' + 'a'), rays.substr(1));
}

}  // namespace

Picture colorize(const Snapshot& snapshot, const ViewOptions& options) {
  const Chosen rows = chosen(options);
  const Film& film = snapshot.film;
  Picture picture;
  picture.title = title_of(rows);
  picture.unit = rows.view.id == "counter" ? rows.counter.unit : rows.view.unit;
  picture.counts = rows.view.counts;
  picture.image = {film.width, film.height, {}};
  picture.image.pixels.assign(size_t(film.width) * film.height, not_traced);
  if (film.tiles.empty()) return picture;

  const ViewInput input = view_input(snapshot, rows.view, rows.counter, rows.ray_class);
  if (rows.view.kind == ViewKind::radiance) {
    show_radiance(film, rows, options.exposure, picture.image);
  } else if (rows.view.kind == ViewKind::color) {
    show_colors(film, rows, input, picture.image);
  } else {
    Summary summary;
    const std::vector<float> values = values_of(film, rows, input, summary);
    picture.has_range = true;
    if (summary.values > 0) {
      picture.histogram.range = {summary.lo, summary.hi};
      picture.histogram.mean = summary.sum / double(summary.values);
      picture.histogram.values = summary.values;
    }
    picture.range =
        options.range ? *options.range : fitted(values, picture.histogram.range, rows.view.counts);
    show_values(film, values, rows, options.logarithmic, picture);
  }
  return picture;
}

float value_at(const Snapshot& snapshot, const ViewOptions& options, int x, int y) {
  const Chosen rows = chosen(options);
  const PixelFacts facts = pixel(snapshot.film, x, y);
  if (rows.view.kind != ViewKind::value || facts.hit == nullptr) {
    return std::numeric_limits<float>::quiet_NaN();
  }
  const ViewInput input = view_input(snapshot, rows.view, rows.counter, rows.ray_class);
  return rows.view.value({input, x, y, *facts.hit, *facts.counters, facts.depth});
}

}  // namespace tracer
