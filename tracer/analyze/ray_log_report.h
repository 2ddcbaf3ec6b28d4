// The rays of a pixel as JSON and as text for a terminal.
#pragma once

#include "tracer/analyze/ray_log.h"
#include "tracer/analyze/report.h"

namespace tracer {

// {"schema", "scene", "pixel", "builder", "layout", "settings", "rays": [...], "machine"}. What
// does not apply or is infinite is null; the fields of rays and steps are those of CastRay and
// Step.
Json ray_log_json(const Snapshot& snapshot, const RayLog& log);

// All rays as a tree with their counters, then the steps of those that are asked for (indices).
std::string ray_log_text(const Snapshot& snapshot, const RayLog& log,
                         std::span<const size_t> with_steps);

}  // namespace tracer
