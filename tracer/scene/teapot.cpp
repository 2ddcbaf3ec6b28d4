// The Utah teapot as 32 bicubic Bezier patches.
// M. Newell, The Utilization of Procedure Models in Digital Image Synthesis, 1975; the bottom was
// added by F. Crow, The Origins of the Teapot, 1987. Ten patches are stored, the others are their
// mirror images. The normals are those of the patches, not of the triangles.
#include "tracer/scene/teapot.h"

namespace tracer {
namespace {

using Row = std::array<vec3, 4>;
using Points = std::array<Row, 4>;

// A ring of the body: a quarter of it has the control points (radius, 0), (radius, -arm),
// (arm, -radius), (0, -radius) at this height.
struct Ring {
  float radius, arm, height;
};
struct Quarter {
  Ring rings[4];          // from above
  float v_first, v_last;  // of the texture
};

constexpr Quarter quarters[6] = {
    // rim
    {{{1.4f, 0.784f, 2.4f},
      {1.3375f, 0.749f, 2.53125f},
      {1.4375f, 0.805f, 2.53125f},
      {1.5f, 0.84f, 2.4f}},
     1.375f,
     1.3125f},
    // body
    {{{1.5f, 0.84f, 2.4f}, {1.75f, 0.98f, 1.875f}, {2.0f, 1.12f, 1.35f}, {2.0f, 1.12f, 0.9f}},
     1.3125f,
     0.8125f},
    {{{2.0f, 1.12f, 0.9f}, {2.0f, 1.12f, 0.45f}, {1.5f, 0.84f, 0.225f}, {1.5f, 0.84f, 0.15f}},
     0.8125f,
     0.5f},
    // lid; its knob has the published 0.45 where the other rings have 0.56 of the radius
    {{{0.0f, 0.0f, 3.15f}, {0.8f, 0.45f, 3.15f}, {0.0f, 0.0f, 2.85f}, {0.2f, 0.112f, 2.7f}},
     2.0f,
     1.75f},
    {{{0.2f, 0.112f, 2.7f}, {0.4f, 0.224f, 2.55f}, {1.3f, 0.728f, 2.55f}, {1.3f, 0.728f, 2.4f}},
     1.75f,
     1.375f},
    // bottom
    {{{1.5f, 0.84f, 0.15f}, {1.5f, 0.84f, 0.075f}, {1.425f, 0.798f, 0.0f}, {0.0f, 0.0f, 0.0f}},
     0.5f,
     0.0f},
};

// Handle and spout: the half with y <= 0; i goes along, j around.
struct Half {
  Points points;
  float u_width;          // of the texture, half around
  float v_first, v_last;  // of the texture
};

constexpr Half halves[4] = {
    // handle
    {{{{{{-1.6f, 0, 2.025f}, {-1.6f, -0.3f, 2.025f}, {-1.5f, -0.3f, 2.25f}, {-1.5f, 0, 2.25f}}},
       {{{-2.3f, 0, 2.025f}, {-2.3f, -0.3f, 2.025f}, {-2.5f, -0.3f, 2.25f}, {-2.5f, 0, 2.25f}}},
       {{{-2.7f, 0, 2.025f}, {-2.7f, -0.3f, 2.025f}, {-3.0f, -0.3f, 2.25f}, {-3.0f, 0, 2.25f}}},
       {{{-2.7f, 0, 1.8f}, {-2.7f, -0.3f, 1.8f}, {-3.0f, -0.3f, 1.8f}, {-3.0f, 0, 1.8f}}}}},
     0.25f,
     1.0f,
     0.5f},
    {{{{{{-2.7f, 0, 1.8f}, {-2.7f, -0.3f, 1.8f}, {-3.0f, -0.3f, 1.8f}, {-3.0f, 0, 1.8f}}},
       {{{-2.7f, 0, 1.575f}, {-2.7f, -0.3f, 1.575f}, {-3.0f, -0.3f, 1.35f}, {-3.0f, 0, 1.35f}}},
       {{{-2.5f, 0, 1.125f},
         {-2.5f, -0.3f, 1.125f},
         {-2.65f, -0.3f, 0.9375f},
         {-2.65f, 0, 0.9375f}}},
       {{{-2.0f, 0, 0.9f}, {-2.0f, -0.3f, 0.9f}, {-1.9f, -0.3f, 0.6f}, {-1.9f, 0, 0.6f}}}}},
     0.25f,
     0.5f,
     0.0f},
    // spout
    {{{{{{1.7f, 0, 1.425f}, {1.7f, -0.66f, 1.425f}, {1.7f, -0.66f, 0.6f}, {1.7f, 0, 0.6f}}},
       {{{2.6f, 0, 1.425f}, {2.6f, -0.66f, 1.425f}, {3.1f, -0.66f, 0.825f}, {3.1f, 0, 0.825f}}},
       {{{2.3f, 0, 2.1f}, {2.3f, -0.25f, 2.1f}, {2.4f, -0.25f, 2.025f}, {2.4f, 0, 2.025f}}},
       {{{2.7f, 0, 2.4f}, {2.7f, -0.25f, 2.4f}, {3.3f, -0.25f, 2.4f}, {3.3f, 0, 2.4f}}}}},
     0.5f,
     0.0f,
     0.5f},
    {{{{{{2.7f, 0, 2.4f}, {2.7f, -0.25f, 2.4f}, {3.3f, -0.25f, 2.4f}, {3.3f, 0, 2.4f}}},
       {{{2.8f, 0, 2.475f},
         {2.8f, -0.25f, 2.475f},
         {3.525f, -0.25f, 2.49375f},
         {3.525f, 0, 2.49375f}}},
       {{{2.9f, 0, 2.475f}, {2.9f, -0.15f, 2.475f}, {3.45f, -0.15f, 2.5125f}, {3.45f, 0, 2.5125f}}},
       {{{2.8f, 0, 2.4f}, {2.8f, -0.15f, 2.4f}, {3.2f, -0.15f, 2.4f}, {3.2f, 0, 2.4f}}}}},
     0.5f,
     0.5f,
     0.625f},
};

Points points_of(const Quarter& quarter) {
  Points points;
  for (int i = 0; i < 4; i++) {
    const auto [radius, arm, height] = quarter.rings[i];
    points[i] = {vec3(radius, 0, height), vec3(radius, -arm, height), vec3(arm, -radius, height),
                 vec3(0, -radius, height)};
  }
  return points;
}

// The mirror image; j runs backwards then, so that d/dt x d/ds still points to the outside.
TeapotPatch mirrored(const TeapotPatch& patch, vec3 sign, float u_first, float u_last) {
  TeapotPatch image{patch.points, u_last, u_first, patch.v_first, patch.v_last};
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++)
      image.points[i][j] = sign * patch.points[i][3 - j];
  }
  return image;
}

