// The table of panels.
#include "ui/panels.h"

#include <array>

namespace ui {
namespace {

constexpr auto rows = std::to_array<PanelRow>({
    {"scene", "Scene", "What is loaded: meshes, instances, textures, warnings, parameters",
     Region::left, draw_scene},
    {"materials", "Materials", "Every material of the scene, and what it does with light",
     Region::left, draw_materials},
    {"lights", "Lights", "Point lights, ambient light and the sky", Region::left, draw_lights},
    {"tree", "Tree", "The nodes of the trees, TLAS and BLAS, down to triangles", Region::left,
     draw_tree},
    {"viewport", "Viewport", "The picture: orbit, fly, pick", Region::centre, draw_viewport},
    {"view", "View", "What a pixel shows: shaded, a property of the surface, or a counter",
     Region::right, draw_view},
    {"render", "Render", "Size, ray depth, samples, shadows and kernels", Region::right,
     draw_render},
    {"camera", "Camera", "Where the picture is taken from", Region::right, draw_camera},
    {"build", "Build", "The builder of the BVH, its options, and what it cost", Region::right,
     draw_build},
    {"boxes", "Boxes", "The boxes of the trees in the picture: which, and what their colour says",
     Region::right, draw_boxes},
    {"node", "Node",
     "The selected node: its measures, the rays that enter it, and how it could be split",
     Region::right, draw_node_panel},
    {"statistics", "Statistics", "Cost per ray and the shape of the tree", Region::bottom,
     draw_statistics},
    {"builders", "Builders", "Builders and their options side by side: build time, quality, cost",
     Region::bottom, draw_builders},
    {"benchmark", "Benchmark",
     "Build times and rays a second of layouts and kernels, beside Embree", Region::bottom,
     draw_benchmark},
    {"hot", "Hot nodes", "Nodes and triangles that cost most beyond their prediction, and why",
     Region::bottom, draw_hot_spots},
    {"findings", "Findings", "Whether the trees are right: rules, and rays against brute force",
     Region::bottom, draw_findings},
    {"timeline", "Timeline",
     "Time: play it, deform meshes, and compare refitting with rebuilding their trees",
     Region::bottom, draw_timeline},
    {"icicle", "Icicle", "A whole tree at once: its levels, coloured by what is known of the nodes",
     Region::bottom, draw_icicle},
    {"ray", "Ray", "The rays of the clicked pixel, and one of them step by step through the trees",
     Region::bottom, draw_ray},
    {"replay", "Replay", "The build of a tree, split by split, with its boxes in the picture",
     Region::bottom, draw_replay_panel},
    {"messages", "Messages", "Warnings, errors and what has been done", Region::bottom,
     draw_messages},
});

}  // namespace

std::span<const PanelRow> panels() {
  return rows;
}

}  // namespace ui
