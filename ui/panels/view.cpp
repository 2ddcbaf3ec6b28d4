// What a pixel shows, and how values become colours.
#include <cmath>

#include <fmt/format.h>

#include "tracer/choice.h"
#include "tracer/render/colormap.h"
#include "tracer/render/tone_map.h"
#include "tracer/render/views.h"
#include "ui/actions.h"
#include "ui/node_words.h"
#include "ui/panels.h"
#include "ui/range_bar.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

std::string upper_first(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 32);
  return text;
}

void draw_choice(tracer::ViewOptions& view, const tracer::ViewRow* row) {
  combo("View", view.view, tracer::views(),
        "What a pixel shows. Keys 1 to 9 choose the first nine");
  if (row == nullptr) return;
  if (row->id == "counter") {
    combo("Counter", view.counter, tracer::counters(), "What the heat map counts, for each pixel");
  }
  if (row->by_ray_class) {
    const std::vector<Choice> classes = ray_choices();
    combo("Rays", view.ray_class, std::span<const Choice>(classes), "Which rays are counted");
  }
  hint(row->help);
}

void draw_tone(tracer::ViewOptions& view) {
  heading("Exposure");
  slider("Exposure", view.exposure, -10.0f, 10.0f,
         "In stops: each one doubles the brightness of the picture", "%.2f stops");
  combo("Tone map", view.tone_map, tracer::tone_maps(),
        "How light that is brighter than white is fitted into the picture");
  if (button("Reset exposure", "Back to no change and ACES")) {
    view.exposure = 0.0f;
    view.tone_map = "aces";
  }
}

// The ends as numbers; editing one holds the range.
void draw_ends(tracer::ViewOptions& view, const tracer::Picture& picture) {
  tracer::ValueRange range = view.range.value_or(picture.range);
  const float speed = std::max(1e-3f * std::abs(range.hi - range.lo), 1e-6f);
  const char* format = picture.counts ? "%.0f" : "%.5g";
  bool changed = drag("From", range.lo, picture.counts ? 0.25f : speed, -1e30f, range.hi,
                      "Values up to this have the first colour", format);
  changed |= drag("To", range.hi, picture.counts ? 0.25f : speed, range.lo, 1e30f,
                  "Values from this on have the last colour", format);
  if (changed && std::isfinite(range.lo) && std::isfinite(range.hi)) view.range = range;
}

void draw_range(Frame& frame, const tracer::Picture& picture) {
  tracer::ViewOptions& view = frame.edited.view;
  heading("Range");
  tracer::ValueRange range = view.range.value_or(picture.range);
  if (range_bar("Range", range, picture, view,
                "The pixels' values (above; heights logarithmic) and their colours. Drag the ends "
                "to choose the range")) {
    view.range = range;
  }
  draw_ends(view, picture);
  if (button("Fit", "From the smallest to the largest value of this picture, and hold it (C)")) {
    fit_range(frame);
  }
  ImGui::SameLine();
  bool continuously = !view.range.has_value();
  if (ImGui::Checkbox("Continuously", &continuously)) {
    view.range = continuously ? std::nullopt : std::optional(picture.range);
  }
  mark("Continuously");
  tooltip("Fit the range to every new picture");
  checkbox("Logarithmic", view.logarithmic,
           "Colours by the logarithm of the value: for counters with a few very large values");
}

void draw_figures(const tracer::Picture& picture) {
  heading("Values in the picture");
  text_row("Shown", upper_first(picture.title), "What the colours stand for");
  text_row("Unit", picture.unit.empty() ? "-" : picture.unit, "Of the numbers");
  if (picture.histogram.values == 0) {
    hint("No pixel has a value: the checkerboard marks them.");
    return;
  }
  text_row("Smallest", short_number(picture.histogram.range.lo), "Of all pixels");
  text_row("Mean", short_number(picture.histogram.mean), "Over the pixels that have a value");
  text_row("Largest", short_number(picture.histogram.range.hi), "Of all pixels");
  text_row("Pixels", grouped(picture.histogram.values),
           "With a value; the others are a checkerboard");
}

}  // namespace

void draw_view(Frame& frame) {
  tracer::ViewOptions& view = frame.edited.view;
  const tracer::ViewRow* row = tracer::find_row(tracer::views(), view.view);
  draw_choice(view, row);
  if (row == nullptr) return;
  if (row->kind == tracer::ViewKind::radiance) draw_tone(view);
  if (row->kind != tracer::ViewKind::value) return;
  heading("Colours");
  combo("Colour map", view.colormap, tracer::colormaps(), "From small values to large ones");
  checkbox("Legend", view.legend, "Draw the colours with their numbers into the picture");
  if (frame.picture == nullptr || !frame.picture->has_range) {
    hint("The range appears with the picture.");
    return;
  }
  draw_range(frame, *frame.picture);
  draw_figures(*frame.picture);
}

}  // namespace ui
