// Probes: what a traversal may record on its way. The traversal calls every event; a probe that
// does nothing with one costs nothing there.
#pragma once

#include <string_view>
#include <vector>

#include "tracer/bvh/counters.h"
#include "tracer/bvh/scene_bvh.h"

namespace tracer {

// Records nothing, and shows the events there are.
struct NoProbe {
  // A BLAS is entered and left; node events in between are of its tree, others of the TLAS.
  void enter_instance(uint32_t /*instance*/, uint32_t /*mesh*/, const EntryPoint&) {}
  void leave_instance() {}
  // The box of a node was tested: the ray is inside from entry to exit (never if entry > exit), and
  // it is taken up if that begins before the nearest hit so far, at `best` (with exit_padding). In
  // wide layouts a leaf may be an inner node of the canonical tree.
  void box(uint32_t /*node*/, bool /*leaf*/, float /*entry*/, float /*exit*/, float /*best*/) {}
  // A node whose box was hit is taken up ...
  void inner(uint32_t /*node*/) {}
  void leaf(uint32_t /*node*/) {}
  // ... or dropped since something nearer has been hit meanwhile.
  void behind(uint32_t /*node*/, float /*entry*/, float /*best*/) {}
  // The stack of the nodes that wait.
  void pushed(uint32_t /*node*/) {}
  void popped() {}
  void triangle(uint32_t /*triangle*/, bool /*hit*/, float /*t*/) {}
};

// The counters of one pixel and ray class.
struct CountProbe : NoProbe {
  Counters& counters;

  explicit CountProbe(Counters& to) : counters(to) {}
  void enter_instance(uint32_t, uint32_t, const EntryPoint&) { ++counters.instances; }
  void inner(uint32_t) { ++counters.nodes; }
  void leaf(uint32_t) { ++counters.leaves; }
  void triangle(uint32_t, bool, float) { ++counters.triangles; }
};

// How often each node was entered, by tree.
struct Visits {
  std::vector<uint32_t> tlas;
  std::vector<std::vector<uint32_t>> blases;  // by mesh
};
Visits no_visits(const SceneBvh& bvh);

struct VisitProbe : NoProbe {
  Visits& visits;
  std::vector<uint32_t>* tree;

  explicit VisitProbe(Visits& to) : visits(to), tree(&to.tlas) {}
  void enter_instance(uint32_t, uint32_t mesh, const EntryPoint&) { tree = &visits.blases[mesh]; }
  void leave_instance() { tree = &visits.tlas; }
  void inner(uint32_t node) { ++(*tree)[node]; }
  void leaf(uint32_t node) { ++(*tree)[node]; }
};

// A node that is watched: of which rays enter it.
struct Watched {
  uint32_t mesh = none;  // whose BLAS it is of; none: the TLAS
  uint32_t node = 0;
  uint32_t instance = none;  // only as this one enters its BLAS; none: any

  bool operator==(const Watched&) const = default;
};

// Whether a ray enters one node.
struct WatchProbe : NoProbe {
  const Watched& watched;
  bool there;  // in the tree that the node is of
  bool entered = false;

  explicit WatchProbe(const Watched& node) : watched(node), there(node.mesh == none) {}
  void enter_instance(uint32_t instance, uint32_t mesh, const EntryPoint&) {
    there = mesh == watched.mesh && (watched.instance == none || watched.instance == instance);
  }
  void leave_instance() { there = watched.mesh == none; }
  void inner(uint32_t node) { entered |= there && node == watched.node; }
  void leaf(uint32_t node) { entered |= there && node == watched.node; }
};

// One ray, step by step.
enum class StepKind : uint8_t { node, leaf, triangle, instance };
enum class StepResult : uint8_t { entered, missed, behind, tested, hit };
std::string_view name(StepKind kind);
std::string_view name(StepResult result);

// t is measured in units of the ray's direction, in the world and in every instance alike.
struct Step {
  StepKind kind = StepKind::node;
  StepResult result = StepResult::entered;
  uint32_t id = 0;           // of the node in its tree, the triangle or the instance
  uint32_t instance = none;  // whose tree it is; none: the TLAS
  uint32_t depth = 0;        // of the node, edges from its tree's root; else of the leaf it is in
  float t_entry = 0.0f;      // of the box; of a triangle the hit's t, 0 if it was missed
  float t_exit = 0.0f;
  float t_best = infinity;         // nearest hit so far, or the ray's end, after the step
  std::vector<uint32_t> stack;     // nodes waiting in the same tree, the next one last
  std::vector<uint32_t> children;  // whose boxes were tested when the node was entered
  uint32_t from = 0;               // of an instance: the node at which its BLAS is entered
};

// Its cost follows the steps, however large the trees are.
struct LogProbe : NoProbe {
  std::vector<Step> steps;

  void enter_instance(uint32_t instance, uint32_t mesh, const EntryPoint& at);
  void leave_instance();
  void box(uint32_t node, bool leaf, float entry, float exit, float best);
  void inner(uint32_t node);
  void leaf(uint32_t node);
  void behind(uint32_t node, float entry, float best);
  void pushed(uint32_t node);
  void popped();
  void triangle(uint32_t triangle, bool hit, float t);

 private:
  // A node whose box was hit, until it is taken up.
  struct Pending {
    uint32_t node, depth;
    bool leaf;
    float entry, exit;
  };
  // How far the traversal of a tree has come.
  struct Place {
    uint32_t instance = none;
    uint32_t first = 0;  // node, and its depth
    uint32_t first_depth = 0;
    size_t step = 0;                // that took up the last node
    uint32_t depth = 0;             // of that node
    std::vector<Pending> children;  // of that node, hit, and not pushed or taken up yet
    std::vector<Pending> waiting;
    std::vector<uint32_t> stack;  // the nodes of `waiting`
  };
  Pending take_child(uint32_t node);
  void enter(uint32_t node);
  void add(StepKind kind, StepResult result, uint32_t id, uint32_t depth, float entry, float exit);

  Place now_, tlas_;  // tlas_: where the top level goes on after an instance
  float best_ = infinity;
};

}  // namespace tracer
