// A timeline as JSON and as a table for terminals.
#pragma once

#include "tracer/analyze/report.h"
#include "tracer/analyze/timeline.h"

namespace tracer {

Json timeline_json(const Scene& scene, const Timeline& timeline);
std::string timeline_text(const Timeline& timeline);

}  // namespace tracer
