// The report as JSON and as text for a terminal; also the parts that every JSON output begins with.
#pragma once

#include <span>
#include <stop_token>
#include <string>

#include <nlohmann/json.hpp>

#include "tracer/pipeline.h"

namespace tracer {

using Json = nlohmann::ordered_json;

Json scene_json(const Scene& scene);
Json machine_json();  // cpu, threads, isa
Json settings_json(const Settings& settings);

// One entry of "builds". Estimates the EPO and the overlaps, which takes a part of a second for a
// million triangles; stopped, these figures are of less work. mrays_per_s is what all threads
// together reach while each traces rays of the class and does not shade; 0 if the film has only the
// counting pass.
Json build_json(const Snapshot& snapshot, const std::stop_token& stop = {});

// One snapshot a build; all of the same scene.
Json report_json(std::span<const std::shared_ptr<const Snapshot>> snapshots,
                 const std::stop_token& stop = {});
std::string report_text(const Json& report);

}  // namespace tracer
