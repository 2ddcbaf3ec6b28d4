// The images of the assets folder, computed.
#pragma once

#include <cstdint>
#include <vector>

#include "tracer/math/types.h"

namespace assets {

inline constexpr int bricks_size = 512;  // pixels, square
inline constexpr int sky_width = 1024, sky_height = 512;

// sRGB bytes R, G, B, row 0 on top. A wall of red bricks, 4 wide and 8 high; tiles in x and y.
std::vector<uint8_t> make_bricks();

// Linear radiance, equirectangular as SkyImage describes it; about 0.3 on average, the sun bounded.
std::vector<tracer::vec3> make_sky();

}  // namespace assets
