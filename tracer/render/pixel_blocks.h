// The order in which the pixels of a tile are traced.
#pragma once

#include <algorithm>

namespace tracer {

// visit(x, y) for all of width x height, block by block, so that the rays of a packet are
// neighbours both ways.
template <class Visit>
void for_pixels_in_blocks(int width, int height, const Visit& visit) {
  constexpr int block = 4;
  for (int top = 0; top < height; top += block) {
    for (int left = 0; left < width; left += block) {
      for (int y = top; y < std::min(top + block, height); ++y) {
        for (int x = left; x < std::min(left + block, width); ++x)
          visit(x, y);
      }
    }
  }
}

}  // namespace tracer
