// The Utah teapot.
#pragma once

#include <array>

#include "tracer/scene/mesh.h"

namespace tracer {

// points[i][j] are control points of a bicubic Bezier patch with parameters s along i and t along
// j; d/dt x d/ds points to the outside. Texture coordinates are linear in s and t: u goes from
// u_first (t = 0) to u_last, v from v_first (s = 0) to v_last.
struct TeapotPatch {
  std::array<std::array<vec3, 4>, 4> points;
  float u_first, u_last, v_first, v_last;
};

inline constexpr int teapot_patch_count = 32;

// In the published coordinates: z up, the spout towards +x, 3.15 high. Patches 0..23 are the body,
// its lid and bottom, four quarters each of: rim, upper body, lower body, knob, lid, bottom; then
// 4 of the handle and 4 of the spout.
std::array<TeapotPatch, teapot_patch_count> teapot_patches();

// Each patch as detail x detail quads (detail 2..512; 1 would flatten the handle), without the
// triangles that would have no area at the lid's top and the bottom's middle: 64 detail^2 - 8
// detail triangles; 10 gives the well-known 6,320. y is up, the spout points towards +x, the body's
// axis is x = z = 0; it stands on y = 0 and is 1 high and 2.06 wide. The texture repeats 4 times
// around the body, so bricks keep their shape. All triangles have material 0. Patches meet in
// positions that are equal to the bit.
Mesh make_teapot(uint32_t detail);

}  // namespace tracer
