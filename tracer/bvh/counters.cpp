// The counters and ray classes as tables.
#include "tracer/bvh/counters.h"

namespace tracer {
namespace {

constexpr CounterRow counter_rows[] = {
    {"nodes", "Nodes visited",
     "Inner nodes that rays entered; each visit tests the boxes of all children", "nodes per pixel",
     &Counters::nodes},
    {"leaves", "Leaves visited", "Leaves that rays entered", "leaves per pixel", &Counters::leaves},
    {"triangles", "Triangle tests", "Ray-triangle tests, hit or missed", "tests per pixel",
     &Counters::triangles},
    {"instances", "Instances entered", "Instances whose own tree rays entered",
     "instances per pixel", &Counters::instances},
    {"rays", "Rays", "Rays cast for the pixel", "rays per pixel", &Counters::rays},
};

constexpr RayClassRow ray_class_rows[] = {
    {"primary", "Primary rays", "From the camera"},
    {"shadow", "Shadow rays", "From a surface to a light"},
    {"reflection", "Reflection rays", "From mirrors, and reflected by glass"},
    {"refraction", "Refraction rays", "Into glass and out of it"},
};
static_assert(std::size(ray_class_rows) == ray_class_count);

}  // namespace

std::span<const CounterRow> counters() {
  return counter_rows;
}

std::span<const RayClassRow> ray_classes() {
  return ray_class_rows;
}

}  // namespace tracer
