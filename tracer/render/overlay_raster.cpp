#include "tracer/render/overlay_raster.h"

#include <algorithm>
#include <cmath>

namespace tracer {
namespace {

// part: 0..256
inline void blend(uint32_t& pixel, uint32_t color, uint32_t part) {
  const uint32_t rest = 256 - part;
  const uint32_t red_blue =
      ((pixel & 0xff00ffu) * rest + (color & 0xff00ffu) * part) >> 8 & 0xff00ffu;
  const uint32_t green = ((pixel & 0xff00u) * rest + (color & 0xff00u) * part) >> 8 & 0xff00u;
  pixel = 0xff000000u | red_blue | green;
}

// One pixel of a line: `cover` of it.
inline void dot(const Band& band, int x, int y, float nearness, float cover, const Ink& ink) {
  const int width = band.image.width;
  const float limit = band.limits.empty()
                          ? -infinity
                          : band.limits[size_t(y - band.y0) * size_t(width) + size_t(x)];
  cover *= nearness >= limit ? ink.cover : ink.hidden_cover;
  blend(band.image.pixels[size_t(y) * size_t(width) + size_t(x)], ink.color,
        uint32_t(cover * 256.0f));
}

// Goes along x or y, whichever the line has more of, and covers the pixels across.
template <bool along_x>
void draw_along(const Band& band, const ScreenLine& line, float width, const Ink& ink) {
  const int axis = along_x ? 0 : 1, across = 1 - axis;
  vec3 from = line.from, to = line.to;
  if (from[axis] > to[axis]) std::swap(from, to);
  const float length = to[axis] - from[axis];
  const float slope = length > 0.0f ? (to[across] - from[across]) / length : 0.0f;
  const float rise = length > 0.0f ? (to.z - from.z) / length : 0.0f;
  const float cosine = 1.0f / std::sqrt(1.0f + slope * slope);
  const float reach = (0.5f * width + 0.5f) / cosine;

  const int axis_size = along_x ? band.image.width : band.y1;
  const int axis_begin = along_x ? 0 : band.y0;
  int first = std::max(int(std::ceil(from[axis] - 0.5f)), axis_begin);
  int last = std::min(int(std::floor(to[axis] - 0.5f)), axis_size - 1);
  if (along_x && slope != 0.0f) {  // only the part inside the band
    const float a = (float(band.y0) - reach - from.y) / slope + from.x;
    const float b = (float(band.y1) + reach - from.y) / slope + from.x;
    first = std::max(first, int(std::clamp(std::min(a, b) - 1.0f, -1.0f, 1e6f)));
    last = std::min(last, int(std::clamp(std::max(a, b) + 1.0f, -1.0f, 1e6f)));
  }
  const int across_begin = along_x ? band.y0 : 0;
  const int across_end = along_x ? band.y1 : band.image.width;
  for (int i = first; i <= last; ++i) {
    const float step = float(i) + 0.5f - from[axis];
    const float middle = from[across] + step * slope;
    const float nearness = from.z + step * rise;
    const int lowest = std::max(int(std::floor(middle - reach)), across_begin);
    const int highest = std::min(int(std::floor(middle + reach)), across_end - 1);
    for (int j = lowest; j <= highest; ++j) {
      const float distance = std::abs(float(j) + 0.5f - middle) * cosine;
      const float cover = std::clamp(0.5f * width + 0.5f - distance, 0.0f, 1.0f);
      if (cover <= 0.0f) continue;
      dot(band, along_x ? i : j, along_x ? j : i, nearness, cover, ink);
    }
  }
}

}  // namespace

void draw_line(const Band& band, const ScreenLine& line, float width, const Ink& ink) {
  const float reach = width + 1.0f;
  if (std::max(line.from.y, line.to.y) < float(band.y0) - reach ||
      std::min(line.from.y, line.to.y) > float(band.y1) + reach) {
    return;
  }
  if (std::abs(line.to.x - line.from.x) >= std::abs(line.to.y - line.from.y)) {
    draw_along<true>(band, line, width, ink);
  } else {
    draw_along<false>(band, line, width, ink);
  }
}

void draw_face(const Band& band, const ScreenFace& face, const Ink& ink) {
  float lo = infinity, hi = -infinity;
  for (int i = 0; i < face.count; ++i) {
    lo = std::min(lo, face.corners[size_t(i)].y);
    hi = std::max(hi, face.corners[size_t(i)].y);
  }
  const int width = band.image.width;
  const int first = int(std::clamp(std::ceil(lo - 0.5f), float(band.y0), float(band.y1)));
  const int last = int(std::clamp(std::floor(hi - 0.5f), -1.0f, float(band.y1) - 1.0f));
  const uint32_t seen = uint32_t(ink.cover * face.cover * 256.0f);
  const uint32_t hidden = uint32_t(ink.hidden_cover * face.cover * 256.0f);
  for (int y = first; y <= last; ++y) {
    const float at = float(y) + 0.5f;
    float left = infinity, right = -infinity;
    for (int i = 0; i < face.count; ++i) {
      const vec2& a = face.corners[size_t(i)];
      const vec2& b = face.corners[size_t((i + 1) % face.count)];
      if ((a.y <= at) == (b.y <= at)) continue;
      const float x = a.x + (b.x - a.x) * ((at - a.y) / (b.y - a.y));
      left = std::min(left, x);
      right = std::max(right, x);
    }
    if (!(left < right)) continue;
    const int begin = int(std::clamp(std::ceil(left - 0.5f), 0.0f, float(width)));
    const int end = int(std::clamp(std::ceil(right - 0.5f), 0.0f, float(width)));
    uint32_t* row = &band.image.pixels[size_t(y) * size_t(width)];
    if (band.limits.empty() || seen == hidden) {
      for (int x = begin; x < end; ++x)
        blend(row[x], ink.color, seen);
      continue;
    }
    const float* limits = &band.limits[size_t(y - band.y0) * size_t(width)];
    const float nearness = at * face.plane.y + face.plane.z;
    for (int x = begin; x < end; ++x) {
      const bool visible = (float(x) + 0.5f) * face.plane.x + nearness >= limits[x];
      blend(row[x], ink.color, visible ? seen : hidden);
    }
  }
}

bool clip(ScreenLine& line, float width, float height, float margin) {
  float begin = 0.0f, end = 1.0f;
  const vec3 step = line.to - line.from;
  const vec2 most(width + margin, height + margin);
  for (int axis = 0; axis < 2; ++axis) {
    const float at = line.from[axis];
    if (step[axis] == 0.0f) {
      if (at < -margin || at > most[axis]) return false;
      continue;
    }
    const float a = (-margin - at) / step[axis];
    const float b = (most[axis] - at) / step[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(begin <= end)) return false;
  const vec3 from = line.from;
  line.from = from + step * begin;
  line.to = from + step * end;
  return true;
}

}  // namespace tracer
