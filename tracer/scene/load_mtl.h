// MTL material libraries.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "tracer/scene/material.h"

namespace tracer {

struct MtlMaterial {
  Material material;    // without its texture
  std::string texture;  // as map_Kd names it; empty: none
  vec2 uv_scale{1.0f};  // uv * uv_scale + uv_offset
  vec2 uv_offset{0.0f};
  bool has_alpha_map = false;  // map_d, which is not supported
};

// By name; of two with one name the first counts. Never throws: what is not understood is left out
// and values are brought into their ranges.
std::map<std::string, MtlMaterial> parse_mtl(std::string_view text);

}  // namespace tracer
