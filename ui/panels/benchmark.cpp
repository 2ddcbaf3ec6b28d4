// Build times and rays a second beside a peer: what is measured, and how it is shown.
#include "ui/benchmark.h"

#include <algorithm>

#include <fmt/format.h>

#include "tracer/bvh/ray_kernels.h"
#include "ui/panels.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using Ids = std::set<std::string, std::less<>>;

constexpr int quick_turns = 3, quick_width = 640, quick_height = 360;

template <class Row>
void ticks(const char* title, Ids& ids, std::span<const Row> rows, bool inverted) {
  const Scope scope(title);
  ImGui::BeginGroup();
  heading(title);
  for (const Row& row : rows)
    tick(ids, row.id, row.label, row.help, inverted);
  ImGui::EndGroup();
  ImGui::SameLine(0, 2.0f * em());
}

void draw_choices(Frame& frame) {
  BenchmarkState& state = frame.state.benchmark;
  const Scope scope("choice");
  ticks("Builders", state.builders, tracer::builders(), false);
  ticks("Layouts", state.left_out, tracer::layouts(), true);
  ticks("Kernels", state.left_out, tracer::ray_kernels(), true);
  ticks("Rays", state.left_out, tracer::ray_set_rows(), true);
  ImGui::BeginGroup();
  heading("How");
  tick("One thread", state.one_thread, "Measured by the processor time of the thread");
  tick("All threads", state.all_threads, "Measured by the clock on the wall");
  tick("Quick", state.quick,
       "3 turns and views of 640 x 360 pixels; without it 5 turns and 1280 x 720");
  tick("One mesh", state.flatten,
       "All instances become one mesh in the world, so that trees of triangles are compared "
       "and not how instances are entered");
  tick("Fast tests", state.fast,
       "Beside the watertight kernels those with quicker tests, which rays may slip through at "
       "edges: ours by Möller and Trumbore, the peer's when it need not be robust");
  ImGui::EndGroup();
  hint("Without a builder ticked: the one of the Build panel. All builds have its options.");
}

bool is_complete(const tracer::BenchmarkOptions& options) {
  const auto has_kernel = [&](const std::string& layout) {
    return !chosen_kernels(options, layout).empty();
  };
  return !options.threads.empty() &&
         std::any_of(options.layouts.begin(), options.layouts.end(), has_kernel);
}

void draw_running(Frame& frame) {
  const auto& work = frame.work.benchmark;
  const std::string text = fmt::format("{}  {:.0f} %", work.doing, 100.0f * work.fraction);
  const float width = std::max(22.0f * em(), ImGui::CalcTextSize(text.c_str()).x + 2.0f * em());
  ImGui::ProgressBar(work.fraction, {width, 0}, text.c_str());
  mark("progress");
  tooltip("All ways to trace take turns; the picture rests so as not to spoil the times");
  ImGui::SameLine();
  if (button("Cancel", "Stop; what has been measured stays"))
    frame.requests.cancel_benchmark = true;
}

void draw_run(Frame& frame) {
  BenchmarkRequest wanted = wanted_benchmark(frame);
  if (button("Run", "Build the scene and trace it in every chosen way, in turns")) {
    if (is_complete(wanted.options)) {
      frame.requests.benchmark = std::move(wanted);
    } else {
      ImGui::OpenPopup("nothing chosen");
    }
  }
  ImGui::SameLine();
  if (button("Choose...", "Builders, layouts, kernels, classes of rays, threads"))
    ImGui::OpenPopup("choice");
  if (ImGui::BeginPopup("choice")) {
    draw_choices(frame);
    ImGui::EndPopup();
  }
  if (ImGui::BeginPopup("nothing chosen")) {
    hint("Tick at least a layout, a kernel that it has, and a number of threads: Choose...");
    mark("nothing chosen");
    ImGui::EndPopup();
  }
}

