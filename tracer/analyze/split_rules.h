// The rules for triangles that are in several leaves, each with a part of them.
#pragma once

#include "tracer/analyze/tree_rules.h"

namespace tracer {

// By primitive: how many leaves it is in.
std::vector<uint32_t> leaves_of_each(const TreeToCheck& of);

void check_covered(const TreeToCheck& of, FindingList& found);
void check_idle_reference(const TreeToCheck& of, FindingList& found);

}  // namespace tracer
