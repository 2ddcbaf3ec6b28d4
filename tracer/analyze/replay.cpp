// A build, step by step.
#include "tracer/analyze/replay.h"

#include <algorithm>
#include <queue>

namespace tracer {
namespace {

std::vector<uint32_t> splits(const TreeTable& table) {
  std::vector<uint32_t> order;
  std::vector<uint32_t> stack = {0};
  while (!stack.empty()) {
    const uint32_t node = stack.back();
    stack.pop_back();
    const TableNode& row = table.nodes[node];
    if (is_leaf(row)) continue;
    order.push_back(node);
    for (uint32_t child = row.first + row.children; child-- > row.first;)
      stack.push_back(child);
  }
  return order;
}

std::vector<uint32_t> merges(const TreeTable& table) {
  const auto is_later = [&](uint32_t a, uint32_t b) {
    const float area_a = half_area(table.nodes[a].box);
    const float area_b = half_area(table.nodes[b].box);
    return area_a != area_b ? area_a > area_b : a > b;
  };
  std::priority_queue<uint32_t, std::vector<uint32_t>, decltype(is_later)> ready(is_later);
  std::vector<uint8_t> missing(table.nodes.size());  // children that are not there yet
  const auto made = [&](uint32_t node) {
    const uint32_t parent = table.nodes[node].parent;
    if (parent != none && --missing[parent] == 0) ready.push(parent);
  };
  for (size_t i = 0; i < table.nodes.size(); ++i)
    missing[i] = table.nodes[i].children;
  for (uint32_t i = 0; i < table.nodes.size(); ++i) {
    if (is_leaf(table.nodes[i])) made(i);
  }
  std::vector<uint32_t> order;
  while (!ready.empty()) {
    order.push_back(ready.top());
    ready.pop();
    made(order.back());
  }
  return order;
}

// What a box costs while it is not split: all of its references are tested.
double as_leaf(const TreeTable& table, uint32_t node) {
  return area_share(table, node) * double(table.nodes[node].references) *
         double(table.intersection_cost);
}

// How much one step changes the cost of what there is.
double change(const Replay& replay, uint32_t node) {
  const TreeTable& table = *replay.table;
  const TableNode& row = table.nodes[node];
  const double own = own_sah(table, node);
  double change = own;
  if (replay.bottom_up) {
    // Each ray tests each root: a pair of boxes is half a step. One root takes the children's
    // place.
    change -= 0.5 * double(table.traversal_cost) * double(row.children - 1);
    return change;
  }
  change -= as_leaf(table, node);
  for (uint32_t child = row.first; child < row.first + row.children; ++child)
    change += as_leaf(table, child);
  return change;
}

double cost_at_first(const Replay& replay) {
  const TreeTable& table = *replay.table;
  if (!replay.bottom_up) return as_leaf(table, 0);
  double cost = 0.0;
  size_t roots = 0;
  for (uint32_t node = 0; node < table.nodes.size(); ++node) {
    if (!is_leaf(table.nodes[node])) continue;
    cost += own_sah(table, node);
    ++roots;
  }
  return cost + 0.5 * double(table.traversal_cost) * double(roots - 1);
}

}  // namespace

Replay replay(std::shared_ptr<const TreeTable> table, bool bottom_up) {
  Replay result;
  result.table = std::move(table);
  result.bottom_up = bottom_up;
  const TreeTable& of = *result.table;
  if (of.nodes.empty()) return result;
  result.order = bottom_up ? merges(of) : splits(of);
  result.step_of.assign(of.nodes.size(), none);
  double cost = cost_at_first(result);
  uint32_t boxes = 1;
  if (bottom_up) {
    boxes = uint32_t(std::count_if(of.nodes.begin(), of.nodes.end(),
                                   [](const TableNode& row) { return is_leaf(row); }));
  }
  result.sah.push_back(float(cost));
  result.boxes.push_back(boxes);
  for (size_t step = 0; step < result.order.size(); ++step) {
    result.step_of[result.order[step]] = uint32_t(step);
    cost += change(result, result.order[step]);
    result.sah.push_back(float(cost));
    const uint32_t more = of.nodes[result.order[step]].children - 1u;
    boxes = bottom_up ? boxes - more : boxes + more;
    result.boxes.push_back(boxes);
  }
  return result;
}

std::vector<uint32_t> boxes_after(const Replay& replay, size_t steps, size_t most) {
  const TreeTable& table = *replay.table;
  std::vector<uint32_t> boxes;
  if (table.nodes.empty()) return boxes;
  const auto is_done = [&](uint32_t node) {
    return !is_leaf(table.nodes[node]) && replay.step_of[node] < steps;
  };
  std::vector<uint32_t> stack = {0};
  while (!stack.empty()) {
    const uint32_t node = stack.back();
    stack.pop_back();
    const TableNode& row = table.nodes[node];
    const bool shown = replay.bottom_up ? is_done(node) || is_leaf(row) : !is_done(node);
    if (shown) {
      boxes.push_back(node);
      continue;
    }
    for (uint32_t child = row.first; child < row.first + row.children; ++child)
      stack.push_back(child);
  }
  const auto is_larger = [&](uint32_t a, uint32_t b) {
    const float area_a = half_area(table.nodes[a].box);
    const float area_b = half_area(table.nodes[b].box);
    return area_a != area_b ? area_a > area_b : a < b;
  };
  const size_t kept = std::min(boxes.size(), most);
  std::partial_sort(boxes.begin(), boxes.begin() + ptrdiff_t(kept), boxes.end(), is_larger);
  boxes.resize(kept);
  return boxes;
}

double gain_of(const Replay& replay, size_t step) {
  return double(replay.sah[step]) - double(replay.sah[step + 1]);
}

}  // namespace tracer
