// Rays from a file.
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "tracer/analyze/ray_sets.h"
#include "tracer/bvh/traverse.h"
#include "tracer/error.h"
#include "tracer/file_io.h"

namespace tracer {
namespace {

constexpr size_t ray_bytes = 8 * sizeof(float);
static_assert(std::endian::native == std::endian::little, "ray files are little-endian");

Ray ray_at(const char* bytes) {
  float v[8];
  std::memcpy(v, bytes, ray_bytes);
  // A comparison that NaN does not hold keeps it, and is_valid finds it.
  return {{v[0], v[1], v[2]}, v[3] < 0.0f ? 0.0f : v[3], {v[4], v[5], v[6]}, v[7]};
}

}  // namespace

RayFile read_rays(const std::filesystem::path& file) {
  const std::string bytes = read_file(file, max_file_rays * ray_bytes);
  if (bytes.empty() || bytes.size() % ray_bytes != 0) {
    throw Error(fmt::format(
        "{}: {} bytes are no rays; a ray is 32 bytes, eight little-endian floats: origin, t_min, "
        "direction, t_max",
        file.string(), bytes.size()));
  }
  RayFile result;
  result.rays.reserve(bytes.size() / ray_bytes);
  for (size_t at = 0; at < bytes.size(); at += ray_bytes) {
    const Ray ray = ray_at(bytes.data() + at);
    if (is_valid(ray)) {
      result.rays.push_back(ray);
    } else {
      ++result.left_out;
    }
  }
  if (result.rays.empty()) {
    throw Error(fmt::format(
        "{}: none of its {} rays can hit anything; numbers must be finite, the direction not zero, "
        "t_min not above t_max",
        file.string(), result.left_out));
  }
  return result;
}

}  // namespace tracer
