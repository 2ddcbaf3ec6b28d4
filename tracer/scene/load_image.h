// PNG, JPEG, TGA, BMP and Radiance HDR files, through stb_image, with limits.
#pragma once

#include <filesystem>

#include "tracer/scene/sky.h"
#include "tracer/scene/texture.h"

namespace tracer {

inline constexpr uint32_t max_image_side = 16384;
inline constexpr uint64_t max_image_pixels = 100'000'000;

// Throw Error ("file: ...") for what cannot be read, is too large or is not a regular file.
Texture load_texture(const std::filesystem::path& file);
SkyImage load_sky(const std::filesystem::path& file);

}  // namespace tracer
