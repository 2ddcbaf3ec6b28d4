// What rays cost, by class, and the shape of the trees.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tracer/analyze/quality.h"
#include "tracer/bvh/counters.h"
#include "ui/panels.h"
#include "ui/plot.h"
#include "ui/registry.h"
#include "ui/speed.h"
#include "ui/widgets.h"

namespace ui {
namespace {

struct MeasureRow {
  const char *label, *help;
  tracer::Percentiles tracer::RayStatistics::*member;
};
constexpr MeasureRow measures[] = {
    {"nodes",
     "Inner nodes visited by one ray; each visit tests the boxes of all its children: two "
     "in the binary layout",
     &tracer::RayStatistics::nodes},
    {"leaves", "Leaves visited by one ray", &tracer::RayStatistics::leaves},
    {"triangles", "Triangle tests of one ray", &tracer::RayStatistics::triangles},
    {"instances", "Instances whose own tree one ray entered", &tracer::RayStatistics::instances},
};

struct ColumnRow {
  const char *label, *help;
};
constexpr ColumnRow columns[] = {
    {"Rays", "Class, and how many were cast in the first pass"},
    {"Mrays/s", speed_help},
    {"Per ray", "What is counted"},
    {"Mean", "Of the pixels' means per ray"},
    {"p50", "Half of the pixels that cast such rays cost less per ray"},
    {"p95", "95 % of the pixels cost less per ray"},
    {"p99", "99 % of the pixels cost less per ray"},
    {"Max", "The most expensive pixel's mean per ray"},
};

// In the first column, below the class.
void beside_label(const std::string& text, const char* help) {
  ImGui::TableSetColumnIndex(0);
  hint(text, help);
  ImGui::TableSetColumnIndex(1);
}

std::string traced_how(const tracer::RayRate& rate, bool fast) {
  const uint64_t alone = rate.rays - rate.in_packets - rate.in_streams;
  const char* kernel = rate.in_packets >= std::max(rate.in_streams, alone) ? "in packets"
                       : rate.in_streams >= alone                          ? "in streams"
                                                                           : "one by one";
  return fast ? std::string(kernel) + ", fast" : kernel;
}

void draw_class(const tracer::RayClassRow& row, const tracer::RayStatistics& rays,
                const tracer::RayRate& rate, const tracer::RenderOptions& options, bool chosen) {
  bool first = true;
  for (const MeasureRow& measure : measures) {
    ImGui::TableNextRow();
    cell(first ? std::string(row.label) : "");
    if (first) tooltip(row.help);
    const double speed = mrays_per_second(rate);
    cell(first && speed > 0.0 ? fmt::format("{:.2f}", speed) : "");
    if (&measure == &measures[1]) {
      beside_label(grouped(rays.count), "Rays of this class in the first pass");
    }
    if (&measure == &measures[2] && rate.rays > 0) {
      beside_label(traced_how(rate, options.fast),
                   "How the rays of this class were traced; said is what most of them did. Unless "
                   "chosen: in packets where neighbours go nearly the same way; others in "
                   "streams or one by one, whatever took less time. fast: with the fast tests of "
                   "the Render panel");
    }
    if (&measure == &measures[3] && rate.rays > 0) {
      beside_label(chosen ? "chosen" : "automatic",
                   "Who says how the rays of this class are traced: the Render panel, or the "
                   "renderer by what the rays are like and what they took");
    }
    cell(measure.label);
    tooltip(measure.help);
    const tracer::Percentiles& p = rays.*measure.member;
    for (const double value : {p.mean, p.p50, p.p95, p.p99, p.max}) {
      cell(fmt::format("{:.1f}", value));
      tooltip(fmt::format("{} {} per ray", value, measure.label));
    }
    first = false;
  }
}

// Scrolls by itself if it has a height.
void draw_rays(const tracer::Snapshot& snapshot, ImVec2 size) {
  const ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH |
                                ImGuiTableFlags_SizingStretchProp |
                                (size.y > 0.0f ? ImGuiTableFlags_ScrollY : 0);
  if (!ImGui::BeginTable("rays", 8, flags, size)) return;
  if (size.y > 0.0f) ImGui::TableSetupScrollFreeze(0, 1);
  for (int i = 0; i < 8; ++i) {
    ImGui::TableSetupColumn(columns[i].label, ImGuiTableColumnFlags_WidthStretch,
                            i == 0   ? 2.2f
                            : i == 2 ? 1.2f
                                     : 1.0f);
  }
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (const ColumnRow& column : columns)
    header(column.label, column.help);
  bool any = false;
  for (int i = 0; snapshot.ray_statistics && i < tracer::ray_class_count; ++i) {
    const tracer::RayStatistics& rays = (*snapshot.ray_statistics)[i];
    if (rays.count == 0) continue;
    any = true;
    const tracer::RenderOptions& options = snapshot.settings.render;
    const bool chosen = kernel_of(options, snapshot.settings.build.layout,
                                  static_cast<tracer::RayClass>(i)) != tracer::automatic_kernel;
    draw_class(tracer::ray_classes()[i], rays, snapshot.rates[i], options, chosen);
  }
  if (!any) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    hint("after the first pass");
  }
  ImGui::EndTable();
  mark("rays");
}

std::vector<double> heights(const std::vector<uint64_t>& counts) {
  return {counts.begin(), counts.end()};
}

void draw_counter(const tracer::Picture& picture, const tracer::ViewOptions& view, ImVec2 size) {
  Bars bars;
  const std::vector<double> values(picture.histogram.bars.begin(), picture.histogram.bars.end());
  const bool whole = picture.counts && !view.logarithmic;
  const double length = picture.range.hi - picture.range.lo + (whole ? 1.0 : 0.0);
  bars.title = picture.title;
  bars.unit = picture.unit;
  bars.first = picture.range.lo;
  bars.step = values.empty() ? 1.0 : length / static_cast<double>(values.size());
  bars.whole = whole && bars.step == 1.0;
  bars.heights = values;
  bars.logarithmic = true;
  bars.what = "pixels";
  plot_bars("values", bars, size, "How many pixels of the shown range have which value");
}

void draw_leaves(const tracer::Snapshot& snapshot, ImVec2 size, bool depth) {
  Bars bars;
  std::vector<double> values;
  if (snapshot.blas_statistics) {
    values = heights(depth ? snapshot.blas_statistics->leaf_depth_histogram
                           : snapshot.blas_statistics->leaf_size_histogram);
  }
  bars.title = depth ? "Depth of leaves" : "Size of leaves";
  bars.heights = values;
  bars.whole = true;
  bars.unit = depth ? "edges from the root" : "references";
  bars.what = "leaves";
  plot_bars(depth ? "leaf depth" : "leaf size", bars, size,
            depth ? "How many leaves of the meshes' trees are how deep"
                  : "How many leaves of the meshes' trees hold how many references");
}

}  // namespace

