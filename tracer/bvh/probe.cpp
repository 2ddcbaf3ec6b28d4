// The probes that keep more than counters.
#include "tracer/bvh/probe.h"

#include <algorithm>
#include <utility>

#include "tracer/bvh/box_test.h"

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

namespace {

StepKind kind_of(bool leaf) {
  return leaf ? StepKind::leaf : StepKind::node;
}

}  // namespace

void LogProbe::add(StepKind kind, StepResult result, uint32_t id, uint32_t depth, float entry,
                   float exit) {
  steps.push_back({kind, result, id, now_.instance, depth, entry, exit, best_, now_.stack, {}, 0});
}

void LogProbe::enter_instance(uint32_t instance, uint32_t /*mesh*/, const EntryPoint& at) {
  add(StepKind::instance, StepResult::entered, instance, now_.depth, 0.0f, 0.0f);
  steps.back().from = at.node;
  tlas_ = std::move(now_);
  now_ = {};
  now_.instance = instance;
  now_.first = at.node;
  now_.first_depth = at.depth;
}

void LogProbe::leave_instance() {
  now_ = std::move(tlas_);
}

void LogProbe::box(uint32_t node, bool leaf, float entry, float exit, float best) {
  best_ = best;
  const bool is_first = node == now_.first;
  const uint32_t depth = is_first ? now_.first_depth : now_.depth + 1;
  if (!is_first) steps[now_.step].children.push_back(node);
  if (entry <= std::min(exit, best * exit_padding)) {
    now_.children.push_back({node, depth, leaf, entry, exit});
  } else {
    add(kind_of(leaf), entry <= exit ? StepResult::behind : StepResult::missed, node, depth, entry,
        exit);
  }
}

LogProbe::Pending LogProbe::take_child(uint32_t node) {
  const auto at = std::find_if(now_.children.begin(), now_.children.end(),
                               [&](const Pending& child) { return child.node == node; });
  const Pending child = *at;
  now_.children.erase(at);
  return child;
}

void LogProbe::enter(uint32_t node) {
  const Pending taken = take_child(node);
  now_.step = steps.size();
  now_.depth = taken.depth;
  add(kind_of(taken.leaf), StepResult::entered, node, taken.depth, taken.entry, taken.exit);
}

void LogProbe::inner(uint32_t node) {
  enter(node);
}

void LogProbe::leaf(uint32_t node) {
  enter(node);
}

void LogProbe::behind(uint32_t node, float entry, float best) {
  best_ = best;
  const Pending dropped = take_child(node);
  add(kind_of(dropped.leaf), StepResult::behind, node, dropped.depth, entry, dropped.exit);
}

void LogProbe::pushed(uint32_t node) {
  now_.waiting.push_back(take_child(node));
  now_.stack.push_back(node);
}

void LogProbe::popped() {
  now_.children.push_back(now_.waiting.back());
  now_.waiting.pop_back();
  now_.stack.pop_back();
}

void LogProbe::triangle(uint32_t triangle, bool hit, float t) {
  if (hit) best_ = t;
  if (!hit) t = 0.0f;
  add(StepKind::triangle, hit ? StepResult::hit : StepResult::tested, triangle, now_.depth, t, t);
}

}  // namespace tracer
