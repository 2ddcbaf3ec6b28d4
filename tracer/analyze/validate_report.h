// What a validation found, as JSON and as text for a terminal.
#pragma once

#include "tracer/analyze/report.h"
#include "tracer/analyze/validate.h"

namespace tracer {

// {"schema", "scene", "builder", "layout", "findings": [...], "trees_checked", "rays_checked",
// "mismatches", "machine"}. A finding's bvh is the mesh of a BLAS; what does not apply is null.
Json validation_json(const Snapshot& snapshot, const Validation& validation);
std::string validation_text(const Snapshot& snapshot, const Validation& validation);

}  // namespace tracer