void draw_filters(BenchmarkState& state) {
  static constexpr Choice shown[] = {
      {"rays", "Rays", "Millions of rays a second"},
      {"builds", "Builds", "Build times"},
  };
  static constexpr Choice threads[] = {
      {"all", "All", "Every number of threads"},
      {"one", "One", "One thread"},
      {"several", "Several", "More than one thread"},
  };
  std::vector<Choice> classes = {{"all", "All", "Every class of rays"}};
  for (const tracer::RaySetRow& row : tracer::ray_set_rows())
    classes.push_back({row.id, row.label, row.help});
  const auto filter = [](const char* label, std::string& id, std::span<const Choice> choices,
                         const char* help) {
    ImGui::SameLine(0, 1.5f * em());
    ImGui::BeginChild(label, {14.0f * em(), ImGui::GetFrameHeight()});
    combo(label, id, choices, help);
    ImGui::EndChild();
  };
  filter("Show", state.shown, shown, "What the table lists");
  if (state.shown == "rays")
    filter("Class", state.shown_class, std::span<const Choice>(classes), "Which rays");
  filter("Threads", state.shown_threads, threads, "Measured with how many threads");
}

void draw_news(const Frame& frame, const tracer::Benchmark* benchmark) {
  if (!frame.work.benchmark.error.empty()) {
    ImGui::TextWrapped("%s", frame.work.benchmark.error.c_str());
    mark("error");
  }
  if (benchmark == nullptr) return;
  for (const std::string& fault : benchmark->faults) {
    ImGui::TextWrapped("Different answers: %s", fault.c_str());
    mark("fault");
  }
}

}  // namespace

BenchmarkRequest wanted_benchmark(const Frame& frame) {
  const BenchmarkState& state = frame.state.benchmark;
  const tracer::BuildOptions& present = frame.edited.settings.build;
  BenchmarkRequest wanted;
  tracer::BenchmarkOptions& options = wanted.options;
  options.builds.clear();
  for (const tracer::BuilderRow& row : tracer::builders()) {
    if (!state.builders.contains(row.id)) continue;
    options.builds.push_back(present);
    options.builds.back().builder = row.id;
  }
  if (options.builds.empty()) options.builds.push_back(present);
  const auto chosen = [&](const auto rows) {
    std::vector<std::string> ids;
    for (const auto& row : rows)
      if (!state.left_out.contains(row.id)) ids.emplace_back(row.id);
    return ids;
  };
  options.layouts = chosen(tracer::layouts());
  options.kernels = chosen(tracer::ray_kernels());
  options.classes = chosen(tracer::ray_set_rows());
  options.rays = !options.classes.empty();
  options.threads.clear();
  for (const int threads : tracer::usual_threads()) {
    if (threads == 1 ? state.one_thread : state.all_threads) options.threads.push_back(threads);
  }
  if (state.quick) {
    options.turns = quick_turns;
    options.width = quick_width;
    options.height = quick_height;
  }
  options.fast = state.fast;
  wanted.flatten = state.flatten;
  return wanted;
}

void draw_benchmark(Frame& frame) {
  if (!frame.snapshot.bvh) {
    hint("There is something to measure once a scene is there: File > Open scene...");
    return;
  }
  BenchmarkState& state = frame.state.benchmark;
  const auto& result = frame.work.benchmark.result;
  if (frame.work.benchmark.running) {
    draw_running(frame);
  } else {
    draw_run(frame);
  }
  draw_filters(state);
  draw_news(frame, result.get());
  if (!frame.work.missing_peers.empty()) {
    hint(frame.work.missing_peers);
    mark("missing peers");
  }
  if (!result || (result->builds.empty() && result->rays.empty())) {
    hint(
        "Run builds this scene in every layout and traces five classes of rays from the camera and "
        "from inside the scene, with every kernel and beside Embree in turns. The picture rests "
        "meanwhile; figures are worth most while the machine does nothing else. "
        "`bvhscope bench` does the same on the command line.");
    mark("empty");
    return;
  }
  if (state.shown == "builds") {
    draw_build_timings(frame, *result);
  } else {
    draw_ray_timings(frame, *result);
  }
}

}  // namespace ui
