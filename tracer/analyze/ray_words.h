// The steps of a logged ray in words.
#pragma once

#include <string>
#include <vector>

#include "tracer/analyze/ray_log.h"

namespace tracer {

// What became of a child when its parent was taken up.
enum class ChildOrder { first, waits, dropped };
struct TestedChild {
  uint32_t node = none;
  ChildOrder order = ChildOrder::dropped;
  uint32_t step = none;  // that takes it up or drops it; none: the ray ended while it waited
};

// Of an inner node that the step enters; none for other steps. Linear in the steps.
std::vector<TestedChild> tested_children(const LoggedRay& ray, size_t step);

// Wide layouts enter their roots without a test: entry and exit of such a step are the ray's ends.
bool is_untested(const SceneBvh& bvh, const LoggedRay& ray, size_t step);

// "node 34", "leaf 7", "triangle 812", "instance 5".
std::string what(const Step& step);

// What happened and why, in a few words: "behind: something nearer was hit while it waited".
std::string why(const LoggedRay& ray, size_t step);

// The same in sentences, with distances, the children and their order, and the stack.
std::string explain(const SceneBvh& bvh, const LoggedRay& ray, size_t step);

// "t 4.321, instance 5, triangle 812", or what its absence means for a ray of the class.
std::string hit_words(const CastRay& cast);

}  // namespace tracer
