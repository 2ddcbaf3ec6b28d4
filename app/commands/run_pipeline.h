// Running the pipeline for a command, to the end.
#pragma once

#include <memory>
#include <stop_token>

#include "app/commands/command.h"
#include "app/commands/scene_options.h"
#include "tracer/pipeline.h"

namespace app {

// Ctrl-C: exit status 130.
struct Interrupted {};

// For commands that want the BVH alone.
inline const tracer::RenderOptions smallest_picture = {
    .width = 1, .height = 1, .ray_depth = 0, .samples = 1, .shadows = false};

// The complete film for the settings, from the typed camera, with progress on the error stream.
// Warnings of a scene that was not in the pipeline before are printed there too. Throws
// tracer::Error with the pipeline's message, and Interrupted.
std::shared_ptr<const tracer::Snapshot> run_pipeline(tracer::Pipeline& pipeline,
                                                     const SceneOptions& options,
                                                     tracer::Settings settings,
                                                     const std::stop_token& stop,
                                                     CommandContext& context);

}  // namespace app
