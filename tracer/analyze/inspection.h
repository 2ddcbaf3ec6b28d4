// The trees of a scene as tables, and what is known of their nodes.
#pragma once

#include <memory>
#include <vector>

#include "tracer/analyze/frame_visits.h"
#include "tracer/analyze/measures.h"
#include "tracer/analyze/node_measures.h"
#include "tracer/progress.h"

namespace tracer {

// A node of a tree.
struct NodePlace {
  uint32_t mesh = none;  // whose BLAS it is; none: the TLAS
  uint32_t node = 0;
  bool operator==(const NodePlace&) const = default;
};

struct Inspection {
  std::shared_ptr<const SceneBvh> bvh;                   // that the tables are of
  std::vector<std::shared_ptr<const TreeTable>> blases;  // by mesh
  std::shared_ptr<const TreeTable> tlas;
  // By mesh, the lowest nodes of its BLAS at which rays begin: together they are above every leaf,
  // and none is above another. None at all if all rays begin at roots.
  std::vector<std::vector<uint32_t>> entered;
};

// Tables of BLASes that `before` (nullptr: nothing) has already are taken over. Stopped: without
// tables.
Inspection inspect(const std::shared_ptr<const SceneBvh>& bvh, const Inspection* before,
                   const Job& job);

// The visits of a frame, and of which trees.
struct CountedVisits {
  std::shared_ptr<const SceneBvh> bvh;
  std::shared_ptr<const FrameVisits> visits;
};

// The table of a mesh's BLAS, or of the TLAS (none); nullptr: not known.
const TreeTable* table_of(const Inspection& inspection, uint32_t mesh);

// How many rays enter the tree, by the visits of its nodes: those of the root, or if rays begin at
// nodes below it, as many as would enter those nodes if they all came through the root's box.
double root_visits(const Inspection& inspection, uint32_t mesh, std::span<const uint32_t> visits);

// What is known of a tree's nodes, put together from results that may be of older trees or missing
// (nullptr): what does not belong to the inspected tree is left out. Kept by whoever shows them,
// since sums and shares take a pass over the nodes.
class NodeFigures {
 public:
  NodeFigures() = default;
  NodeFigures(std::shared_ptr<const Inspection> inspection, uint32_t mesh, int ray_class,
              std::shared_ptr<const CountedVisits> visits,
              std::shared_ptr<const Measures> measures);

  // Without a table if there is none. Valid as long as this is there.
  const TreeFacts& facts() const { return facts_; }

  // Whether it would be made of just these.
  bool is_of(const std::shared_ptr<const Inspection>& inspection, uint32_t mesh, int ray_class,
             const std::shared_ptr<const CountedVisits>& visits,
             const std::shared_ptr<const Measures>& measures) const;

 private:
  std::shared_ptr<const Inspection> inspection_;
  std::shared_ptr<const CountedVisits> counted_;
  std::shared_ptr<const Measures> measures_;
  uint32_t mesh_ = none;
  int ray_class_ = ray_class_count;
  std::vector<uint32_t> visits_;
  std::vector<float> growth_;
  TreeFacts facts_;
};

}  // namespace tracer
