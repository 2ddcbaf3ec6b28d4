// Writing pictures.
#pragma once

#include <filesystem>
#include <string>

#include "tracer/render/film.h"
#include "tracer/render/image.h"

namespace tracer {

// The file formats, as bytes. linear: width * height values, row 0 on top.
std::string png_bytes(const Image& image);
std::string exr_bytes(int width, int height, const std::vector<vec3>& linear);
std::string hdr_bytes(int width, int height, const std::vector<vec3>& linear);

// Written beside the target and renamed; "-" is standard output. write_float_image takes .exr and
// .hdr. Throw Error ("file: ...").
void write_png(const std::filesystem::path& file, const Image& image);
void write_float_image(const std::filesystem::path& file, int width, int height,
                       const std::vector<vec3>& linear);

// The film's radiance, row 0 on top; black where nothing was traced yet.
std::vector<vec3> radiance_of(const Film& film);

}  // namespace tracer