// Exactly a at t = 0 and b at t = 1, and exactly a everywhere if both are equal.
vec3 between(vec3 a, vec3 b, float t) {
  return t < 0.5f ? a + t * (b - a) : b - (1.0f - t) * (b - a);
}

// De Casteljau's construction: the point and the derivative. At the ends of t the point is the
// first or last control point to the bit, so an edge of a patch depends on its own points alone
// and neighbours agree.
struct CurvePoint {
  vec3 value, slope;
};
CurvePoint on_curve(const Row& row, float t) {
  const vec3 a = between(row[0], row[1], t);
  const vec3 b = between(row[1], row[2], t);
  const vec3 c = between(row[2], row[3], t);
  const vec3 ab = between(a, b, t), bc = between(b, c, t);
  return {between(ab, bc, t), 3.0f * (bc - ab)};
}

struct PatchPoint {
  vec3 value, along_s, along_t, mixed;  // mixed: the derivative of along_t along s
};
PatchPoint on_patch(const Points& points, float s, float t) {
  Row values, slopes;
  for (int j = 0; j < 4; j++) {
    const Row column = {points[0][j], points[1][j], points[2][j], points[3][j]};
    const CurvePoint point = on_curve(column, s);
    values[j] = point.value;
    slopes[j] = point.slope;
  }
  const CurvePoint point = on_curve(values, t);
  const CurvePoint slope = on_curve(slopes, t);
  return {point.value, slope.value, point.slope, slope.slope};
}

