// Boxes to lines and faces, the far ones first, in bands of rows that are drawn side by side.
#include "tracer/render/overlay.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include "tracer/choice.h"
#include "tracer/render/color_bar.h"
#include "tracer/render/measure_colors.h"
#include "tracer/render/overlay_raster.h"

namespace tracer {
namespace {

constexpr int band_rows = 16;
constexpr float line_cover = 0.92f;
constexpr float hidden_share = 0.22f;  // of what is drawn behind a surface
constexpr float slack = 0.004f;        // of the distance: boxes touch the surfaces in them
constexpr float shared_cover = 0.7f;
constexpr uint32_t shared_color = 0xffff40f0u;                      // magenta; bytes R, G, B, A
constexpr std::array<float, 3> face_cover = {0.14f, 0.20f, 0.10f};  // across x, y, z

// A box on the screen.
struct ScreenBox {
  std::array<ScreenLine, 12> lines;
  std::array<ScreenFace, 3> faces;  // those that look at the camera
  int line_count = 0;
  int face_count = 0;
  float y_lo = infinity, y_hi = -infinity;  // pixels
  float distance = 0.0f;                    // of its middle
  uint32_t color = 0;
  bool solid = false;
};

// From an instance's space to the camera's: right, up, forward.
struct View {
  vec3 x, y, z, origin;
  vec3 eye;  // in the instance's space; orthographic: against the view direction
  bool orthographic;
};

View view_of(const CameraFrame& camera, const PlacedInstance* instance) {
  const mat4 to_world = instance != nullptr ? instance->to_world : mat4(1.0f);
  const auto turned = [&](const vec3& v) {
    return vec3(glm::dot(v, camera.right), glm::dot(v, camera.up), glm::dot(v, camera.forward));
  };
  View view;
  view.x = turned(vec3(to_world[0]));
  view.y = turned(vec3(to_world[1]));
  view.z = turned(vec3(to_world[2]));
  view.origin = turned(vec3(to_world[3]) - camera.eye);
  const mat4 to_object = instance != nullptr ? instance->to_object : mat4(1.0f);
  view.eye = vec3(to_object *
                  (camera.orthographic ? vec4(-camera.forward, 0.0f) : vec4(camera.eye, 1.0f)));
  view.orthographic = camera.orthographic;
  return view;
}

class Projection {
 public:
  explicit Projection(const CameraFrame& camera)
      : size_(camera.resolution),
        scale_(0.5f * camera.resolution / camera.half_size),
        orthographic_(camera.orthographic) {}

  // Pixels and nearness of a point in camera space that is not behind the near plane.
  vec3 operator()(const vec3& point) const {
    const float nearness = orthographic_ ? -point.z : 1.0f / point.z;
    const float shrink = orthographic_ ? 1.0f : nearness;
    return {0.5f * size_.x + point.x * shrink * scale_.x,
            0.5f * size_.y - point.y * shrink * scale_.y, nearness};
  }

 private:
  vec2 size_, scale_;
  bool orthographic_;
};

// What is nearer than this is cut off.
float near_plane(const std::array<vec3, 8>& corners, bool orthographic) {
  if (orthographic) return -infinity;
  float most = 0.0f;
  for (const vec3& corner : corners)
    most = std::max(most, std::abs(corner.z));
  return std::max(1e-4f * most, 1e-30f);
}

void add_lines(ScreenBox& box, const std::array<vec3, 8>& corners, float near,
               const Projection& project, const CameraFrame& camera) {
  for (size_t i = 0; i < 8; ++i) {
    for (const size_t axis : {1, 2, 4}) {
      if ((i & axis) != 0) continue;
      vec3 a = corners[i], b = corners[i | axis];
      if (a.z < near && b.z < near) continue;
      const vec3 step = b - a;
      const vec3 begin = a;
      if (a.z < near) a = begin + step * ((near - begin.z) / step.z);
      if (b.z < near) b = begin + step * ((near - begin.z) / step.z);
      ScreenLine line{project(a), project(b)};
      if (!clip(line, camera.resolution.x, camera.resolution.y, 4.0f)) continue;
      box.y_lo = std::min({box.y_lo, line.from.y, line.to.y});
      box.y_hi = std::max({box.y_hi, line.from.y, line.to.y});
      box.lines[size_t(box.line_count++)] = line;
    }
  }
}

// The nearness as a function of the pixel, from three corners that are not in a line.
bool set_plane(ScreenFace& face, const std::array<vec3, 5>& points) {
  for (int i = 2; i < face.count; ++i) {
    const vec3 a = points[size_t(i - 1)] - points[0];
    const vec3 b = points[size_t(i)] - points[0];
    const float area = a.x * b.y - a.y * b.x;
    if (std::abs(area) < 1e-3f) continue;
    face.plane.x = (a.z * b.y - a.y * b.z) / area;
    face.plane.y = (a.x * b.z - a.z * b.x) / area;
    face.plane.z = points[0].z - face.plane.x * points[0].x - face.plane.y * points[0].y;
    return true;
  }
  return false;
}

void add_face(ScreenBox& box, const std::array<vec3, 4>& quad, float near, float cover,
              const Projection& project) {
  ScreenFace face;
  std::array<vec3, 5> points;
  for (size_t i = 0; i < 4; ++i) {
    const vec3 &a = quad[i], &b = quad[(i + 1) % 4];
    if (a.z >= near) points[size_t(face.count++)] = project(a);
    if ((a.z >= near) != (b.z >= near)) {
      points[size_t(face.count++)] = project(a + (b - a) * ((near - a.z) / (b.z - a.z)));
    }
  }
  if (face.count < 3 || !set_plane(face, points)) return;
  for (int i = 0; i < face.count; ++i) {
    face.corners[size_t(i)] = vec2(points[size_t(i)]);
    box.y_lo = std::min(box.y_lo, points[size_t(i)].y);
    box.y_hi = std::max(box.y_hi, points[size_t(i)].y);
  }
  face.cover = cover;
  box.faces[size_t(box.face_count++)] = face;
}

void add_faces(ScreenBox& box, const Box& bounds, const std::array<vec3, 8>& corners,
               const View& view, float near, const Projection& project) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool upper = view.orthographic ? view.eye[axis] > 0.0f : view.eye[axis] > bounds.hi[axis];
    const bool lower = view.orthographic ? view.eye[axis] < 0.0f : view.eye[axis] < bounds.lo[axis];
    if (!upper && !lower) continue;
    const size_t u = size_t(1) << ((axis + 1) % 3), v = size_t(1) << ((axis + 2) % 3);
    const size_t side = upper ? size_t(1) << axis : 0;
    const std::array<vec3, 4> quad = {corners[side], corners[side | u], corners[side | u | v],
                                      corners[side | v]};
    const float cover = box.solid ? shared_cover : face_cover[size_t(axis)];
    add_face(box, quad, near, cover, project);
  }
}

