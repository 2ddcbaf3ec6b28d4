// An OBJ file as it is written, and the mesh that becomes of it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/scene/obj_text.h"
#include "tracer/scene/scene.h"

namespace tracer {

// Indices from 0. -1: not given; bad_obj_index: given, but out of range.
inline constexpr int32_t bad_obj_index = -2;
struct ObjCorner {
  int32_t position = bad_obj_index;
  int32_t uv = -1;
  int32_t normal = -1;
};
struct ObjFace {
  uint32_t first = 0;  // corner
  uint32_t count = 0;  // corners, 3 or more
  uint32_t material = 0;
  uint32_t line = 0;
};
struct ObjFile {
  std::vector<vec3> positions;  // as they are, infinite ones too
  std::vector<vec3> normals;
  std::vector<vec2> uvs;
  std::vector<ObjCorner> corners;
  std::vector<ObjFace> faces;
  std::vector<std::string> materials;  // names after usemtl; the first is "": none chosen yet
  ObjTextReport report;
};

// All indices of the result are in range or marked bad. Throws Error if there are more corners than
// fit or the job was stopped.
ObjFile parse_obj(std::string_view text, const Job& job);

struct UvTransform {
  vec2 scale{1.0f};
  vec2 offset{0.0f};
  bool operator==(const UvTransform&) const = default;
};
struct ObjFaults {
  LineList bad_index;      // faces left out, in triangles
  LineList degenerate;     // likewise
  LineList non_finite;     // likewise
  LineList bad_attribute;  // faces that were kept without a uv or normal whose index was wrong
};

// materials and transforms are indexed as file.materials. Entries without a normal have zero.
Mesh make_mesh(const ObjFile& file, std::span<const uint32_t> materials,
               std::span<const UvTransform> transforms, TriangleCounts& counts, ObjFaults& faults);

}  // namespace tracer
