// What one pixel's rays cost.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "tracer/math/ray.h"

namespace tracer {

struct Counters {
  uint32_t rays = 0;
  uint32_t nodes = 0;      // inner nodes entered; each tests the boxes of two children
  uint32_t leaves = 0;     // leaves entered
  uint32_t triangles = 0;  // ray-triangle tests
  uint32_t instances = 0;  // BLASes entered

  bool operator==(const Counters&) const = default;
  Counters& operator+=(const Counters& other) {
    rays += other.rays;
    nodes += other.nodes;
    leaves += other.leaves;
    triangles += other.triangles;
    instances += other.instances;
    return *this;
  }
};
using ClassCounters = std::array<Counters, ray_class_count>;  // by RayClass

struct CounterRow {
  std::string_view id, label, help, unit;
  uint32_t Counters::*member;
};
std::span<const CounterRow> counters();

struct RayClassRow {
  std::string_view id, label, help;
};
// In the order of RayClass.
std::span<const RayClassRow> ray_classes();

// The counters of one class (index) or of all together (nothing chosen: ray_class_count).
inline Counters of_class(const ClassCounters& by_class, int ray_class) {
  if (ray_class < ray_class_count) return by_class[ray_class];
  Counters sum;
  for (const Counters& counters : by_class)
    sum += counters;
  return sum;
}

}  // namespace tracer