struct Painted {
  Box box;
  uint32_t instance = none;
  uint32_t color = 0;
  bool solid = false;
};

ScreenBox on_screen(const Painted& painted, const View& view, const CameraFrame& camera,
                    const BoxOptions& options) {
  ScreenBox box;
  box.color = painted.color;
  box.solid = painted.solid;
  const vec3 base = view.origin + painted.box.lo.x * view.x + painted.box.lo.y * view.y +
                    painted.box.lo.z * view.z;
  const vec3 size = extent(painted.box);
  std::array<vec3, 8> corners;
  for (size_t i = 0; i < 8; ++i) {
    corners[i] = base;
    if ((i & 1) != 0) corners[i] += size.x * view.x;
    if ((i & 2) != 0) corners[i] += size.y * view.y;
    if ((i & 4) != 0) corners[i] += size.z * view.z;
  }
  const vec3 sum = corners[0] + corners[7];
  if (!std::isfinite(sum.x + sum.y + sum.z)) return box;
  box.distance = 0.5f * (corners[0].z + corners[7].z);
  const Projection project(camera);
  const float near = near_plane(corners, camera.orthographic);
  if (options.wire || box.solid) add_lines(box, corners, near, project, camera);
  if (options.translucent || box.solid) {
    add_faces(box, painted.box, corners, view, near, project);
  }
  return box;
}

// The least nearness of what is not hidden in some rows.
std::vector<float> limits_of(const Film& film, const CameraFrame& camera, int y0, int y1) {
  std::vector<float> limits(size_t(y1 - y0) * size_t(film.width), -infinity);
  const vec2 step = 2.0f / camera.resolution * camera.half_size;
  for (int y = y0; y < y1; ++y) {
    for (int x0 = 0; x0 < film.width; x0 += tile_size) {
      const size_t tile =
          size_t(y / tile_size) * size_t(tile_columns(film.width)) + size_t(x0 / tile_size);
      if (!film.tiles[tile] || !film.tiles[tile]->facts) continue;
      const TileFacts& facts = *film.tiles[tile]->facts;
      const size_t row = size_t(y % tile_size / facts.stride) * size_t(facts.columns);
      // A coarse sample stands for its block, and was taken at the block's upper left.
      const float sampled_y = float(y - y % tile_size % facts.stride) + 0.5f;
      const float up = camera.half_size.y - sampled_y * step.y;
      for (int x = x0; x < std::min(x0 + tile_size, film.width); ++x) {
        const int column = (x - x0) / facts.stride;
        const Hit& hit = facts.hits[row + size_t(column)];
        if (!is_hit(hit)) continue;
        float& limit = limits[size_t(y - y0) * size_t(film.width) + size_t(x)];
        if (camera.orthographic) {
          limit = -hit.t * (1.0f + slack);
          continue;
        }
        const float sampled_x = float(x0 + column * facts.stride) + 0.5f;
        const float right = sampled_x * step.x - camera.half_size.x;
        limit = std::sqrt(1.0f + right * right + up * up) / hit.t * (1.0f - slack);
      }
    }
  }
  return limits;
}

