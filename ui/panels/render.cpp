// How the picture is traced: size, ray depth, samples, shadows, tests and kernels.
#include <fmt/format.h>

#include "tracer/bvh/ray_kernels.h"
#include "ui/panels.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

constexpr Choice sizes[] = {
    {"panel", "As the panel", "One pixel of the picture for each pixel of the screen"},
    {"half", "Half of the panel", "Four times as fast"},
    {"quarter", "Quarter of the panel", "Sixteen times as fast"},
    {"fixed", "Fixed", "A size of your choice, whatever the window's is"},
};

void draw_size(Frame& frame) {
  tracer::RenderOptions& render = frame.edited.settings.render;
  heading("Size");
  std::string chosen(sizes[static_cast<int>(frame.state.picture_size)].id);
  if (combo("Picture", chosen, std::span<const Choice>(sizes), "Size of the traced picture")) {
    for (int i = 0; i < 4; ++i) {
      if (sizes[i].id == chosen) frame.state.picture_size = static_cast<PictureSize>(i);
    }
  }
  if (frame.state.picture_size != PictureSize::fixed) {
    text_row("Pixels", fmt::format("{} x {}", render.width, render.height),
             "Width and height of the picture");
    return;
  }
  drag("Width", render.width, 1, tracer::max_image_size, "Pixels in a row");
  drag("Height", render.height, 1, tracer::max_image_size, "Rows of pixels");
}

void draw_rays(tracer::RenderOptions& render) {
  heading("Rays");
  slider("Ray depth", render.ray_depth, 0, tracer::max_ray_depth,
         "How often a ray may be mirrored or refracted after it left the camera");
  slider("Samples", render.samples, 1, 4096,
         "Rays from the camera through each pixel; the first goes through its centre, further ones "
         "smooth the edges",
         true);
  checkbox("Shadows", render.shadows, "Trace a ray to each light to see whether it is hidden");
  checkbox(
      "Fast tests", render.fast,
      "Quicker tests of boxes and triangles that rays may slip through at edges (T. Möller, B. "
      "Trumbore 1997), for comparison. The first pass, counters, visits and the Ray panel stay "
      "watertight; look at Mrays/s in Statistics");
}

// Of each class of rays: the kernels that the layout has.
void draw_kernels(tracer::Settings& settings) {
  std::vector<Choice> choices = {
      {tracer::automatic_kernel, "Automatic",
       "Packets where neighbours go nearly the same way; else streams or single rays, whatever "
       "has taken less time"}};
  for (const tracer::KernelRow& row : tracer::ray_kernels()) {
    if (tracer::has_kernel(settings.build.layout, row.id))
      choices.push_back({row.id, row.label, row.help});
  }
  heading("Kernels");
  const Scope scope("Kernels");
  for (size_t i = 0; i < settings.render.kernels.size(); ++i) {
    std::string chosen(
        kernel_of(settings.render, settings.build.layout, static_cast<tracer::RayClass>(i)));
    if (combo(std::string(tracer::ray_classes()[i].label).c_str(), chosen,
              std::span<const Choice>(choices),
              "How these rays share the work, in passes that count nothing; the picture is the "
              "same. A click on a row of the Benchmark panel chooses here. A kernel that the "
              "layout lacks counts as automatic")) {
      settings.render.kernels[i] = chosen;
    }
  }
}

void draw_progress(const tracer::Snapshot& snapshot) {
  heading("Progress");
  text_row("Passes", fmt::format("{} of {}", snapshot.samples, snapshot.settings.render.samples),
           "Complete passes in the picture. The first one counts what rays do; the later ones only "
           "trace, and add samples");
  text_row("A pass", fmt::format("{:.1f} ms", snapshot.pass_ms),
           "Wall time of the last complete pass");
  text_row("First picture", fmt::format("{:.1f} ms", snapshot.first_picture_ms),
           "From an edit's arrival to a complete coarse picture");
}

}  // namespace

void draw_render(Frame& frame) {
  draw_size(frame);
  draw_rays(frame.edited.settings.render);
  draw_kernels(frame.edited.settings);
  draw_progress(frame.snapshot);
}

}  // namespace ui
