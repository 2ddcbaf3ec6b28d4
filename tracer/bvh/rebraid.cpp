// The part that loses most surface is opened first.
#include "tracer/bvh/rebraid.h"

#include <algorithm>
#include <map>
#include <queue>

#include <tbb/parallel_for.h>

#include "tracer/bvh/blas_top.h"
#include "tracer/bvh/world_box.h"

namespace tracer {
namespace {

constexpr float most_surface = 0.9f;         // of the children of a part, for it to be opened
constexpr uint64_t most_added = 1ull << 20;  // parts: more would hold up each frame for seconds

struct Part {
  uint32_t instance = 0;
  uint32_t node = 0;  // of its BLAS's top
  Box box;            // in the world
};

// A part, and what it would become.
struct Opening {
  float gain = 0.0f;  // surface that it loses
  uint32_t part = 0;
  std::vector<Part> children;  // none: nothing is gained

  bool operator<(const Opening& other) const {
    return gain != other.gain ? gain < other.gain : part > other.part;
  }
};

std::vector<BlasTop> tops_of(const SceneBvh& bvh) {
  std::vector<BlasTop> tops(bvh.blases.size());
  tbb::parallel_for(size_t{0}, tops.size(),
                    [&](size_t mesh) { tops[mesh] = top_of(*bvh.blases[mesh]); });
  return tops;
}

class Braider {
 public:
  explicit Braider(const SceneBvh& bvh) : bvh_(bvh), tops_(tops_of(bvh)) {}

  // There are at most `spare` more parts then.
  void open(std::vector<Part>& parts, uint32_t spare) const {
    std::vector<Opening> first(parts.size());
    tbb::parallel_for(size_t{0}, parts.size(),
                      [&](size_t i) { first[i] = opening(parts[i], uint32_t(i)); });
    std::erase_if(first, [](const Opening& one) { return one.children.empty(); });
    std::priority_queue<Opening> waiting({}, std::move(first));
    while (!waiting.empty()) {
      const Opening now = waiting.top();
      waiting.pop();
      const auto added = uint32_t(now.children.size() - 1);
      if (added > spare) continue;
      spare -= added;
      parts[now.part] = now.children[0];
      parts.insert(parts.end(), now.children.begin() + 1, now.children.end());
      for (uint32_t child = 0; child <= added; ++child) {
        const auto index = child == 0 ? now.part : uint32_t(parts.size()) - 1 - added + child;
        Opening next = opening(now.children[child], index);
        if (!next.children.empty()) waiting.push(std::move(next));
      }
    }
  }

  EntryPoint entry(const Part& part) const { return top(part.instance).nodes[part.node].at; }

 private:
  const BlasTop& top(uint32_t instance) const { return tops_[bvh_.instances[instance].mesh]; }

  Opening opening(const Part& part, uint32_t index) const {
    const BlasTop& nodes = top(part.instance);
    const BlasTop::Node& node = nodes.nodes[part.node];
    Opening result{0.0f, index, {}};
    float surface = 0.0f;
    for (uint32_t child = node.first; child < node.first + node.children; ++child) {
      const Box box = world_box(nodes.boxes_below(child), bvh_.instances[part.instance].to_world);
      result.children.push_back({part.instance, child, box});
      surface += half_area(box);
    }
    const float before = half_area(part.box);
    if (!(surface < most_surface * before)) return {};
    result.gain = before - surface;
    return result;
  }

  const SceneBvh& bvh_;
  std::vector<BlasTop> tops_;
};

}  // namespace

TlasInput tlas_input(const SceneBvh& bvh) {
  TlasInput input{{}, {}, instance_boxes(bvh)};
  const auto count = uint32_t(input.boxes.size());
  for (uint32_t i = 0; i < count; ++i)
    input.instances.push_back(i);
  if (!bvh.options.rebraid || count < 2) return input;

  const Braider braider(bvh);
  std::vector<Part> parts;
  for (uint32_t i = 0; i < count; ++i)
    parts.push_back({i, 0, input.boxes[i]});
  braider.open(parts, uint32_t(std::min((rebraid_budget - 1) * uint64_t(count), most_added)));
  if (parts.size() == count) return input;

  input = {};
  for (const Part& part : parts) {
    input.instances.push_back(part.instance);
    input.entries.push_back(braider.entry(part));
    input.boxes.push_back(part.box);
  }
  return input;
}

std::vector<Box> part_boxes(const SceneBvh& bvh, std::span<const uint32_t> instances,
                            std::span<const uint32_t> nodes) {
  std::map<std::pair<uint32_t, uint32_t>, std::vector<Box>> covers;  // by mesh and node
  std::vector<Box> boxes;
  for (size_t i = 0; i < instances.size(); ++i) {
    const PlacedInstance& placed = bvh.instances[instances[i]];
    std::vector<Box>& part = covers[{placed.mesh, nodes[i]}];
    if (part.empty()) part = cover(bvh.blases[placed.mesh]->tree, nodes[i]);
    boxes.push_back(world_box(part, placed.to_world));
  }
  return boxes;
}

}  // namespace tracer
