// Deformers: a mesh bent by a function of place and time.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "tracer/scene/scene.h"

namespace tracer {

// Lengths are shares of the rest mesh's own box, so one deformer serves every mesh of a scene.
struct Deformer {
  std::string kind = "none";  // id of a DeformerRow
  float amount = 0.25f;       // -4..4; of what, the row says
  std::string axis = "y";     // id of an AxisRow
  float speed = 0.25f;        // swings a second, 0..10; less than least_speed: held at the amount

  bool operator==(const Deformer&) const = default;
};
inline constexpr float max_amount = 4.0f;
inline constexpr float max_speed = 10.0f;
inline constexpr float least_speed = 0.01f;

struct AxisRow {
  std::string_view id, label, help;
};
std::span<const AxisRow> axes();

struct Deformation;  // of one mesh at one time

struct DeformerRow {
  std::string_view id, label, help;
  std::string_view amount;  // what the amount is, with its unit
  Mesh (*deform)(const Mesh& rest, const Deformation& how) = nullptr;  // nullptr: nothing
  double (*strength)(double amount, double swings, bool held) = nullptr;
};
std::span<const DeformerRow> deformers();

// Whether there is a time at which it changes a mesh.
bool is_active(const Deformer& deformer);
// Active and not held: its pose depends on the time.
bool is_moving(const Deformer& deformer);
// The amount at a time, in the row's unit: what swings between amounts goes through 0 at time 0.
double strength_at(const Deformer& deformer, float time);

// The mesh at a time, in seconds, with the normals that the deformed surface has. Triangles keep
// their numbers and materials. Finite for any mesh. A pure function, the same for any number of
// threads; where the strength is 0 the mesh is the rest mesh to the bit. Entries with equal
// positions stay together, except that `explode` gives every triangle corners of its own.
Mesh deformed(const Mesh& rest, const Deformer& deformer, float time);

// All meshes of a scene; the scene itself where nothing is deformed. Pictures are shared.
std::shared_ptr<const Scene> deformed(const std::shared_ptr<const Scene>& rest,
                                      const Deformer& deformer, float time);

}  // namespace tracer