vec3 y_up(vec3 published) {
  return {published.x, published.z, -published.y};
}

vec3 normal_of(const PatchPoint& point, float s) {
  const vec3 normal = glm::cross(point.along_t, point.along_s);
  if (glm::dot(normal, normal) > 1e-10f) return glm::normalize(normal);
  // A pole: the ring has shrunk to a point and d/dt is zero, but d/dt per s has a limit. The ring
  // grows away from the pole at s = 0 and shrinks towards it at s = 1.
  return glm::normalize(glm::cross(s < 0.5f ? point.mixed : -point.mixed, point.along_s));
}

void append(Mesh& mesh, const TeapotPatch& patch, uint32_t detail) {
  constexpr float scale = 1.0f / 3.15f;
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (uint32_t i = 0; i <= detail; i++) {
    const float s = static_cast<float>(i) / static_cast<float>(detail);
    for (uint32_t j = 0; j <= detail; j++) {
      const float t = static_cast<float>(j) / static_cast<float>(detail);
      const PatchPoint point = on_patch(patch.points, s, t);
      mesh.positions.push_back(scale * y_up(point.value) + 0.0f);  // + 0 turns -0 into 0
      mesh.normals.push_back(y_up(normal_of(point, s)));
      mesh.uvs.emplace_back(glm::mix(patch.u_first, patch.u_last, t),
                            glm::mix(patch.v_first, patch.v_last, s));
    }
  }
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    const auto& p = mesh.positions;
    if (p[a] == p[b] || p[b] == p[c] || p[c] == p[a]) return;
    mesh.triangles.emplace_back(a, b, c);
  };
  for (uint32_t i = 0; i < detail; i++) {
    for (uint32_t j = 0; j < detail; j++) {
      const uint32_t here = first + i * (detail + 1) + j;
      const uint32_t below = here + detail + 1;
      add(here, here + 1, below);
      add(here + 1, below + 1, below);
    }
  }
}

}  // namespace

std::array<TeapotPatch, teapot_patch_count> teapot_patches() {
  std::array<TeapotPatch, teapot_patch_count> patches;
  size_t count = 0;
  // u counts quarters, against the clock seen from above: the stored quarter goes from 4 to 3.
  for (const Quarter& quarter : quarters) {
    const TeapotPatch stored{points_of(quarter), 4, 3, quarter.v_first, quarter.v_last};
    TeapotPatch opposite = stored;
    for (Row& row : opposite.points) {
      for (vec3& point : row)
        point *= vec3(-1, -1, 1);
    }
    opposite.u_first = 2;
    opposite.u_last = 1;
    patches[count++] = stored;
    patches[count++] = mirrored(stored, {-1, 1, 1}, 2, 3);
    patches[count++] = opposite;
    patches[count++] = mirrored(stored, {1, -1, 1}, 0, 1);
  }
  for (const Half& half : halves) {
    const TeapotPatch stored{half.points, 0, half.u_width, half.v_first, half.v_last};
    patches[count++] = stored;
    patches[count++] = mirrored(stored, {1, -1, 1}, 2 * half.u_width, half.u_width);
  }
  return patches;
}

Mesh make_teapot(uint32_t detail) {
  Mesh mesh;
  mesh.name = "teapot";
  const size_t corners = static_cast<size_t>(teapot_patch_count) * (detail + 1) * (detail + 1);
  mesh.positions.reserve(corners);
  mesh.normals.reserve(corners);
  mesh.uvs.reserve(corners);
  mesh.triangles.reserve(static_cast<size_t>(teapot_patch_count) * 2 * detail * detail);
  for (const TeapotPatch& patch : teapot_patches())
    append(mesh, patch, detail);
  mesh.materials.assign(mesh.triangles.size(), 0);
  return mesh;
}

}  // namespace tracer
