// Conditions on a report: "sah<40".
#pragma once

#include <string>
#include <string_view>

#include "tracer/analyze/report.h"

namespace app {

struct Assertion {
  std::string text;   // as typed
  std::string field;  // "sah", "rays.primary.nodes.mean"; of every build, or of the whole report
  std::string comparison;
  double limit = 0.0;
};

// FIELD then one of < <= > >= == != then a number. Throws UsageError.
Assertion parse_assertion(std::string_view text);

// One line for each build that does not meet the assertion: "binned: sah is 51.2, not < 40". Empty:
// it holds. Throws UsageError if there is no such number in the report.
std::string failures(const Assertion& assertion, const tracer::Json& report);

}  // namespace app
