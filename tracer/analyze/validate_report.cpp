// What a validation found.
#include "tracer/analyze/validate_report.h"

#include <algorithm>

#include <fmt/format.h>

namespace tracer {
namespace {

Json index_json(uint32_t index) {
  return index == none ? Json() : Json(index);
}

Json finding_json(const Finding& finding) {
  return {{"rule", finding.rule},
          {"severity", name(finding.severity)},
          {"level", finding.bvh == none ? "tlas" : "blas"},
          {"bvh", index_json(finding.bvh)},
          {"node", index_json(finding.node)},
          {"triangle", index_json(finding.triangle)},
          {"message", finding.message}};
}

std::string place(const Finding& finding) {
  std::string text = finding.bvh == none ? "top level" : fmt::format("mesh {}", finding.bvh);
  if (finding.node != none) text += fmt::format(", node {}", finding.node);
  if (finding.triangle != none) text += fmt::format(", triangle {}", finding.triangle);
  return text;
}

}  // namespace

Json validation_json(const Snapshot& snapshot, const Validation& validation) {
  Json findings = Json::array();
  for (const Finding& finding : validation.findings)
    findings.push_back(finding_json(finding));
  return {{"schema", 1},
          {"scene", scene_json(*snapshot.scene)},
          {"builder", snapshot.bvh->options.builder},
          {"layout", snapshot.settings.build.layout},
          {"findings", findings},
          {"trees_checked", validation.trees_checked},
          {"rays_checked", validation.rays_checked},
          {"mismatches", validation.mismatches},
          {"machine", machine_json()}};
}

std::string validation_text(const Snapshot& snapshot, const Validation& validation) {
  std::string out;
  for (const Finding& finding : validation.findings) {
    out += fmt::format("{}: {}: {}: {}\n", name(finding.severity), finding.rule, place(finding),
                       finding.message);
  }
  const auto errors =
      std::count_if(validation.findings.begin(), validation.findings.end(),
                    [](const Finding& finding) { return finding.severity == Severity::error; });
  out += fmt::format("{}, {}: {} trees held against {} rules, ", snapshot.scene->name,
                     snapshot.bvh->options.builder, validation.trees_checked, tree_rules().size());
  if (validation.rays_checked > 0) {
    out += fmt::format("{} rays against brute force, {} differ", validation.rays_checked,
                       validation.mismatches);
  } else {
    out += "no rays compared";
  }
  return out + fmt::format("; errors {}, warnings {}\n", errors,
                           ptrdiff_t(validation.findings.size()) - errors);
}

}  // namespace tracer