std::vector<Painted> painted_boxes(const NodeBoxes& boxes, const NodeMeasureRow& measure,
                                   const BoxOptions& options) {
  const MeasureColors colors(measure.scale, boxes.range, options.logarithmic, counts(measure));
  std::vector<Painted> painted;
  painted.reserve(boxes.boxes.size() + boxes.shared.size());
  for (const NodeBox& box : boxes.boxes)
    painted.push_back({box.box, box.instance, colors(box.value), false});
  for (const SharedBox& shared : boxes.shared)
    painted.push_back({shared.box, shared.instance, shared_color, true});
  return painted;
}

const NodeMeasureRow& measure_of(const BoxOptions& options) {
  const NodeMeasureRow* measure = find_row(node_measures(), options.color);
  return measure != nullptr ? *measure : node_measures()[0];
}

}  // namespace

BoxSources box_sources(const Snapshot& snapshot, const BoxOptions& options, const Job& job) {
  BoxSources sources;
  if (needs_visits(options)) {
    const RenderOptions& render = snapshot.settings.render;
    const Look& look = *snapshot.settings.look;
    const World world{*snapshot.scene, *snapshot.bvh, look, render};
    auto visits = count_visits(world, frame(look.camera, render.width, render.height), job);
    sources.visits =
        std::make_shared<const CountedVisits>(CountedVisits{snapshot.bvh, std::move(visits)});
  }
  if (needs_measures(options)) {
    Measures measures;
    measures.bvh = snapshot.bvh;
    measures.blas_epo = blas_epo(*snapshot.scene, *snapshot.bvh, epo_limits, job.stop);
    measures.tlas_epo = tlas_epo(*snapshot.scene, *snapshot.bvh, epo_limits, job.stop);
    sources.measures = std::make_shared<const Measures>(std::move(measures));
  }
  return sources;
}

void draw_boxes(Picture& picture, const Snapshot& snapshot, const NodeBoxes& boxes,
                const BoxOptions& options) {
  const Film& film = snapshot.film;
  if (!boxes.bvh || boxes.bvh != snapshot.bvh || film.tiles.empty() || !snapshot.settings.look) {
    return;
  }
  picture.boxes =
      DrawnBoxes{boxes.boxes.size(), boxes.found, boxes.at_least, boxes.range, boxes.has_values};
  const CameraFrame camera = frame(snapshot.settings.look->camera, film.width, film.height);
  const std::vector<Painted> painted = painted_boxes(boxes, measure_of(options), options);

  std::vector<ScreenBox> screen(painted.size());
  tbb::parallel_for(size_t(0), painted.size(), [&](size_t i) {
    const uint32_t instance = painted[i].instance;
    const View view =
        view_of(camera, instance == none ? nullptr : &snapshot.bvh->instances[instance]);
    screen[i] = on_screen(painted[i], view, camera, options);
  });
  std::vector<uint32_t> order(screen.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    if (screen[a].solid != screen[b].solid) return screen[b].solid;  // over the others
    return screen[a].distance != screen[b].distance ? screen[a].distance > screen[b].distance
                                                    : a < b;
  });

  const float width = std::clamp(options.line_width, 1.0f, max_box_line_width);
  const float hidden = options.fade_hidden ? hidden_share : 1.0f;
  const int bands = (film.height + band_rows - 1) / band_rows;
  tbb::parallel_for(0, bands, [&](int index) {
    const int y0 = index * band_rows;
    const int y1 = std::min(y0 + band_rows, film.height);
    std::vector<float> limits;
    if (options.fade_hidden) limits = limits_of(film, camera, y0, y1);
    const Band band{picture.image, y0, y1, limits};
    for (const uint32_t i : order) {
      const ScreenBox& box = screen[i];
      if (box.y_hi < float(y0) - width - 1.0f || box.y_lo > float(y1) + width + 1.0f) continue;
      for (int j = 0; j < box.face_count; ++j)
        draw_face(band, box.faces[size_t(j)], {box.color, 1.0f, hidden});
      for (int j = 0; j < box.line_count; ++j) {
        draw_line(band, box.lines[size_t(j)], width, {box.color, line_cover, line_cover * hidden});
      }
    }
  });
}

void draw_box_legend(Picture& picture, const BoxOptions& options) {
  if (!picture.boxes || picture.boxes->drawn == 0) return;
  const NodeMeasureRow& measure = measure_of(options);
  ColorBar bar;
  bar.title = "Boxes: " + std::string(measure.label);
  bar.note = picture.boxes->has_range ? std::string(measure.unit) : "not known yet";
  bar.range = picture.boxes->range;
  bar.counts = counts(measure);
  bar.logarithmic = options.logarithmic && measure.scale == MeasureScale::sequential;
  bar.color = [scale = measure.scale](float t) { return measure_color(scale, t); };
  if (measure.scale == MeasureScale::category) bar.names = {"inner node", "leaf"};
  draw_color_bar(picture.image, bar, Side::right);
}

}  // namespace tracer
