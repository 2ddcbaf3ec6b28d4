// The probes that keep more than counters.
#include "tracer/bvh/probe.h"

#include <utility>

namespace tracer {

Visits no_visits(const SceneBvh& bvh) {
  Visits visits;
  visits.tlas.resize(bvh.tlas.nodes.size());
  for (const auto& blas : bvh.blases)
    visits.blases.emplace_back(blas->tree.nodes.size());
  return visits;
}

std::string_view name(StepKind kind) {
  constexpr std::string_view names[] = {"node", "leaf", "triangle", "instance"};
  return names[static_cast<size_t>(kind)];
}

std::string_view name(StepResult result) {
  constexpr std::string_view names[] = {"entered", "missed", "behind", "tested", "hit"};
  return names[static_cast<size_t>(result)];
}

StepKind LogProbe::kind_of(uint32_t node) const {
  const Bvh& tree = tree_ ? *tree_ : bvh.tlas;
  return is_leaf(tree.nodes[node]) ? StepKind::leaf : StepKind::node;
}

void LogProbe::enter_instance(uint32_t instance, uint32_t mesh) {
  steps.push_back({StepKind::instance, StepResult::entered, instance, none, 0, 0, best_, stack_});
  tree_ = &bvh.blases[mesh]->tree;
  instance_ = instance;
  std::swap(stack_, tlas_stack_);
  std::swap(spans_, tlas_spans_);
  stack_.clear();
  spans_.clear();
}

void LogProbe::leave_instance() {
  tree_ = nullptr;
  instance_ = none;
  std::swap(stack_, tlas_stack_);
  std::swap(spans_, tlas_spans_);
}

void LogProbe::box(uint32_t node, float entry, float exit, float best) {
  best_ = best;
  if (entry <= exit && entry <= best) {
    if (spans_.size() <= node) spans_.resize(node + 1);
    spans_[node] = {entry, exit};
  } else {
    steps.push_back({kind_of(node), entry <= exit ? StepResult::behind : StepResult::missed, node,
                     instance_, entry, exit, best, stack_});
  }
}

void LogProbe::enter(StepKind kind, uint32_t node) {
  steps.push_back({kind, StepResult::entered, node, instance_, spans_[node].entry,
                   spans_[node].exit, best_, stack_});
}

void LogProbe::inner(uint32_t node) {
  enter(StepKind::node, node);
}

void LogProbe::leaf(uint32_t node) {
  enter(StepKind::leaf, node);
}

void LogProbe::behind(uint32_t node, float entry, float best) {
  best_ = best;
  steps.push_back(
      {kind_of(node), StepResult::behind, node, instance_, entry, spans_[node].exit, best, stack_});
}

void LogProbe::pushed(uint32_t node) {
  stack_.push_back(node);
}

void LogProbe::popped() {
  stack_.pop_back();
}

void LogProbe::triangle(uint32_t triangle, bool hit, float t) {
  if (hit) best_ = t;
  steps.push_back({StepKind::triangle, hit ? StepResult::hit : StepResult::tested, triangle,
                   instance_, t, t, best_, stack_});
}

}  // namespace tracer
