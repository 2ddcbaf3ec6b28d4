// A clear sky with sun over a calm sea.
// A. Preetham, P. Shirley, B. Smits, A Practical Analytic Model for Daylight, 1999: the sky's
// luminance and chromaticity. Ours: the units (not candela but about 0.3 on average), a larger and
// much darker sun, so that a mirror shows it without fireflies, and the sea.
#include <algorithm>
#include <cmath>

#include "assets/generate/generate.h"

namespace assets {
namespace {

using tracer::pi;
using tracer::vec3;

constexpr float turbidity = 2.3f;
constexpr float radians = pi / 180.0f;
constexpr float sun_elevation = 42.0f * radians;
constexpr float sun_azimuth = 34.0f * radians;  // from +x to +z, where the default light is
constexpr float units_per_kilocandela = 0.048f;

// Perez: the distribution of luminance (and of x, y) over the sky.
struct Perez {
  float a, b, c, d, e;
};
float perez(const Perez& p, float cos_theta, float gamma) {
  const float cos_gamma = std::cos(gamma);
  return (1.0f + p.a * std::exp(p.b / cos_theta)) *
         (1.0f + p.c * std::exp(p.d * gamma) + p.e * cos_gamma * cos_gamma);
}

// Appendix A.2 of the paper: linear in the turbidity.
constexpr float T = turbidity;
constexpr Perez luminance = {0.1787f * T - 1.4630f, -0.3554f * T + 0.4275f, -0.0227f * T + 5.3251f,
                             0.1206f * T - 2.5771f, -0.0670f * T + 0.3703f};
constexpr Perez chroma_x = {-0.0193f * T - 0.2592f, -0.0665f * T + 0.0008f, -0.0004f * T + 0.2125f,
                            -0.0641f * T - 0.8989f, -0.0033f * T + 0.0452f};
constexpr Perez chroma_y = {-0.0167f * T - 0.2608f, -0.0950f * T + 0.0092f, -0.0079f * T + 0.2102f,
                            -0.0441f * T - 1.6537f, -0.0109f * T + 0.0529f};

// At the zenith, for the sun's angle s from it: Y in kilocandela per square metre, x and y.
vec3 zenith(float s) {
  const float chi = (4.0f / 9.0f - T / 120.0f) * (pi - 2.0f * s);
  const float y_luminance = (4.0453f * T - 4.9710f) * std::tan(chi) - 0.2155f * T + 2.4192f;
  const auto cubic = [&](const float(&k)[3][4]) {
    const auto row = [&](int i) { return ((k[i][0] * s + k[i][1]) * s + k[i][2]) * s + k[i][3]; };
    return T * T * row(0) + T * row(1) + row(2);
  };
  const float x = cubic({{0.00166f, -0.00375f, 0.00209f, 0.0f},
                         {-0.02903f, 0.06377f, -0.03202f, 0.00394f},
                         {0.11693f, -0.21196f, 0.06052f, 0.25886f}});
  const float y = cubic({{0.00275f, -0.00610f, 0.00317f, 0.0f},
                         {-0.04214f, 0.08970f, -0.04153f, 0.00516f},
                         {0.15346f, -0.26756f, 0.06670f, 0.26688f}});
  return {y_luminance, x, y};
}

// CIE Yxy -> linear sRGB; negative components (outside the gamut) become 0.
vec3 rgb_from_Yxy(vec3 color) {
  const float Y = color.x, X = color.y / color.z * Y, Z = (1.0f - color.y - color.z) / color.z * Y;
  return glm::max(vec3(0.0f), vec3(3.2406f * X - 1.5372f * Y - 0.4986f * Z,
                                   -0.9689f * X + 1.8758f * Y + 0.0415f * Z,
                                   0.0557f * X - 0.2040f * Y + 1.0570f * Z));
}

const vec3 to_sun(std::cos(sun_elevation) * std::cos(sun_azimuth), std::sin(sun_elevation),
                  std::cos(sun_elevation) * std::sin(sun_azimuth));

vec3 daylight(vec3 direction) {
  const float sun_zenith = pi / 2 - sun_elevation;
  const float cos_theta = std::max(direction.y, 0.015f);
  const float gamma = std::acos(glm::clamp(glm::dot(direction, to_sun), -1.0f, 1.0f));
  const vec3 top = zenith(sun_zenith);
  const auto relative = [&](const Perez& p) {
    return perez(p, cos_theta, gamma) / perez(p, 1.0f, sun_zenith);
  };
  const vec3 color(top.x * relative(luminance), top.y * relative(chroma_x),
                   top.z * relative(chroma_y));
  return units_per_kilocandela * rgb_from_Yxy(color);
}

vec3 sun(vec3 direction) {
  const float gamma = std::acos(glm::clamp(glm::dot(direction, to_sun), -1.0f, 1.0f)) / radians;
  const float disc = 1.0f - glm::smoothstep(0.9f, 1.7f, gamma);  // degrees; the real one: 0.27
  const float glow = std::exp(-gamma / 2.5f);
  return vec3(30.0f, 26.0f, 20.0f) * disc + vec3(1.6f, 1.4f, 1.0f) * glow;
}

// A calm sea: its own colour and, by Schlick's approximation, the mirrored sky without the sun.
// Waves tilt the surface, so it never becomes a full mirror, not even at the horizon.
vec3 sea(vec3 direction) {
  const float down = -direction.y;
  const float grazing = 0.92f * (1.0f - down);
  const float fresnel = 0.02f + 0.98f * std::pow(grazing, 5.0f);
  const vec3 water(0.022f, 0.068f, 0.095f);
  return glm::mix(water, daylight({direction.x, down, direction.z}), fresnel);
}

}  // namespace

std::vector<vec3> make_sky() {
  std::vector<vec3> texels;
  for (int row = 0; row < sky_height; row++) {
    const float theta = pi * (static_cast<float>(row) + 0.5f) / static_cast<float>(sky_height);
    for (int column = 0; column < sky_width; column++) {
      const float u = (static_cast<float>(column) + 0.5f) / static_cast<float>(sky_width);
      const float phi = 2.0f * pi * (u - 0.5f);
      const vec3 direction(std::sin(theta) * std::cos(phi), std::cos(theta),
                           std::sin(theta) * std::sin(phi));
      texels.push_back(direction.y > 0 ? daylight(direction) + sun(direction) : sea(direction));
    }
  }
  return texels;
}

}  // namespace assets
