// Tile by tile, with a probe that watches one node.
#include "tracer/analyze/node_pixels.h"

#include <algorithm>
#include <mutex>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "tracer/render/pixel_blocks.h"

namespace tracer {
namespace {

constexpr int tile = 64;  // pixels

}  // namespace

NodePixels node_pixels(const World& world, std::shared_ptr<const SceneBvh> bvh,
                       const CameraFrame& camera, const Watched& node, const Job& job) {
  NodePixels result;
  result.node = node;
  result.width = world.options.width;
  result.height = world.options.height;
  result.entered.resize(size_t(result.width) * size_t(result.height));
  const int columns = (result.width + tile - 1) / tile;
  const int rows = (result.height + tile - 1) / tile;
  std::mutex mutex;
  int done = 0;
  tbb::enumerable_thread_specific<Whitted> threads;
  tbb::parallel_for(
      0, columns * rows,
      [&](int index) {
        if (job.stopped()) return;
        const int x0 = index % columns * tile, y0 = index / columns * tile;
        std::vector<vec2> points;
        std::vector<size_t> targets;
        for_pixels_in_blocks(
            std::min(tile, result.width - x0), std::min(tile, result.height - y0),
            [&](int x, int y) {
              points.push_back(vec2(x0 + x, y0 + y) + 0.5f);
              targets.push_back(size_t(y0 + y) * size_t(result.width) + size_t(x0 + x));
            });
        std::vector<uint8_t> entered(points.size());
        threads.local().trace_watching(world, camera, points, node, entered);
        for (size_t i = 0; i < targets.size(); ++i)
          result.entered[targets[i]] = entered[i];
        const std::lock_guard lock(mutex);
        job.progress(float(++done) / float(columns * rows), "looking for its pixels");
      },
      tbb::simple_partitioner{});
  if (!job.stopped()) result.bvh = std::move(bvh);
  return result;
}

uint64_t count(const NodePixels& pixels, int ray_class) {
  return uint64_t(std::count_if(pixels.entered.begin(), pixels.entered.end(),
                                [&](uint8_t entered) { return has_class(entered, ray_class); }));
}

std::vector<PixelBlock> blocks_of(const NodePixels& pixels, int ray_class) {
  std::vector<PixelBlock> blocks;
  std::vector<size_t> above, here;  // blocks that reach down to the row before, and to this one
  for (int y = 0; y < pixels.height; ++y) {
    const auto row = pixels.entered.begin() + std::ptrdiff_t(y) * pixels.width;
    here.clear();
    size_t next = 0;
    for (int x = 0; x < pixels.width;) {
      if (!has_class(row[x], ray_class)) {
        ++x;
        continue;
      }
      const int x0 = x;
      while (x < pixels.width && has_class(row[x], ray_class))
        ++x;
      while (next < above.size() && blocks[above[next]].x0 < x0)
        ++next;
      const bool same =
          next < above.size() && blocks[above[next]].x0 == x0 && blocks[above[next]].x1 == x;
      if (same) {
        blocks[above[next]].y1 = y + 1;
        here.push_back(above[next]);
      } else {
        here.push_back(blocks.size());
        blocks.push_back({x0, x, y, y + 1});
      }
    }
    std::swap(above, here);
  }
  return blocks;
}

}  // namespace tracer
