// The table of panels.
#include "ui/panels.h"

#include <array>

namespace ui {
namespace {

constexpr std::array<PanelRow, 14> rows = {{
    {"scene", "Scene", "What is loaded: meshes, instances, textures, warnings, parameters",
     Region::left, draw_scene},
    {"materials", "Materials", "Every material of the scene, and what it does with light",
     Region::left, draw_materials},
    {"lights", "Lights", "Point lights, ambient light and the sky", Region::left, draw_lights},
    {"viewport", "Viewport", "The picture: orbit, fly, pick", Region::centre, draw_viewport},
    {"view", "View", "What a pixel shows: shaded, a property of the surface, or a counter",
     Region::right, draw_view},
    {"render", "Render", "Size, ray depth, samples and shadows", Region::right, draw_render},
    {"camera", "Camera", "Where the picture is taken from", Region::right, draw_camera},
    {"build", "Build", "The builder of the BVH, its options, and what it cost", Region::right,
     draw_build},
    {"statistics", "Statistics", "Cost per ray and the shape of the tree", Region::bottom,
     draw_statistics},
    {"builders", "Builders", "Builders and their options side by side: build time, quality, cost",
     Region::bottom, draw_builders},
    {"findings", "Findings", "Whether the trees are right: rules, and rays against brute force",
     Region::bottom, draw_findings},
    {"timeline", "Timeline",
     "Time: play it, deform meshes, and compare refitting with rebuilding their trees",
     Region::bottom, draw_timeline},
    {"ray", "Ray", "The rays of the clicked pixel, and one of them step by step through the trees",
     Region::bottom, draw_ray},
    {"messages", "Messages", "Warnings, errors and what has been done", Region::bottom,
     draw_messages},
}};

}  // namespace

std::span<const PanelRow> panels() {
  return rows;
}

}  // namespace ui
