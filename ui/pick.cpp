// Reads the film's facts.
#include "ui/pick.h"

#include <cmath>

#include <fmt/format.h>

#include "tracer/bvh/wide_slot.h"
#include "tracer/choice.h"
#include "tracer/render/views.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::ivec2;
using tracer::Snapshot;
using tracer::vec2;
using tracer::vec3;

std::string numbers(const vec3& v) {
  return fmt::format("{}  {}  {}", short_number(v.x), short_number(v.y), short_number(v.z));
}

// The pixel whose centre the facts of `pixel` were traced through: coarse blocks share one.
ivec2 sampled_pixel(const tracer::Film& film, ivec2 pixel) {
  const int tile =
      pixel.y / tracer::tile_size * tracer::tile_columns(film.width) + pixel.x / tracer::tile_size;
  if (!film.tiles[tile] || !film.tiles[tile]->facts) return pixel;
  const int stride = std::max(film.tiles[tile]->facts->stride, 1);
  return {pixel.x - pixel.x % stride, pixel.y - pixel.y % stride};
}

const tracer::PlacedInstance* placed(const Snapshot& snapshot, uint32_t instance) {
  if (!snapshot.bvh || !snapshot.scene || instance >= snapshot.bvh->instances.size()) {
    return nullptr;
  }
  const tracer::PlacedInstance& found = snapshot.bvh->instances[instance];
  return found.mesh < snapshot.scene->meshes.size() ? &found : nullptr;
}

vec3 moved(const tracer::mat4& matrix, const vec3& point) {
  return vec3(matrix * tracer::vec4(point, 1.0f));
}

void describe_counters(const tracer::ClassCounters& by_class, std::vector<std::string>& lines) {
  for (int i = 0; i < tracer::ray_class_count; ++i) {
    if (by_class[i].rays == 0) continue;
    std::string line = fmt::format("{}:", tracer::ray_classes()[i].id);
    for (const tracer::CounterRow& row : tracer::counters()) {
      line += fmt::format("  {} {}", row.id, by_class[i].*row.member);
    }
    lines.push_back(line);
  }
}

void describe_surface(const Snapshot& snapshot, const Picked& picked,
                      std::vector<std::string>& lines) {
  const tracer::Surface& s = picked.surface;
  const std::vector<tracer::Material>& materials =
      snapshot.settings.look ? snapshot.settings.look->materials : snapshot.scene->materials;
  const std::string material =
      s.material < materials.size() ? materials[s.material].name : std::string("?");
  lines.push_back(fmt::format("instance {}  triangle {}  material {} ({})", s.instance, s.triangle,
                              s.material, material));
  lines.push_back(
      fmt::format("t {}   position {}", short_number(picked.hit.t), numbers(s.position)));
  lines.push_back(fmt::format("normal {}   geometric {}", numbers(s.shading_normal),
                              numbers(s.geometric_normal)));
  lines.push_back(fmt::format("uv {}  {}   weights {}   {}", short_number(s.uv.x),
                              short_number(s.uv.y), numbers(s.barycentric),
                              s.front ? "front" : "back"));
}

}  // namespace

std::array<vec3, 8> box_corners(const tracer::Box& box, const tracer::mat4& to_world) {
  std::array<vec3, 8> corners;
  for (int i = 0; i < 8; ++i) {
    const vec3 corner((i & 1) != 0 ? box.hi.x : box.lo.x, (i & 2) != 0 ? box.hi.y : box.lo.y,
                      (i & 4) != 0 ? box.hi.z : box.lo.z);
    corners[i] = moved(to_world, corner);
  }
  return corners;
}

tracer::CameraFrame film_frame(const Snapshot& snapshot) {
  const tracer::Camera camera =
      snapshot.settings.look ? snapshot.settings.look->camera : tracer::Camera();
  return tracer::frame(camera, std::max(snapshot.film.width, 1), std::max(snapshot.film.height, 1));
}

std::optional<Picked> pick(const Snapshot& snapshot, ivec2 pixel) {
  const tracer::PixelFacts facts = tracer::pixel(snapshot.film, pixel.x, pixel.y);
  if (facts.hit == nullptr || !tracer::is_hit(*facts.hit)) return {};
  const tracer::PlacedInstance* instance = placed(snapshot, facts.hit->instance);
  if (instance == nullptr ||
      facts.hit->triangle >= snapshot.scene->meshes[instance->mesh].triangles.size()) {
    return {};
  }
  const ivec2 sampled = sampled_pixel(snapshot.film, pixel);
  const tracer::Ray ray = tracer::primary_ray(film_frame(snapshot), vec2(sampled) + 0.5f);
  return Picked{*facts.hit,
                tracer::surface_at(*snapshot.scene, *snapshot.bvh, ray.direction, *facts.hit)};
}

