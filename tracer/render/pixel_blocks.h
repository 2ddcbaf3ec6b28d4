// The order in which the pixels of a tile are traced.
#pragma once

#include <algorithm>

namespace tracer {

// visit(x, y) for all of width x height, block by block, so that the rays of a packet are
// neighbours both ways.
template <class Visit>
void for_pixels_in_blocks(int width, int height, const Visit& visit) {
  constexpr int block = 4;
  const auto visit_block = [&](int left, int top, int columns, int rows) {
    for (int y = top; y < top + rows; ++y)
      for (int x = left; x < left + columns; ++x)
        visit(x, y);
  };
  for (int top = 0; top < height; top += block) {
    const int rows = std::min(block, height - top);
    int left = 0;
    if (rows == block)  // loops of known length are unrolled
      for (; left + block <= width; left += block)
        visit_block(left, top, block, block);
    for (; left < width; left += block)
      visit_block(left, top, std::min(block, width - left), rows);
  }
}

}  // namespace tracer
