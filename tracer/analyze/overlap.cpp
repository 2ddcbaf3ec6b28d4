// Overlap of siblings and of instances, and empty space.
#include "tracer/analyze/overlap.h"

#include <algorithm>
#include <cmath>
#include <stop_token>

#include <tbb/parallel_for.h>

namespace tracer {
namespace {

using glm::dvec3;

// Doubles keep the products of extents up to 1e19 apart from infinity.
dvec3 extents(const Box& box) {
  return is_empty(box) ? dvec3(0.0) : dvec3(box.hi) - dvec3(box.lo);
}
double half_area(const dvec3& e) {
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

// V(box) / V(node), in the extents that the node has.
double filled(const Box& box, const dvec3& node) {
  if (is_empty(box)) return 0.0;
  const dvec3 e = extents(box);
  double product = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (node[axis] > 0.0) product *= e[axis] / node[axis];
  }
  return product;
}

// Calls visit(instance) for the instances in leaves whose box meets `box`.
template <class Visit>
void for_each_near(const Bvh& tree, const Box& box, const Visit& visit) {
  std::vector<uint32_t> stack = {0};
  while (!stack.empty()) {
    const BvhNode& node = tree.nodes[stack.back()];
    stack.pop_back();
    if (is_empty(intersected(box_of(node), box))) continue;
    if (!is_leaf(node)) {
      stack.push_back(node.first);
      stack.push_back(node.first + 1);
      continue;
    }
    for (uint32_t k = node.first; k < node.first + node.count; ++k)
      visit(tree.references[k]);
  }
}

bool is_worse(const InstancePair& p, const InstancePair& q) {
  if (p.overlap != q.overlap) return p.overlap > q.overlap;
  return p.a != q.a ? p.a < q.a : p.b < q.b;
}

constexpr size_t worst_pairs = 16;
constexpr uint64_t most_instances = 2048;  // asked: any number of instances may overlap each

// The answer of one instance.
struct Neighbours {
  double sum = 0.0;
  uint64_t count = 0;
  std::vector<InstancePair> worst;
};

Neighbours neighbours(const Bvh& tlas, const std::vector<Box>& boxes, uint32_t instance) {
  Neighbours result;
  const Box& box = boxes[instance];
  std::vector<uint32_t> near;
  for_each_near(tlas, box, [&](uint32_t other) { near.push_back(other); });
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  for (const uint32_t other : near) {
    const Box both = common(box, boxes[other]);
    if (other == instance || is_empty(both)) continue;
    const double smaller = std::min(half_area(extents(box)), half_area(extents(boxes[other])));
    const double ratio = smaller > 0.0 ? half_area(extents(both)) / smaller : 1.0;
    result.sum += ratio;
    ++result.count;
    const auto [a, b] = std::minmax(instance, other);
    result.worst.push_back({a, b, float(ratio)});
  }
  const size_t kept = std::min(result.worst.size(), worst_pairs);
  std::partial_sort(result.worst.begin(), result.worst.begin() + ptrdiff_t(kept),
                    result.worst.end(), is_worse);
  result.worst.resize(kept);
  return result;
}

}  // namespace

Box common(const Box& a, const Box& b) {
  const Box both = intersected(a, b);
  if (is_empty(both)) return {};
  for (int axis = 0; axis < 3; ++axis) {
    const bool flat = a.lo[axis] == a.hi[axis] || b.lo[axis] == b.hi[axis];
    if (both.lo[axis] == both.hi[axis] && !flat) return {};
  }
  return both;
}

namespace {

// The part of the node that the boxes fill inside of `inside`: each one's own, less what the boxes
// after it fill of that.
double filled_by(std::span<const Box> boxes, const Box& inside, const dvec3& node) {
  double sum = 0.0;
  for (size_t i = 0; i < boxes.size(); ++i) {
    const Box both = intersected(boxes[i], inside);
    if (is_empty(both)) continue;
    sum += filled(both, node) - filled_by(boxes.subspan(i + 1), both, node);
  }
  return sum;
}

}  // namespace

ChildFit child_fit(const Box& node, std::span<const Box> children) {
  const dvec3 e = extents(node);
  const double area = half_area(e);
  ChildFit fit;
  if (!(area > 0.0)) return fit;
  for (size_t i = 0; i < children.size(); ++i) {
    for (size_t j = i + 1; j < children.size(); ++j)
      fit.overlap += half_area(extents(common(children[i], children[j]))) / area;
  }
  fit.empty_space = std::clamp(1.0 - filled_by(children, node, e), 0.0, 1.0);
  return fit;
}

Overlap overlap(const Bvh& tree) {
  double areas = 0.0;
  double shared = 0.0;
  double empty = 0.0;
  for (const BvhNode& node : tree.nodes) {
    if (is_leaf(node)) continue;
    const Box children[] = {box_of(tree.nodes[node.first]), box_of(tree.nodes[node.first + 1])};
    const ChildFit fit = child_fit(box_of(node), children);
    const double area = half_area(extents(box_of(node)));
    areas += area;
    shared += area * fit.overlap;
    empty += area * fit.empty_space;
  }
  return areas > 0.0 ? Overlap{shared / areas, empty / areas} : Overlap{};
}

Overlap blas_overlap(const SceneBvh& bvh) {
  std::vector<Overlap> each(bvh.blases.size());
  tbb::parallel_for(size_t{0}, each.size(),
                    [&](size_t i) { each[i] = overlap(bvh.blases[i]->tree); });
  Overlap all;
  double triangles = 0.0;
  for (size_t i = 0; i < each.size(); ++i) {
    const std::vector<uint32_t>& references = bvh.blases[i]->tree.references;
    if (references.empty()) continue;
    const double count = 1.0 + *std::max_element(references.begin(), references.end());
    triangles += count;
    all.siblings += count * each[i].siblings;
    all.empty_space += count * each[i].empty_space;
  }
  if (triangles == 0.0) return {};
  return {all.siblings / triangles, all.empty_space / triangles};
}

InstanceOverlap instance_overlap(const SceneBvh& bvh, const std::stop_token& stop) {
  InstanceOverlap result;
  const uint64_t count = bvh.instances.size();
  if (bvh.tlas.nodes.empty() || count == 0) return result;
  const std::vector<Box> boxes = instance_boxes(bvh);
  // A TLAS over parts of instances does not lead to all whose boxes meet.
  const Bvh whole = bvh.entries.empty() ? Bvh() : build({boxes}, bvh.options, nullptr, stop);
  if (stop.stop_requested()) return result;
  const Bvh& tree = bvh.entries.empty() ? bvh.tlas : whole;
  const uint64_t asked = std::min(count, most_instances);
  std::vector<Neighbours> answers(asked);
  tbb::parallel_for(uint64_t{0}, asked, [&](uint64_t i) {
    if (stop.stop_requested()) return;
    answers[i] = neighbours(tree, boxes, uint32_t(i * count / asked));
  });
  if (stop.stop_requested()) return result;

  result.instances_asked = asked;
  for (const Neighbours& answer : answers) {
    result.mean += answer.sum / double(asked);
    result.mean_neighbours += double(answer.count) / double(asked);
    result.worst.insert(result.worst.end(), answer.worst.begin(), answer.worst.end());
  }
  const auto same = [](const InstancePair& p, const InstancePair& q) {
    return p.a == q.a && p.b == q.b;
  };
  std::sort(result.worst.begin(), result.worst.end(), is_worse);
  result.worst.erase(std::unique(result.worst.begin(), result.worst.end(), same),
                     result.worst.end());
  if (result.worst.size() > worst_pairs) result.worst.resize(worst_pairs);
  return result;
}

WastedEntries wasted_entries(const Film& film) {
  WastedEntries wasted;
  for (const std::shared_ptr<const FilmTile>& tile : film.tiles) {
    if (!tile || !tile->facts) continue;
    for (const ClassCounters& counters : tile->facts->counters)
      wasted.entries += counters[int(RayClass::primary)].instances;
    for (const Hit& hit : tile->facts->hits)
      wasted.hits += is_hit(hit) ? 1 : 0;
  }
  return wasted;
}

}  // namespace tracer
