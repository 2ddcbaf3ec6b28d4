// Colour bars with their numbers, drawn on a dark plate so that they read on any picture.
#include "tracer/render/color_bar.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tracer/render/text.h"
#include "tracer/render/value_scale.h"

namespace tracer {
namespace {

constexpr uint32_t plate_color = 0x101214;
constexpr uint32_t bright_text = 0xf4f4f4;
constexpr uint32_t dim_text = 0xb8bcc2;
constexpr int most_fields = 16;  // more whole numbers than this make a continuous bar

// All in pixels.
struct Layout {
  float unit;  // of the text
  int line;    // height of a line of text
  int padding;
  int bar_width, bar_height;
  int x0, y0, x1, y1;  // the plate
};

std::string number(float value, bool counts) {
  if (counts && std::abs(value) < 1e6f) return fmt::format("{:.0f}", value);
  if (counts) return fmt::format("{:.4g}M", value * 1e-6f);
  return fmt::format("{:.3g}", value);
}

bool is_discrete(const ColorBar& bar) {
  const ValueRange& range = bar.range;
  return bar.counts && !bar.logarithmic && range.hi - range.lo < float(most_fields) &&
         range.lo == std::floor(range.lo) && range.hi == std::floor(range.hi);
}

struct Tick {
  float value;
  float position;  // 0..1 along the bar
};

// Candidates from the most to the least welcome: both ends, then round numbers.
std::vector<Tick> candidates(const ColorBar& bar) {
  const ValueRange& range = bar.range;
  const ValueScale scale(range, bar.logarithmic, bar.counts);
  std::vector<Tick> ticks = {{range.lo, 0.0f}};
  if (!(range.hi > range.lo)) return ticks;
  ticks.push_back({range.hi, 1.0f});
  const auto add = [&](double value) {
    if (bar.counts && value != std::floor(value)) return;
    const float position = scale.position(float(value));
    if (position > 0.0f && position < 1.0f) ticks.push_back({float(value), position});
  };
  const double length = double(range.hi) - range.lo;
  if (bar.logarithmic) {
    const int highest = int(std::floor(std::log10(std::max(range.hi, 1e-30f))));
    for (const double digit : {1.0, 5.0, 2.0}) {
      for (int power = highest; power > highest - 8; --power)
        add(digit * std::pow(10.0, power));
    }
  } else {
    const double rough = length / 5.0;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    const double digits = rough / power;
    const double step = power * (digits < 1.5   ? 1.0
                                 : digits < 3.5 ? 2.0
                                 : digits < 7.5 ? 5.0
                                                : 10.0);
    const double first = std::ceil(range.lo / step);
    for (int i = 0; i <= 20; ++i) {
      add((first + i) * step);
    }
  }
  return ticks;
}

// Draws the ticks whose numbers do not touch an earlier one.
void draw_ticks(Image& image, const Layout& at, int bar_x, int bar_y, const ColorBar& bar) {
  struct Span {
    float from, to;
  };
  std::vector<Span> taken;
  const float gap = 8.0f * at.unit;
  for (const Tick& tick : candidates(bar)) {
    std::string text = number(tick.value, bar.counts);
    // There is more than the bar shows.
    if (tick.position == 1.0f && bar.more) text += "+";
    const float width = text_width(text, at.unit);
    const float x = float(bar_x) + tick.position * float(at.bar_width - 1);
    const float from =
        std::clamp(x - 0.5f * width, float(bar_x), float(bar_x + at.bar_width) - width);
    const bool free = std::all_of(taken.begin(), taken.end(), [&](const Span& other) {
      return from + width + gap <= other.from || from >= other.to + gap;
    });
    if (!free) continue;
    taken.push_back({from, from + width});
    const int column = int(x);
    fill_rectangle(image, column, bar_y + at.bar_height, column + 1, bar_y + at.bar_height + 3,
                   opaque(bright_text));
    draw_text(image, from, float(bar_y + at.bar_height + 5), text, at.unit, bright_text);
  }
}

void draw_continuous_bar(Image& image, const Layout& at, int x, int y, const ColorBar& bar) {
  for (int i = 0; i < at.bar_width; ++i) {
    const vec3 color = bar.color(float(i) / float(at.bar_width - 1)) * 255.0f + 0.5f;
    const uint32_t packed = uint32_t(color.x) << 16 | uint32_t(color.y) << 8 | uint32_t(color.z);
    fill_rectangle(image, x + i, y, x + i + 1, y + at.bar_height, opaque(packed));
  }
}

// One field a whole number, with the number under it.
void draw_fields(Image& image, const Layout& at, int x, int y, const ColorBar& bar) {
  const ValueRange& range = bar.range;
  const ValueScale scale(range, false, true);
  const int fields = int(range.hi - range.lo) + 1;
  float free_from = 0.0f;
  for (int i = 0; i < fields; ++i) {
    const float value = range.lo + float(i);
    const int from = x + at.bar_width * i / fields;
    const int to = x + at.bar_width * (i + 1) / fields;
    const vec3 color = bar.color(scale.position(value)) * 255.0f + 0.5f;
    const uint32_t packed = uint32_t(color.x) << 16 | uint32_t(color.y) << 8 | uint32_t(color.z);
    fill_rectangle(image, from, y, to - 1, y + at.bar_height, opaque(packed));
    const std::string text =
        size_t(i) < bar.names.size() ? bar.names[size_t(i)] : number(value, true);
    const float width = text_width(text, at.unit);
    const float text_x = 0.5f * (float(from + to - 1) - width);
    if (text_x < free_from) continue;
    free_from = text_x + width + 3.0f * at.unit;
    draw_text(image, text_x, float(y + at.bar_height + 5), text, at.unit, bright_text);
  }
}

Layout layout(const Image& image, float content_width_in_units) {
  Layout at;
  at.unit = std::max(
      1.0f,
      std::floor(std::min(float(image.height) / 570.0f, float(image.width) / 1000.0f) * 4.0f) /
          4.0f);
  at.line = int(std::ceil((text_ascent + text_descent + 2.0f) * at.unit));
  at.padding = int(8.0f * at.unit);
  at.bar_height = int(10.0f * at.unit);
  at.bar_width = std::max(int(std::ceil(content_width_in_units * at.unit)), int(220.0f * at.unit));
  at.x0 = at.padding;
  at.x1 = at.x0 + at.bar_width + 2 * at.padding;
  at.y1 = image.height - at.padding;
  at.y0 = at.y1 - (2 * at.padding + 3 * at.line + at.bar_height + int(3.0f * at.unit));
  return at;
}

}  // namespace

void draw_color_bar(Image& image, const ColorBar& bar, Side side) {
  std::string note = bar.note;
  if (bar.logarithmic) note += note.empty() ? "log scale" : ", log scale";
  Layout at = layout(image, std::max(text_width(bar.title, 1.0f), text_width(note, 1.0f)));
  // It may hide a part of the picture, not the picture.
  const int64_t plate = int64_t(at.x1 - at.x0) * (at.y1 - at.y0);
  const bool fits = at.x1 + at.padding <= image.width && at.y0 >= at.padding;
  if (!fits || plate * 5 > int64_t(image.width) * image.height) return;
  if (side == Side::right) {
    const int shift = image.width - at.padding - at.x1;
    if (shift < at.x1 - at.x0) return;  // it would lie on the one on the left
    at.x0 += shift;
    at.x1 += shift;
  }

  fill_rectangle(image, at.x0, at.y0, at.x1, at.y1, opaque(plate_color), 0.88f);
  const int x = at.x0 + at.padding;
  int y = at.y0 + at.padding;
  draw_text(image, float(x), float(y), bar.title, at.unit, bright_text);
  y += at.line + int(2.0f * at.unit);
  if (is_discrete(bar)) {
    draw_fields(image, at, x, y, bar);
  } else {
    draw_continuous_bar(image, at, x, y, bar);
    draw_ticks(image, at, x, y, bar);
  }
  y += at.bar_height + 5 + at.line + int(2.0f * at.unit);
  draw_text(image, float(x), float(y), note, at.unit, dim_text);
}

}  // namespace tracer
