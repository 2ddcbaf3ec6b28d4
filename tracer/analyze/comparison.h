// Builds of one scene side by side: what each takes to build, and what primary rays cost in it.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tracer/analyze/blend.h"
#include "tracer/progress.h"
#include "tracer/settings.h"

namespace tracer {

// The primary rays that builds are compared by.
struct ComparisonView {
  Camera camera;
  int width = 1280, height = 720;  // pixels: one counted ray each
  float time = 0.0f;               // seconds; poses the instances
  InstanceMotion motion;
  bool operator==(const ComparisonView&) const = default;
};

enum class BuildState { waiting, done, failed };

// Figures are of all BLASes, as in the report; of the last of several builds.
struct ComparedBuild {
  BuildOptions options;
  ComparisonView view;
  BuildState state = BuildState::waiting;
  std::string error;  // one sentence, if it failed

  double build_ms = 0.0;  // wall time of all BLASes: the median of several builds if they are quick
  int builds = 0;
  double mtris_per_s = 0.0;  // million triangles of the meshes built a second
  double sah = 0.0;
  double epo = 0.0, epo_standard_error = 0.0;
  uint64_t nodes = 0;
  uint32_t depth = 0;
  uint64_t bytes = 0;
  double nodes_per_ray = 0.0, triangles_per_ray = 0.0;  // means over the primary rays
  double mrays_per_s = 0.0;                             // one thread, without shading
};

// What a primary ray costs: nodes Ct + triangle tests Ci.
double measured_cost(const ComparedBuild& build);

// Builds, measures and traces one after the other, publishing all rows after each; options that
// cannot be built give a row that says why. Stopped: the rest keeps waiting. `look` has a material
// for each of the scene's. Other work on the machine falsifies times and speeds.
std::vector<ComparedBuild> compare_builds(
    const Scene& scene, const Look& look, std::span<const BuildOptions> options,
    const ComparisonView& view, const Job& job,
    const std::function<void(std::vector<ComparedBuild>)>& publish = nullptr);

// Rows of the table of compared builds: one figure each.
struct ComparisonColumn {
  std::string_view id, label, unit, help;
  double (*value)(const ComparedBuild&);
  int decimals;
};
std::span<const ComparisonColumn> comparison_columns();

// Builds that no other one beats in both build time and measured cost.
std::vector<bool> pareto_front(std::span<const ComparedBuild> builds);

// Fitted to the rows that are done.
std::optional<Blend> fit_blend(std::span<const ComparedBuild> builds);

// "binned + rotations, bins 16": the builder's id, and what is not as by default.
std::string describe(const BuildOptions& options);

}  // namespace tracer
