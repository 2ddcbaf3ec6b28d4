// The curves of a timeline, frame by frame.
#include "tracer/analyze/timeline_report.h"

#include <fmt/format.h>

#include "tracer/analyze/break_even.h"

namespace tracer {

Json timeline_json(const Scene& scene, const Timeline& timeline) {
  Json curves = Json::array();
  for (const TimelineCurve& curve : timeline.curves) {
    Json frames = Json::array();
    for (const TimelineSample& sample : curve.samples) {
      frames.push_back({{"frame", sample.frame},
                        {"time_s", sample.time},
                        {"sah", sample.sah},
                        {"growth_mean", sample.growth},
                        {"nodes_per_primary_ray", sample.nodes_per_ray},
                        {"deform_ms", sample.deform_ms},
                        {"refit_ms", sample.refit_ms},
                        {"build_ms", sample.build_ms},
                        {"tlas_ms", sample.tlas_ms},
                        {"trace_ms", sample.trace_ms},
                        {"frame_ms", sample.frame_ms()}});
    }
    curves.push_back({{"strategy", curve.strategy}, {"frames", frames}});
  }
  const BreakEven even = break_even(timeline);
  const auto frame_of = [&](const std::optional<size_t>& index) {
    return index ? Json(timeline.curves[0].samples[*index].frame) : Json();
  };
  const Deformer& deformer = timeline.deformer;
  return {{"schema", 1},
          {"scene", scene_json(scene)},
          {"timeline",
           {{"builder", timeline.builder},
            {"deformer",
             {{"kind", deformer.kind},
              {"amount", deformer.amount},
              {"axis", deformer.axis},
              {"speed_per_s", deformer.speed}}},
            {"frames_per_second", timeline.update.frames_per_second},
            {"every", timeline.update.every},
            {"growth", timeline.update.growth},
            {"width", timeline.options.width},
            {"height", timeline.options.height},
            {"curves", curves},
            {"rebuild_pays_in_frame", frame_of(even.single)},
            {"rebuild_pays_in_sum_from_frame", frame_of(even.total)},
            {"break_even", break_even_text(timeline)},
            {"warning", timeline.warning}}},
          {"machine", machine_json()}};
}

std::string timeline_text(const Timeline& timeline) {
  std::string text = fmt::format("{:>14}", "");
  for (const TimelineCurve& curve : timeline.curves) {
    std::string name = curve.strategy;
    if (name == "every") name = fmt::format("rebuild every {}", timeline.update.every);
    if (name == "growth") name = fmt::format("rebuild at growth {}", timeline.update.growth);
    text += fmt::format(" |{:^36}", name);
  }
  text += fmt::format("\n{:>6}{:>8}", "frame", "time s");
  for (size_t i = 0; i < timeline.curves.size(); ++i)
    text += fmt::format(" |{:>8}{:>9}{:>9}{:>10}", "SAH", "nodes", "tree ms", "frame ms");
  text += '\n';
  const size_t count = timeline.curves.empty() ? 0 : timeline.curves[0].samples.size();
  for (size_t i = 0; i < count; ++i) {
    const TimelineSample& first = timeline.curves[0].samples[i];
    text += fmt::format("{:>6}{:>8.2f}", first.frame, first.time);
    for (const TimelineCurve& curve : timeline.curves) {
      const TimelineSample& sample = curve.samples[i];
      text += fmt::format(" |{:>8.2f}{:>9.2f}{:>9.2f}{:>10.2f}", sample.sah, sample.nodes_per_ray,
                          sample.tree_ms(), sample.frame_ms());
    }
    text += '\n';
  }
  text += fmt::format(
      "\nnodes: inner nodes that a primary ray visits on average. tree ms: refit, build and top "
      "level.\nframe ms: deformation, trees and one sample a pixel of a picture of {} x {}.\n{}\n",
      timeline.options.width, timeline.options.height, break_even_text(timeline));
  return text;
}

}  // namespace tracer
