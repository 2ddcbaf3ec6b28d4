// Saving pictures from the workspace.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "tracer/render/overlay.h"

namespace app {

// What the viewport shows, with its legend, as PNG; linear radiance as .exr or .hdr. Gives the
// message for the user. Throws tracer::Error.
std::string save_picture(std::shared_ptr<const tracer::Snapshot> snapshot, tracer::ViewOptions view,
                         const tracer::BoxSources& boxes, const std::filesystem::path& file);

// A name that no file has yet: "bvhscope-2026-11-22-101500.png" in the user's folder for pictures,
// or in the current one.
std::filesystem::path new_screenshot_name();

}  // namespace app