void draw_statistics(Frame& frame) {
  if (!frame.snapshot.blas_statistics) {
    hint("The figures appear when the first picture has been traced.");
    return;
  }
  const ImVec2 area = ImGui::GetContentRegionAvail();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const bool values = frame.picture != nullptr && frame.picture->has_range;
  if (area.x > 48.0f * em()) {
    const int plots = values ? 3 : 2;
    const float table = std::floor(std::max(32.0f * em(), 0.45f * area.x));
    const float plot = std::floor((area.x - table) / static_cast<float>(plots) - gap);
    draw_rays(frame.snapshot, {table, area.y});
    if (values) {
      ImGui::SameLine();
      draw_counter(*frame.picture, frame.edited.view, {plot, area.y});
    }
    ImGui::SameLine();
    draw_leaves(frame.snapshot, {plot, area.y}, false);
    ImGui::SameLine();
    draw_leaves(frame.snapshot, {plot, area.y}, true);
    return;
  }
  draw_rays(frame.snapshot, {area.x, 0});
  const float half = std::floor(0.5f * (area.x - gap));
  if (values) draw_counter(*frame.picture, frame.edited.view, {area.x, 9.0f * em()});
  draw_leaves(frame.snapshot, {half, 9.0f * em()}, false);
  ImGui::SameLine();
  draw_leaves(frame.snapshot, {half, 9.0f * em()}, true);
}

}  // namespace ui
