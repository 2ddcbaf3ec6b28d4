// What a surface does with light.
#pragma once

#include <string>

#include "tracer/math/types.h"

namespace tracer {

// Light that arrives is shared out: `reflectivity` mirrors, `transmission` enters as glass (which
// splits by Fresnel into refraction and reflection), the rest is diffuse. Their sum is kept <= 1.
struct Material {
  std::string name;
  vec3 albedo{0.8f};        // linear; multiplied with the texture
  uint32_t texture = none;  // index into Scene::textures
  bool use_texture = true;
  float reflectivity = 0.0f;      // 0..1
  float transmission = 0.0f;      // 0..1
  float refraction_index = 1.5f;  // 1..3, of the inside
  vec3 specular{1.0f};            // linear; tints mirror and glass
  vec3 emission{0.0f};            // linear radiance

  bool operator==(const Material&) const = default;
};

}  // namespace tracer
