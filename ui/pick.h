// What is under a pixel of the picture, and where things of the scene are in it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tracer/render/surface.h"
#include "ui/workspace_state.h"

namespace ui {

// The camera that made the snapshot's film.
tracer::CameraFrame film_frame(const tracer::Snapshot& snapshot);

struct Picked {
  tracer::Hit hit;
  tracer::Surface surface;
};
// Nothing outside the film, where no facts have arrived yet, and where the ray hit nothing.
std::optional<Picked> pick(const tracer::Snapshot& snapshot, tracer::ivec2 pixel);

// What the text under the cursor says, a line each: hit, surface, counters, value of the view.
std::vector<std::string> describe(const tracer::Snapshot& snapshot, const tracer::ViewOptions& view,
                                  tracer::ivec2 pixel);

// Corner i has the upper coordinate of an axis where its bit of i is set; placed in the world.
std::array<tracer::vec3, 8> box_corners(const tracer::Box& box, const tracer::mat4& to_world);

// World space; nothing when an index is out of range.
std::optional<std::array<tracer::vec3, 3>> triangle_corners(const tracer::Snapshot& snapshot,
                                                            uint32_t instance, uint32_t triangle);
// The corners of an instance's box in object space, placed in the world.
std::optional<std::array<tracer::vec3, 8>> instance_corners(const tracer::Snapshot& snapshot,
                                                            uint32_t instance);
// The same of a box in a mesh, or in the world (none), once for each instance that shows it: all of
// the mesh, or `instance` if that is one of them; a thousand at most.
std::vector<std::array<tracer::vec3, 8>> mesh_corners(const tracer::Snapshot& snapshot,
                                                      uint32_t mesh, const tracer::Box& box,
                                                      uint32_t instance);
// As the layout has it, in the space of its tree; nothing when an index is out of range.
std::optional<tracer::Box> node_box(const tracer::SceneBvh& bvh, const NodePlace& place);
// And of a node's box.
std::vector<std::array<tracer::vec3, 8>> node_corners(const tracer::Snapshot& snapshot,
                                                      const NodePlace& place, uint32_t instance);
// What F focuses on: the selected node, else the selected instance, else everything.
tracer::Box selected_bounds(const tracer::Snapshot& snapshot, const Selection& selection);

// Index of the material that a triangle shows, or none.
uint32_t material_of(const tracer::Snapshot& snapshot, uint32_t instance, uint32_t triangle);

}  // namespace ui
