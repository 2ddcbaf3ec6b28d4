// The motions that all instances can be given, and where they are at a time.
#include "tracer/scene/motion.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "tracer/choice.h"

namespace tracer {
namespace {

Motion stand(const Box&, const mat4&, float) {
  return {};
}

Motion spin(const Box& mesh, const mat4&, float speed) {
  Motion motion;
  motion.spin = 2.0f * pi * speed;
  motion.pivot = center(mesh);
  return motion;
}

// A quarter of the instance's height, of its width where it is flat.
Motion bounce(const Box& mesh, const mat4& to_world, float speed) {
  const vec3 size = extent(mesh);
  vec3 world(0.0f);
  for (int axis = 0; axis < 3; ++axis)
    world += glm::abs(vec3(to_world[axis]) * size[axis]);
  Motion motion;
  motion.bounce_height = 0.25f * (world.y > 0.0f ? world.y : std::max(world.x, world.z));
  motion.bounce_rate = pi * speed;
  return motion;
}

constexpr MotionRow rows[] = {
    {"scene", "As in the scene", "Each instance moves as its scene says; those of files stand"},
    {"none", "None", "All instances stand where the scene puts them", false, stand},
    {"spin", "Spin", "Each instance turns about its own upright axis", true, spin},
    {"bounce", "Bounce", "Each instance hops by a quarter of its height", true, bounce},
};

}  // namespace

std::span<const MotionRow> motions() {
  return rows;
}

Motion chosen(const InstanceMotion& choice, const Motion& own, const Box& mesh,
              const mat4& to_world) {
  const MotionRow* row = find_row(motions(), choice.kind);
  if (row == nullptr || row->motion == nullptr) return own;
  return row->motion(mesh, to_world, choice.speed);
}

mat4 pose(const mat4& to_world, const Motion& motion, float time) {
  mat4 matrix = to_world;
  if (motion.bounce_height != 0.0f) {
    const float lift =
        motion.bounce_height * std::abs(std::sin(motion.bounce_rate * time + motion.phase));
    matrix[3].y += lift;
  }
  if (motion.spin != 0.0f) {
    matrix = glm::translate(matrix, motion.pivot);
    matrix = glm::rotate(matrix, std::fmod(motion.spin * time, 2.0f * pi), vec3(0, 1, 0));
    matrix = glm::translate(matrix, -motion.pivot);
  }
  return matrix;
}

}  // namespace tracer
