// A picture of the whole workspace, drawn without a display.
#pragma once

#include <filesystem>

#include "tracer/settings.h"

namespace app {

struct ScreenshotOptions {
  tracer::Settings settings;  // traced to the end before the workspace is drawn
  tracer::ViewOptions view;
  int width = 1600;  // pixels, 320..max_image_size
  int height = 900;
  float scale = 1.0f;  // of text and controls, 0.5..4
};

// Writes a PNG; "-" is standard output. Throws tracer::Error: bad settings, no EGL, an unwritable
// file.
void write_workspace_screenshot(const ScreenshotOptions& options,
                                const std::filesystem::path& file);

}  // namespace app
