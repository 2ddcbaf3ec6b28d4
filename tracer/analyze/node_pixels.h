// The pixels of a picture with a ray that entered one node.
#pragma once

#include <memory>
#include <vector>

#include "tracer/progress.h"
#include "tracer/render/whitted.h"

namespace tracer {

struct NodePixels {
  std::shared_ptr<const SceneBvh> bvh;  // nullptr: stopped
  Watched node;
  int width = 0, height = 0;
  std::vector<uint8_t> entered;  // by pixel, row by row; bit i: a ray of RayClass i did
};

// With the rays of pass 0: one sample through the centre of each pixel. The same for any number of
// threads.
NodePixels node_pixels(const World& world, std::shared_ptr<const SceneBvh> bvh,
                       const CameraFrame& camera, const Watched& node, const Job& job);

// Whether a pixel's bits have a ray of the class (index), or of any (ray_class_count).
inline bool has_class(uint8_t entered, int ray_class) {
  return ray_class < ray_class_count ? (entered >> ray_class & 1) != 0 : entered != 0;
}

// Of one class, or of any.
uint64_t count(const NodePixels& pixels, int ray_class);

// [x0, x1) of the rows [y0, y1).
struct PixelBlock {
  int x0, x1, y0, y1;
};
// The pixels of a class as blocks that do not overlap: runs of a row, joined where the rows below
// have the same.
std::vector<PixelBlock> blocks_of(const NodePixels& pixels, int ray_class);

}  // namespace tracer
