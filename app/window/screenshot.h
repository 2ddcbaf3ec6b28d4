// A picture of the whole workspace, drawn without a display.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tracer/settings.h"

namespace app {

struct ScreenshotOptions {
  tracer::Settings settings;  // traced to the end before the workspace is drawn
  tracer::ViewOptions view;
  int width = 1600;  // pixels, 320..max_image_size
  int height = 900;
  float scale = 1.0f;                  // of text and controls, 0.5..4
  std::optional<tracer::ivec2> pixel;  // selected: its rays are followed in the Ray panel
  std::vector<std::string> panels;     // ids; brought to the front of their regions
  std::string node;  // selected: "tlas:3", or the mesh's number as in "0:12"; or none
};

// Writes a PNG; "-" is standard output. Throws tracer::Error: bad settings, an unknown panel or
// node, a pixel outside the picture, no EGL, an unwritable file.
void write_workspace_screenshot(const ScreenshotOptions& options,
                                const std::filesystem::path& file);

}  // namespace app
