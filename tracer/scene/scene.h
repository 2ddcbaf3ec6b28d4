// A scene as it was loaded. It stays const; edits live in Settings.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/progress.h"
#include "tracer/scene/camera.h"
#include "tracer/scene/light.h"
#include "tracer/scene/material.h"
#include "tracer/scene/mesh.h"
#include "tracer/scene/motion.h"
#include "tracer/scene/sky.h"
#include "tracer/scene/texture.h"

namespace tracer {

struct Instance {
  std::string name;
  uint32_t mesh = 0;
  mat4 transform{1.0f};      // object to world, affine, invertible
  uint32_t material = none;  // replaces the mesh's own materials
  Motion motion;
};

// Object to world at a time in seconds, by the instance's own motion.
mat4 pose(const Instance& instance, float time);

// What a loader read and what it did not use: read = used + degenerate + non_finite + bad_index.
struct TriangleCounts {
  uint64_t read = 0;
  uint64_t used = 0;
  uint64_t degenerate = 0;
  uint64_t non_finite = 0;
  uint64_t bad_index = 0;
};

struct Scene {
  std::string name;
  std::vector<Mesh> meshes;         // each has at least one triangle
  std::vector<Instance> instances;  // at least one
  std::vector<Material> materials;  // at least one; mesh and instance indices are in range
  std::vector<Texture> textures;
  std::vector<Light> lights;
  SkyImage sky_image;
  SkySettings sky;
  vec3 ambient{0.1f};  // linear radiance that reaches every diffuse surface
  Camera camera;
  TriangleCounts counts;
  std::vector<std::string> warnings;  // what the user should know about the load, one a line
};

// Of all instances at time 0, in the world.
Box bounds(const Scene& scene);

// Which scene. `name` is a file (.obj, ...) or the id of a built-in scene; parameters are the
// built-in scene's own ("triangles" = 1e6). sky_file replaces the scene's sky (.hdr).
struct SceneParameter {
  std::string id;
  double value = 0.0;
  bool operator==(const SceneParameter&) const = default;
};
struct SceneSource {
  std::string name = "teapots";
  std::vector<SceneParameter> parameters;
  std::string sky_file;
  uint32_t revision = 0;  // raised to load the same source again

  bool operator==(const SceneSource&) const = default;
};

// "terrain:triangles=1000000,seed=2" or a path. Throws Error for a malformed parameter list.
SceneSource parse_scene_source(std::string_view text);
// "triangles=1000000". Throws Error.
SceneParameter parse_scene_parameter(std::string_view word);
bool is_builtin(std::string_view name);
std::string to_string(const SceneSource& source);

// Loads a file or generates a built-in scene; always gives a scene that keeps the promises above.
// Throws Error if nothing can be shown; lesser faults become warnings. A stopped job throws Error
// ("... stopped").
Scene load_scene(const SceneSource& source, const Job& job);

// The default camera of a scene that brings none: looks along (-1, -0.6, -1.5) at its middle.
Camera default_camera(const Box& bounds);

}  // namespace tracer
