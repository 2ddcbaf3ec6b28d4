// A picture as a display shows it, and how to draw rectangles into it.
#pragma once

#include <cstdint>
#include <vector>

namespace tracer {

// 8-bit RGBA, row 0 on top, sRGB.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<uint32_t> pixels;  // bytes R, G, B, A
};

inline uint32_t opaque(uint32_t rrggbb) {
  return 0xff000000u | (rrggbb & 0xff) << 16 | (rrggbb & 0xff00) | (rrggbb >> 16 & 0xff);
}

// Mixes an opaque colour over another, 0 <= cover <= 1, in sRGB as displays and browsers do.
inline uint32_t mixed(uint32_t under, uint32_t over, float cover) {
  uint32_t result = 0xff000000u;
  for (int shift = 0; shift < 24; shift += 8) {
    const float a = float(under >> shift & 0xff);
    const float b = float(over >> shift & 0xff);
    result |= uint32_t(a + (b - a) * cover + 0.5f) << shift;
  }
  return result;
}

// Columns [x0, x1) and rows [y0, y1), clipped at the borders.
inline void fill_rectangle(Image& image, int x0, int y0, int x1, int y1, uint32_t color,
                           float cover = 1.0f) {
  for (int y = y0 > 0 ? y0 : 0; y < y1 && y < image.height; ++y) {
    for (int x = x0 > 0 ? x0 : 0; x < x1 && x < image.width; ++x) {
      uint32_t& pixel = image.pixels[size_t(y) * image.width + x];
      pixel = mixed(pixel, color, cover);
    }
  }
}

}  // namespace tracer
