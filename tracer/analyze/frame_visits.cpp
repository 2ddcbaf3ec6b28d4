// Visits by node, tile by tile; each thread counts for itself.
#include "tracer/analyze/frame_visits.h"

#include <algorithm>
#include <mutex>
#include <optional>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "tracer/clock.h"
#include "tracer/render/pixel_blocks.h"

namespace tracer {
namespace {

constexpr int tile = 64;                     // pixels
constexpr uint64_t most_bytes = 1ull << 30;  // of all threads' counts

struct ThreadCounts {
  Whitted whitted;
  std::optional<ClassVisits> visits;
};

// function(counts of a tree in `to`, in `from`)
template <class Function>
void for_each_tree(ClassVisits& to, ClassVisits& from, const Function& function) {
  for (size_t i = 0; i < to.size(); ++i) {
    function(to[i].tlas, from[i].tlas);
    for (size_t mesh = 0; mesh < to[i].blases.size(); ++mesh)
      function(to[i].blases[mesh], from[i].blases[mesh]);
  }
}

void add(std::vector<uint32_t>& to, const std::vector<uint32_t>& from) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, to.size(), 1 << 16), [&](const auto& range) {
    for (size_t i = range.begin(); i != range.end(); ++i)
      to[i] += from[i];
  });
}

int thread_count(const SceneBvh& bvh) {
  uint64_t nodes = bvh.tlas.nodes.size();
  for (const auto& blas : bvh.blases)
    nodes += blas->tree.nodes.size();
  const uint64_t bytes = std::max<uint64_t>(nodes * sizeof(uint32_t) * ray_class_count, 1);
  const uint64_t most = std::max<uint64_t>(most_bytes / bytes, 1);
  return int(std::min<uint64_t>(most, uint64_t(tbb::info::default_concurrency())));
}

}  // namespace

std::shared_ptr<const FrameVisits> count_visits(const World& world, const CameraFrame& camera,
                                                const Job& job) {
  const auto start = Clock::now();
  const int columns = (world.options.width + tile - 1) / tile;
  const int rows = (world.options.height + tile - 1) / tile;
  std::mutex mutex;
  int done = 0;
  tbb::enumerable_thread_specific<ThreadCounts> threads;
  const auto trace_tile = [&](int index) {
    if (job.stopped()) return;
    const int x0 = index % columns * tile;
    const int y0 = index / columns * tile;
    std::vector<vec2> points;
    for_pixels_in_blocks(std::min(tile, world.options.width - x0),
                         std::min(tile, world.options.height - y0),
                         [&](int x, int y) { points.push_back(vec2(x0 + x, y0 + y) + 0.5f); });
    ThreadCounts& own = threads.local();
    if (!own.visits) {
      own.visits.emplace();
      own.visits->fill(no_visits(world.bvh));
    }
    own.whitted.trace_visits(world, camera, points, *own.visits);
    const std::lock_guard lock(mutex);
    job.progress(float(++done) / float(columns * rows), "counting visits");
  };
  tbb::task_arena arena(thread_count(world.bvh));
  arena.execute(
      [&] { tbb::parallel_for(0, columns * rows, trace_tile, tbb::simple_partitioner{}); });
  if (job.stopped()) return nullptr;

  auto result = std::make_shared<FrameVisits>();
  bool first = true;
  for (ThreadCounts& own : threads) {
    if (first) {
      result->classes = std::move(*own.visits);
    } else {
      for_each_tree(result->classes, *own.visits, add);
    }
    first = false;
  }
  result->milliseconds = ms_since(start);
  return result;
}

std::vector<uint32_t> tree_visits(const FrameVisits& visits, uint32_t mesh, int ray_class) {
  const auto of = [&](size_t i) -> const std::vector<uint32_t>& {
    return mesh == none ? visits.classes[i].tlas : visits.classes[i].blases[mesh];
  };
  if (ray_class < ray_class_count) return of(size_t(ray_class));
  std::vector<uint32_t> sum = of(0);
  for (size_t i = 1; i < visits.classes.size(); ++i)
    add(sum, of(i));
  return sum;
}

}  // namespace tracer
