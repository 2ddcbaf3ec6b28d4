// MTL material libraries.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "tracer/scene/material.h"
#include "tracer/scene/obj_number.h"

namespace tracer {

struct MtlMaterial {
  Material material;    // without its texture
  std::string texture;  // as map_Kd names it; empty: none
  vec2 uv_scale{1.0f};  // uv * uv_scale + uv_offset
  vec2 uv_offset{0.0f};
  bool has_alpha_map = false;  // map_d, which is not supported
};

struct MtlFile {
  std::map<std::string, MtlMaterial> materials;  // by name; of two with one name the first counts
  LineList bad_numbers;                          // left out, or numbers missing
  LineList out_of_range;                         // brought into their ranges
  LineList repeated;                             // names that were there before, otherwise
};

// Never throws: what is not understood is left out.
MtlFile parse_mtl(std::string_view text);

}  // namespace tracer
