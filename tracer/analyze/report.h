// The report as JSON and as text for a terminal; also the parts that every JSON output begins with.
#pragma once

#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "tracer/pipeline.h"

namespace tracer {

using Json = nlohmann::ordered_json;

Json scene_json(const Scene& scene);
Json machine_json();  // cpu, threads, isa
Json settings_json(const Settings& settings);
Json build_json(const Snapshot& snapshot);  // one entry of "builds"

// One snapshot a build; all of the same scene.
Json report_json(std::span<const std::shared_ptr<const Snapshot>> snapshots);
std::string report_text(const Json& report);

}  // namespace tracer
