// What scene_bvh.h promises about where the instances of a TLAS are entered, as rules.
#pragma once

#include "tracer/analyze/tree_rules.h"

namespace tracer {

// Nothing is found in a BLAS, nor where every instance is entered at its root. The BLASes keep
// their own rules with `gate`, and so does the TLAS.
void check_entry_nodes(const TreeToCheck& of, FindingList& found);
void check_entry_parts(const TreeToCheck& of, FindingList& found);
void check_entry_boxes(const TreeToCheck& of, FindingList& found);

inline constexpr TreeRule entry_rules[] = {
    {"entry_nodes", "Instances are entered at nodes",
     "Every reference of a TLAS over parts of instances says a node of the instance's BLAS, and a "
     "wide layout the same one, which it keeps.",
     Severity::error, true, check_entry_nodes},
    {"entry_parts", "Parts make the instance",
     "Each leaf of an instance's BLAS is below exactly one of the nodes where it is entered.",
     Severity::error, false, check_entry_parts},
    {"entry_boxes", "Leaves cover parts of instances",
     "The box of a leaf contains, to the bit, those in the world of the parts that it has.",
     Severity::error, false, check_entry_boxes},
};

}  // namespace tracer
