// Update strategies side by side: four plots, a legend, and the frame from which rebuilding pays.
#include "ui/timeline_curves.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tracer/analyze/break_even.h"
#include "tracer/animation.h"
#include "ui/plot_lines.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::Timeline;
using tracer::TimelineSample;

// Okabe and Ito's colours, which the colour-blind can tell apart.
ImU32 color_of(std::string_view strategy) {
  if (strategy == "refit") return IM_COL32(230, 159, 0, 255);
  if (strategy == "rebuild") return IM_COL32(0, 190, 140, 255);
  return IM_COL32(86, 180, 233, 255);
}

std::string name_of(const Timeline& timeline, std::string_view strategy) {
  if (strategy == "every") return fmt::format("rebuild every {} frames", timeline.update.every);
  return std::string(strategy);
}

struct CurveRow {
  const char *label, *title, *unit, *help;
  double (*value)(const TimelineSample&);
};
constexpr CurveRow curve_rows[] = {
    {"SAH curve", "SAH", "",
     "Surface area heuristic of the meshes' trees, in units of the costs Ct and Ci: sum over inner "
     "nodes of A(node) / A(root) Ct and over leaves of A(node) / A(root) count Ci",
     [](const TimelineSample& sample) { return sample.sah; }},
    {"nodes curve", "Nodes per ray", "",
     "Inner nodes of both levels that a primary ray visits, the mean over the pixels' centres",
     [](const TimelineSample& sample) { return sample.nodes_per_ray; }},
    {"update curve", "Trees", "ms",
     "Wall time to bring the trees to the shape of the frame: refit or build of all meshes, and "
     "the top level",
     [](const TimelineSample& sample) { return sample.tree_ms(); }},
    {"frame curve", "Frame", "ms",
     "Wall time of a whole frame: deformation, trees, and one sample a pixel with all bounces",
     [](const TimelineSample& sample) { return sample.frame_ms(); }},
};

// What the curves depend on.
bool same_subject(const tracer::Settings& a, const tracer::Settings& b) {
  return a.source == b.source && a.build == b.build && a.deformer == b.deformer &&
         a.motion == b.motion && a.update.every == b.update.every &&
         a.update.frames_per_second == b.update.frames_per_second;
}

void draw_legend(const Timeline& timeline) {
  for (const tracer::TimelineCurve& curve : timeline.curves) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float line = ImGui::GetTextLineHeight();
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + 0.4f * line},
                                              {at.x + 1.2f * em(), at.y + 0.6f * line},
                                              color_of(curve.strategy));
    ImGui::Dummy({1.4f * em(), line});
    ImGui::SameLine();
    ImGui::TextUnformatted(name_of(timeline, curve.strategy).c_str());
    ImGui::SameLine(0.0f, 1.5f * em());
  }
  hint(fmt::format("{} {} {:.2g}, {}, picture of {} x {}", timeline.deformer.kind,
                   timeline.deformer.axis, timeline.deformer.amount, timeline.builder,
                   timeline.options.width, timeline.options.height));
}

std::vector<PlotMark> marks_of(const Timeline& timeline) {
  std::vector<PlotMark> marks;
  const tracer::BreakEven even = tracer::break_even(timeline);
  if (even.single) {
    marks.push_back({timeline.curves[0].samples[*even.single].time, "a rebuild pays"});
  }
  if (even.total && even.total != even.single) {
    marks.push_back({timeline.curves[0].samples[*even.total].time, "in sum"});
  }
  return marks;
}

void draw_plots(Frame& frame, const Timeline& timeline, ImVec2 area) {
  std::vector<double> times;
  for (const TimelineSample& sample : timeline.curves[0].samples)
    times.push_back(sample.time);
  const float rate = timeline.update.frames_per_second;
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const bool row = area.x > 34.0f * em();
  const float width = row ? std::floor((area.x - 3.0f * gap) / 4.0f) : area.x;
  const float height = row ? std::max(area.y, 7.0f * em()) : 9.0f * em();
  for (const CurveRow& curve_row : curve_rows) {
    LinePlot plot;
    plot.title = curve_row.title;
    plot.unit = curve_row.unit;
    plot.axis_unit = "s";
    plot.at = times;
    plot.lo = tracer::time_of(timeline.options.from, rate);
    plot.hi = tracer::time_of(std::max(timeline.options.to, timeline.options.from + 1), rate);
    plot.now = frame.edited.settings.time;
    for (const tracer::TimelineCurve& curve : timeline.curves) {
      Line line{name_of(timeline, curve.strategy), color_of(curve.strategy), {}};
      for (const TimelineSample& sample : curve.samples)
        line.values.push_back(curve_row.value(sample));
      plot.lines.push_back(std::move(line));
    }
    if (&curve_row == &curve_rows[3]) plot.marks = marks_of(timeline);
    const std::optional<double> place =
        plot_lines(curve_row.label, plot, {width, height}, curve_row.help);
    if (place) frame.edited.settings.time = static_cast<float>(*place);
    if (row && &curve_row != &curve_rows[3]) ImGui::SameLine();
  }
}

}  // namespace

void draw_timeline_curves(Frame& frame) {
  const Background<Timeline>& work = frame.work.timeline;
  if (!work.error.empty()) ImGui::TextWrapped("%s", work.error.c_str());
  if (!work.result || work.result->curves.empty() || work.result->curves[0].samples.empty()) {
    if (work.running) {
      hint("The first frame is being measured.");
    } else if (tracer::is_active(frame.edited.settings.deformer)) {
      hint(
          "Measure, on the left, draws the curves of SAH, nodes per ray, update and frame time "
          "for refit, periodic rebuild and rebuild, and finds the frame from which rebuilding "
          "pays.");
    } else {
      hint("Nothing is deformed. Choose a deformer on the left: twist, wave, bend or explode.");
    }
    return;
  }
  const Timeline& timeline = *work.result;
  draw_legend(timeline);
  const bool other =
      frame.work.timeline_of && !same_subject(*frame.work.timeline_of, frame.edited.settings);
  std::string words = tracer::break_even_text(timeline);
  if (other) words = "Of other settings than the present ones; measure again. " + words;
  if (work.stopped) words = "Stopped before the end of the range. " + words;
  if (!timeline.warning.empty()) words += " " + timeline.warning;
  const ImVec2 area = ImGui::GetContentRegionAvail();
  const float lines = ImGui::CalcTextSize(words.c_str(), nullptr, false, area.x).y +
                      ImGui::GetStyle().ItemSpacing.y;
  draw_plots(frame, timeline, {area.x, area.y - lines});
  ImGui::PushTextWrapPos(0.0f);
  ImGui::TextUnformatted(words.c_str());
  ImGui::PopTextWrapPos();
  mark("words");
  tooltip(
      "A frame is deformation, trees and one sample a pixel. 'A single frame' is the first of "
      "two measured frames in a row that are shorter with a rebuild than with a refit; 'all "
      "frames together' is the first at which the sum over the measured frames is smaller");
}

}  // namespace ui
