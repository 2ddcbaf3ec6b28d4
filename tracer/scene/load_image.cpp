// Image files through stb_image, which is compiled here with the five formats that have no known
// unguarded faults.
#include "tracer/scene/load_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "tracer/error.h"
#include "tracer/file_io.h"
#include "tracer/scene/hdr_check.h"

#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STBI_FAILURE_USERMSG
#define STBI_MAX_DIMENSIONS 16384
#define STB_IMAGE_STATIC
#ifndef __clang_analyzer__  // not ours to analyse
#define STB_IMAGE_IMPLEMENTATION
#endif
#include <stb_image.h>

namespace tracer {
namespace {

static_assert(STBI_MAX_DIMENSIONS == max_image_side);

constexpr uint64_t max_file_bytes = 1'000'000'000;
constexpr float max_radiance = 1e8f;  // sums and squares of it stay finite

struct Freed {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

[[noreturn]] void throw_unreadable(const std::filesystem::path& file, std::string_view why) {
  throw Error(fmt::format("{}: cannot be read as an image: {}", file.string(), why));
}

bool starts_with(std::string_view bytes, std::string_view magic) {
  return bytes.substr(0, magic.size()) == magic;
}

bool is_hdr(std::string_view bytes) {
  return starts_with(bytes, "#?RADIANCE\n") || starts_with(bytes, "#?RGBE\n");
}

// TGA files have no mark at the front, so their name must tell.
bool is_known(std::string_view bytes, const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending)
    c = c >= 'A' && c <= 'Z' ? char(c + 32) : c;
  return starts_with(bytes, "\x89PNG\r\n\x1a\n") || starts_with(bytes, "\xff\xd8") ||
         starts_with(bytes, "BM") || is_hdr(bytes) || ending == ".tga";
}

void check_size(const std::filesystem::path& file, uint64_t width, uint64_t height) {
  if (width == 0 || height == 0) throw_unreadable(file, "it has no pixels");
  if (width > max_image_side || height > max_image_side || width * height > max_image_pixels) {
    throw_unreadable(file, fmt::format("it has {} x {} pixels; the limits are {} a side and {} in "
                                       "all; make it smaller",
                                       width, height, max_image_side, max_image_pixels));
  }
}

// Everything that can be refused by header is refused here, before memory is taken.
std::string checked_bytes(const std::filesystem::path& file) {
  std::string bytes = read_file(file, max_file_bytes);
  if (bytes.empty()) throw_unreadable(file, "it is empty");
  if (!is_known(bytes, file)) {
    throw_unreadable(file, "it is not a PNG, JPEG, TGA, BMP or Radiance HDR file");
  }
  if (is_hdr(bytes)) {
    const HdrCheck check = check_hdr(bytes);
    if (!check.problem.empty()) throw_unreadable(file, check.problem);
    check_size(file, check.width, check.height);
    return bytes;
  }
  int width = 0;
  int height = 0;
  int channels = 0;
  const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
  if (!stbi_info_from_memory(data, int(bytes.size()), &width, &height, &channels)) {
    throw_unreadable(file, stbi_failure_reason());
  }
  check_size(file, uint64_t(std::max(width, 0)), uint64_t(std::max(height, 0)));
  return bytes;
}

}  // namespace

Texture load_texture(const std::filesystem::path& file) {
  const std::string bytes = checked_bytes(file);
  int width = 0;
  int height = 0;
  int channels = 0;
  const std::unique_ptr<stbi_uc, Freed> pixels(
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), int(bytes.size()),
                            &width, &height, &channels, 4));
  if (!pixels) throw_unreadable(file, stbi_failure_reason());
  Texture texture;
  texture.name = file.filename().string();
  texture.width = uint32_t(width);
  texture.height = uint32_t(height);
  std::vector<uint32_t> texels(size_t(width) * size_t(height));
  std::memcpy(texels.data(), pixels.get(), 4 * texels.size());
  texture.texels = std::move(texels);
  return texture;
}

SkyImage load_sky(const std::filesystem::path& file) {
  const std::string bytes = checked_bytes(file);
  int width = 0;
  int height = 0;
  int channels = 0;
  const std::unique_ptr<float, Freed> pixels(
      stbi_loadf_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), int(bytes.size()),
                             &width, &height, &channels, 3));
  if (!pixels) throw_unreadable(file, stbi_failure_reason());
  SkyImage sky;
  sky.name = file.filename().string();
  sky.width = uint32_t(width);
  sky.height = uint32_t(height);
  std::vector<vec3> texels(size_t(width) * size_t(height));
  for (size_t i = 0; i < texels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float value = pixels.get()[3 * i + size_t(c)];
      texels[i][c] = value > 0.0f ? std::min(value, max_radiance) : 0.0f;  // NaN: 0
    }
  }
  sky.texels = std::move(texels);
  return sky;
}

}  // namespace tracer
