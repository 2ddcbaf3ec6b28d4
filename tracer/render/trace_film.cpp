// Filling the film, tile by tile and pass by pass.
#include "tracer/render/trace_film.h"

#include <algorithm>
#include <cmath>

#include "tracer/render/pixel_blocks.h"

namespace tracer {

namespace {

// The pixels of a tile: [x, x + width) by [y, y + height).
struct TileArea {
  int x, y, width, height;
};

TileArea area_of(const vec2& resolution, int tile) {
  const int width = static_cast<int>(resolution.x);
  const int height = static_cast<int>(resolution.y);
  const int x = tile % tile_columns(width) * tile_size;
  const int y = tile / tile_columns(width) * tile_size;
  return {x, y, std::min(tile_size, width - x), std::min(tile_size, height - y)};
}

int samples_across(int pixels, int stride) {
  return (pixels + stride - 1) / stride;
}

}  // namespace

Film empty_film(int width, int height) {
  Film film;
  film.width = width;
  film.height = height;
  film.tiles.resize(static_cast<size_t>(tile_columns(width)) *
                    static_cast<size_t>(tile_columns(height)));
  return film;
}

uint64_t film_bytes(int width, int height) {
  constexpr uint64_t per_pixel =
      sizeof(Hit) + sizeof(ClassCounters) + sizeof(uint8_t) + 2 * sizeof(vec3);
  return per_pixel * static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
}

vec2 sample_position(int index) {
  // The two powers of the reciprocal of the plastic number, in double so that large indices keep
  // their digits.
  constexpr double a1 = 0.7548776662466927;
  constexpr double a2 = 0.5698402909980532;
  const auto fraction = [](double value) { return static_cast<float>(value - std::floor(value)); };
  return {fraction(0.5 + a1 * index), fraction(0.5 + a2 * index)};
}

std::shared_ptr<const FilmTile> trace_first_pass(const World& world, const CameraFrame& camera,
                                                 int tile, int stride, const FilmTile* coarser,
                                                 Whitted& whitted) {
  const TileArea area = area_of(camera.resolution, tile);
  auto facts = std::make_shared<TileFacts>();
  facts->stride = stride;
  facts->columns = samples_across(area.width, stride);
  facts->rows = samples_across(area.height, stride);
  const size_t count = static_cast<size_t>(facts->columns) * static_cast<size_t>(facts->rows);
  facts->hits.resize(count);
  facts->counters.resize(count);
  facts->depth.resize(count);
  facts->radiance.resize(count);

  std::vector<vec2> points;
  std::vector<size_t> targets;
  for_pixels_in_blocks(facts->columns, facts->rows, [&](int column, int row) {
    const size_t target = static_cast<size_t>(row) * facts->columns + column;
    if (coarser && row % 2 == 0 && column % 2 == 0) {
      const TileFacts& known = *coarser->facts;
      const size_t source = static_cast<size_t>(row / 2) * known.columns + column / 2;
      facts->hits[target] = known.hits[source];
      facts->counters[target] = known.counters[source];
      facts->depth[target] = known.depth[source];
      facts->radiance[target] = known.radiance[source];
    } else {
      points.push_back(vec2(area.x + column * stride, area.y + row * stride) + 0.5f);
      targets.push_back(target);
    }
  });
  whitted.trace(world, camera, points, true);
  for (size_t i = 0; i < targets.size(); ++i) {
    facts->hits[targets[i]] = whitted.hits()[i];
    facts->counters[targets[i]] = whitted.counters()[i];
    facts->depth[targets[i]] = whitted.depth()[i];
    facts->radiance[targets[i]] = whitted.radiance()[i];
  }
  auto result = std::make_shared<FilmTile>();
  result->facts = std::move(facts);
  return result;
}

std::shared_ptr<const FilmTile> trace_next_pass(const World& world, const CameraFrame& camera,
                                                int tile, const FilmTile& before,
                                                Whitted& whitted) {
  const TileArea area = area_of(camera.resolution, tile);
  const vec2 within = sample_position(before.samples);
  UntouchedVector<vec2> points(before.facts->hits.size());
  size_t next = 0;
  for_pixels_in_blocks(area.width, area.height, [&](int x, int y) {
    points[next++] = vec2(area.x + x, area.y + y) + within;
  });
  whitted.trace(world, camera, points, false);
  auto result = std::make_shared<FilmTile>(before);
  if (result->sum.empty()) result->sum = before.facts->radiance;
  next = 0;
  for_pixels_in_blocks(area.width, area.height, [&](int x, int y) {
    result->sum[static_cast<size_t>(y) * area.width + x] += whitted.radiance()[next++];
  });
  ++result->samples;
  return result;
}

}  // namespace tracer
