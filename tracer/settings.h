// Everything the user can change. Where a field lives is its invalidation rule: an edit of Settings
// makes a stage stale (pipeline.h), an edit of ViewOptions costs a re-colouring.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/bvh/build.h"
#include "tracer/bvh/update.h"
#include "tracer/scene/deform.h"
#include "tracer/scene/scene.h"

namespace tracer {

// A ray kernel that the renderer picks by what the rays are like and what they took so far.
inline constexpr std::string_view automatic_kernel = "automatic";

struct RenderOptions {
  int width = 1280;  // pixels, 1..16384
  int height = 720;
  int ray_depth = 8;  // bounces after the primary ray, 0..32
  int samples = 16;   // a pixel; the first goes through the centre, 1..65536
  bool shadows = true;
  // By RayClass: id of a KernelRow, or automatic_kernel. The picture is the same.
  std::array<std::string, ray_class_count> kernels = {"automatic", "automatic", "automatic",
                                                      "automatic"};
  bool fast = false;  // Tests::fast where nothing is counted, else the watertight ones

  bool operator==(const RenderOptions&) const = default;
};
inline constexpr int max_image_size = 16384;
inline constexpr int max_ray_depth = 32;
inline constexpr int max_samples = 65536;
inline constexpr float max_time = 1e6f;  // seconds; the least is 0

// The parts of a scene that can be edited without touching its geometry.
struct Look {
  std::vector<Material> materials;
  std::vector<Light> lights;
  SkySettings sky;
  vec3 ambient{0.1f};
  Camera camera;

  bool operator==(const Look&) const = default;
};

struct Settings {
  SceneSource source;
  BuildOptions build;
  float time = 0.0f;  // seconds; poses meshes and instances
  Deformer deformer;
  InstanceMotion motion;
  UpdateOptions update;
  std::optional<Look> look;  // nothing: the scene's own, filled in by the pipeline
  RenderOptions render;

  bool operator==(const Settings&) const = default;
};

// Numbers outside their range become its nearer end, unknown strategies the default.
Settings clamped(Settings settings);

Look look_of(const Scene& scene);

// The look as edited (nothing: the scene's own), with an entry for each of the scene's materials.
Look fitted(const std::optional<Look>& look, const Scene& scene);

struct ValueRange {
  float lo = 0.0f;
  float hi = 1.0f;
  bool operator==(const ValueRange&) const = default;
};

// The boxes of the trees that are drawn over the picture (render/overlay.h).
struct BoxOptions {
  bool show = false;
  std::string what = "levels";  // id of a BoxSetRow
  std::string tree = "scene";   // id of a BoxTreeRow
  int first_level = 0;          // edges from the root, 0..max_box_level
  int last_level = 3;
  std::string color = "depth";    // id of a NodeMeasureRow
  std::string ray_class = "all";  // whose visits: id of a RayClassRow, or "all"
  bool logarithmic = false;       // the colours of a measure that is not diverging
  bool wire = true;
  bool translucent = false;
  bool fade_hidden = true;      // what is behind a surface
  bool sibling_overlap = true;  // of the selected node: what its children share, solid
  float line_width = 1.5f;      // pixels, 1..max_box_line_width

  bool operator==(const BoxOptions&) const = default;
};
inline constexpr int max_box_level = 255;
inline constexpr float max_box_line_width = 4.0f;

struct ViewOptions {
  std::string view = "shaded";       // id of a ViewRow; "counter" shows the heat map of `counter`
  std::string counter = "nodes";     // id of a CounterRow
  std::string ray_class = "all";     // id of a RayClassRow, or "all"
  std::string colormap = "viridis";  // id of a ColormapRow
  std::optional<ValueRange> range;   // nothing: fitted to the picture
  bool logarithmic = false;
  float exposure = 0.0f;          // stops
  std::string tone_map = "aces";  // id of a ToneMapRow
  bool legend = true;             // in exported pictures and in the viewport
  BoxOptions boxes;

  bool operator==(const ViewOptions&) const = default;
};

}  // namespace tracer
