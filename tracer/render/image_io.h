// Writing pictures.
#pragma once

#include <filesystem>

#include "tracer/render/colorize.h"

namespace tracer {

// By the file's ending: .png writes colours; .exr and .hdr write `linear` radiance (width * height
// * 3 floats, row 0 on top). Written beside the target and renamed. "-" writes PNG to standard
// output. Throw Error ("file: ...").
void write_png(const std::filesystem::path& file, const Image& image);
void write_float_image(const std::filesystem::path& file, int width, int height,
                       const std::vector<vec3>& linear);

}  // namespace tracer
