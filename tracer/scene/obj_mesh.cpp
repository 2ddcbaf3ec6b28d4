// From an OBJ file's faces to a mesh: bad faces left out and counted, polygons triangulated, equal
// corners merged.
#include <algorithm>
#include <cmath>

#include "tracer/scene/obj_file.h"
#include "tracer/scene/triangulate.h"

namespace tracer {
namespace {

constexpr float largest_coordinate = 1.844e18f;  // squares and sums of it stay finite

bool is_usable(const vec3& p) {
  // Written so that NaN fails.
  return std::abs(p.x) <= largest_coordinate && std::abs(p.y) <= largest_coordinate &&
         std::abs(p.z) <= largest_coordinate;
}

bool is_degenerate(const vec3& a, const vec3& b, const vec3& c) {
  const glm::dvec3 origin(a);
  const glm::dvec3 normal = glm::cross(glm::dvec3(b) - origin, glm::dvec3(c) - origin);
  return normal == glm::dvec3(0.0);
}

// Unit length; zero for one that has none.
vec3 unit_or_zero(const vec3& v) {
  const glm::dvec3 wide(v);
  const double length = glm::length(wide);
  if (!(length > 0.0) || !std::isfinite(length)) return vec3(0.0f);
  return vec3(wide / length);
}

// Mesh entries that came of one position are a chain, to find equal corners without hashing.
class Merger {
 public:
  Merger(const ObjFile& file, std::span<const UvTransform> transforms, Mesh& mesh)
      : file_(file), transforms_(transforms), mesh_(mesh), heads_(file.positions.size(), none) {
    kinds_.resize(transforms.size());
    for (uint32_t i = 0; i < transforms.size(); ++i) {
      kinds_[i] = uint32_t(std::find(transforms.begin(), transforms.end(), transforms[i]) -
                           transforms.begin());
    }
  }

  uint32_t entry(const ObjCorner& corner, uint32_t material) {
    const int32_t uv = std::max(corner.uv, -1);
    const int32_t normal = std::max(corner.normal, -1);
    const uint32_t kind = uv < 0 ? 0 : kinds_[material];
    uint32_t& head = heads_[size_t(corner.position)];
    for (uint32_t at = head; at != none; at = links_[at].next) {
      const Link& link = links_[at];
      if (link.uv == uv && link.normal == normal && link.kind == kind) return at;
    }
    const uint32_t result = uint32_t(links_.size());
    links_.push_back({uv, normal, kind, head});
    head = result;
    append(corner.position, uv, normal, transforms_[kind]);
    return result;
  }

 private:
  struct Link {
    int32_t uv;
    int32_t normal;
    uint32_t kind;  // of uv transform
    uint32_t next;
  };

  void append(int32_t position, int32_t uv, int32_t normal, const UvTransform& transform) {
    mesh_.positions.push_back(file_.positions[size_t(position)]);
    mesh_.normals.push_back(normal < 0 ? vec3(0.0f) : unit_or_zero(file_.normals[size_t(normal)]));
    if (uv >= 0 && mesh_.uvs.empty()) mesh_.uvs.resize(mesh_.positions.size() - 1);
    if (uv < 0) {
      if (!mesh_.uvs.empty()) mesh_.uvs.emplace_back(0.0f);
      return;
    }
    const vec2 value = file_.uvs[size_t(uv)] * transform.scale + transform.offset;
    const bool finite = std::isfinite(value.x) && std::isfinite(value.y);
    mesh_.uvs.push_back(finite ? value : vec2(0.0f));
  }

  const ObjFile& file_;
  std::span<const UvTransform> transforms_;
  Mesh& mesh_;
  std::vector<uint32_t> heads_;  // by position
  std::vector<Link> links_;      // by entry
  std::vector<uint32_t> kinds_;  // by material: the first one with an equal transform
};

enum class FaceState { good, bad_index, non_finite };

FaceState state_of(const ObjFile& file, std::span<const ObjCorner> corners, bool& bad_attribute) {
  FaceState state = FaceState::good;
  for (const ObjCorner& corner : corners) {
    if (corner.position < 0) return FaceState::bad_index;
    if (!is_usable(file.positions[size_t(corner.position)])) state = FaceState::non_finite;
    bad_attribute |= corner.uv == bad_obj_index || corner.normal == bad_obj_index;
  }
  return state;
}

}  // namespace

Mesh make_mesh(const ObjFile& file, std::span<const uint32_t> materials,
               std::span<const UvTransform> transforms, TriangleCounts& counts, ObjFaults& faults) {
  Mesh mesh;
  const size_t most_triangles = file.corners.size() - 2 * file.faces.size();
  mesh.triangles.reserve(most_triangles);
  mesh.materials.reserve(most_triangles);
  Merger merger(file, transforms, mesh);
  std::vector<vec3> polygon;
  std::vector<uvec3> parts;
  for (const ObjFace& face : file.faces) {
    const std::span corners = std::span(file.corners).subspan(face.first, face.count);
    bool bad_attribute = false;
    const FaceState state = state_of(file, corners, bad_attribute);
    if (state != FaceState::good) {
      add(state == FaceState::bad_index ? faults.bad_index : faults.non_finite, face.line,
          face.count - 2);
      continue;
    }
    if (bad_attribute) add(faults.bad_attribute, face.line);
    polygon.clear();
    for (const ObjCorner& corner : corners) {
      polygon.push_back(file.positions[size_t(corner.position)]);
    }
    parts.clear();
    triangulate(polygon, parts);
    for (const uvec3& part : parts) {
      if (is_degenerate(polygon[part.x], polygon[part.y], polygon[part.z])) {
        add(faults.degenerate, face.line);
        continue;
      }
      uvec3 triangle;
      for (int k = 0; k < 3; ++k)
        triangle[k] = merger.entry(corners[part[k]], face.material);
      mesh.triangles.push_back(triangle);
      mesh.materials.push_back(materials[face.material]);
    }
  }
  counts.used = mesh.triangles.size();
  counts.degenerate = faults.degenerate.count;
  counts.non_finite = faults.non_finite.count;
  counts.bad_index = faults.bad_index.count + file.report.bad_faces.count;
  counts.read = counts.used + counts.degenerate + counts.non_finite + counts.bad_index;
  return mesh;
}

}  // namespace tracer
