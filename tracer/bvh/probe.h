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
  void enter_instance(uint32_t /*instance*/, uint32_t /*mesh*/) {}
  void leave_instance() {}
  // The box of a node was tested: the ray is inside from entry to exit (never if entry > exit), and
  // it is taken up if that begins before the nearest hit so far, at `best`.
  void box(uint32_t /*node*/, float /*entry*/, float /*exit*/, float /*best*/) {}
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
  void enter_instance(uint32_t, uint32_t) { ++counters.instances; }
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
  void enter_instance(uint32_t, uint32_t mesh) { tree = &visits.blases[mesh]; }
  void leave_instance() { tree = &visits.tlas; }
  void inner(uint32_t node) { ++(*tree)[node]; }
  void leaf(uint32_t node) { ++(*tree)[node]; }
};

// One ray, step by step.
enum class StepKind : uint8_t { node, leaf, triangle, instance };
enum class StepResult : uint8_t { entered, missed, behind, tested, hit };
std::string_view name(StepKind kind);
std::string_view name(StepResult result);

struct Step {
  StepKind kind = StepKind::node;
  StepResult result = StepResult::entered;
  uint32_t id = 0;           // of the node in its tree, the triangle or the instance
  uint32_t instance = none;  // none: the TLAS
  float t_entry = 0.0f;      // of the box; of a triangle the hit's t
  float t_exit = 0.0f;
  float t_best = infinity;      // nearest hit so far, after the step
  std::vector<uint32_t> stack;  // nodes waiting in the same tree, the next one last
};

struct LogProbe : NoProbe {
  const SceneBvh& bvh;
  std::vector<Step> steps;

  explicit LogProbe(const SceneBvh& of) : bvh(of) {}
  void enter_instance(uint32_t instance, uint32_t mesh);
  void leave_instance();
  void box(uint32_t node, float entry, float exit, float best);
  void inner(uint32_t node);
  void leaf(uint32_t node);
  void behind(uint32_t node, float entry, float best);
  void pushed(uint32_t node);
  void popped();
  void triangle(uint32_t triangle, bool hit, float t);

 private:
  struct Span {
    float entry, exit;
  };
  void enter(StepKind kind, uint32_t node);
  StepKind kind_of(uint32_t node) const;

  const Bvh* tree_ = nullptr;  // nullptr: the TLAS
  uint32_t instance_ = none;
  float best_ = infinity;
  std::vector<uint32_t> stack_, tlas_stack_;
  std::vector<Span> spans_, tlas_spans_;  // of the nodes tested, by node
};

}  // namespace tracer