std::vector<std::string> describe(const Snapshot& snapshot, const tracer::ViewOptions& view,
                                  ivec2 pixel) {
  std::vector<std::string> lines;
  const tracer::PixelFacts facts = tracer::pixel(snapshot.film, pixel.x, pixel.y);
  std::string first = fmt::format("pixel {}, {}", pixel.x, pixel.y);
  const tracer::ViewRow* row = tracer::find_row(tracer::views(), view.view);
  if (row != nullptr && row->kind == tracer::ViewKind::value) {
    const float value = tracer::value_at(snapshot, view, pixel.x, pixel.y);
    first +=
        fmt::format("   value {} {}", std::isnan(value) ? "none" : short_number(value), row->unit);
  } else if (facts.hit != nullptr) {
    first += fmt::format("   radiance {}", numbers(facts.radiance));
  }
  lines.push_back(first);
  if (facts.hit == nullptr) {
    lines.emplace_back("not rendered yet");
    return lines;
  }
  if (const std::optional<Picked> picked = pick(snapshot, pixel)) {
    describe_surface(snapshot, *picked, lines);
  } else {
    lines.emplace_back("nothing hit");
  }
  if (facts.counters != nullptr) describe_counters(*facts.counters, lines);
  lines.push_back(fmt::format("deepest ray: {} bounces", facts.depth));
  return lines;
}

std::optional<std::array<vec3, 3>> triangle_corners(const Snapshot& snapshot, uint32_t instance,
                                                    uint32_t triangle) {
  const tracer::PlacedInstance* found = placed(snapshot, instance);
  if (found == nullptr) return {};
  const tracer::Mesh& mesh = snapshot.scene->meshes[found->mesh];
  if (triangle >= mesh.triangles.size()) return {};
  std::array<vec3, 3> corners;
  for (int i = 0; i < 3; ++i) {
    corners[i] = moved(found->to_world, mesh.positions[mesh.triangles[triangle][i]]);
  }
  return corners;
}

std::optional<std::array<vec3, 8>> instance_corners(const Snapshot& snapshot, uint32_t instance) {
  const tracer::PlacedInstance* found = placed(snapshot, instance);
  if (found == nullptr || found->mesh >= snapshot.bvh->blases.size()) return {};
  const auto& nodes = snapshot.bvh->blases[found->mesh]->tree.nodes;
  if (nodes.empty()) return {};
  return box_corners(tracer::box_of(nodes[0]), found->to_world);
}

std::vector<std::array<vec3, 8>> mesh_corners(const Snapshot& snapshot, uint32_t mesh,
                                              const tracer::Box& box, uint32_t instance) {
  if (mesh == tracer::none) return {box_corners(box, tracer::mat4(1.0f))};
  constexpr size_t most = 1000;
  std::vector<std::array<vec3, 8>> boxes;
  const auto& instances = snapshot.bvh->instances;
  const bool one = instance < instances.size() && instances[instance].mesh == mesh;
  for (size_t i = 0; i < instances.size() && boxes.size() < most; ++i) {
    if (instances[i].mesh != mesh || (one && i != instance)) continue;
    boxes.push_back(box_corners(box, instances[i].to_world));
  }
  return boxes;
}

std::optional<tracer::Box> node_box(const tracer::SceneBvh& bvh, const NodePlace& place) {
  if (place.mesh != tracer::none && place.mesh >= bvh.blases.size()) return {};
  const bool tlas = place.mesh == tracer::none;
  const tracer::Bvh& tree = tlas ? bvh.tlas : bvh.blases[place.mesh]->tree;
  if (place.node >= tree.nodes.size()) return {};
  return layout_box(tree, tlas ? bvh.wide_tlas : bvh.blases[place.mesh]->wide, place.node);
}

std::vector<std::array<vec3, 8>> node_corners(const Snapshot& snapshot, const NodePlace& place,
                                              uint32_t instance) {
  if (!snapshot.bvh) return {};
  const std::optional<tracer::Box> box = node_box(*snapshot.bvh, place);
  if (!box) return {};
  return mesh_corners(snapshot, place.mesh, *box, instance);
}

tracer::Box selected_bounds(const Snapshot& snapshot, const Selection& selection) {
  tracer::Box box;
  if (selection.node) {
    for (const auto& corners : node_corners(snapshot, *selection.node, selection.instance)) {
      for (const vec3& corner : corners)
        box = tracer::grown(box, corner);
    }
    if (!is_empty(box)) return box;
  }
  if (const auto corners = instance_corners(snapshot, selection.instance)) {
    for (const vec3& corner : *corners)
      box = tracer::grown(box, corner);
    return box;
  }
  if (snapshot.bvh) return tracer::bounds(*snapshot.bvh);
  return box;
}

uint32_t material_of(const Snapshot& snapshot, uint32_t instance, uint32_t triangle) {
  const tracer::PlacedInstance* found = placed(snapshot, instance);
  if (found == nullptr || instance >= snapshot.scene->instances.size()) return tracer::none;
  const uint32_t own = snapshot.scene->instances[instance].material;
  if (own != tracer::none) return own;
  const tracer::Mesh& mesh = snapshot.scene->meshes[found->mesh];
  return triangle < mesh.materials.size() ? mesh.materials[triangle] : tracer::none;
}

}  // namespace ui
