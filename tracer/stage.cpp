// The table of what each edit makes stale.
#include "tracer/stage.h"

namespace tracer {

std::string_view name(Stage stage) {
  constexpr std::string_view names[] = {"load",   "build",  "refit", "top level",
                                        "render", "refine", "done"};
  return names[static_cast<size_t>(stage)];
}

Stage first_stale(const Settings& was, const Settings& now) {
  if (was.source != now.source) return Stage::load;
  BuildOptions trees = now.build;
  trees.rebraid = was.build.rebraid;  // of the top level alone
  if (was.build != trees) return Stage::build;
  if (is_active(was.deformer) || is_active(now.deformer)) {
    const bool moves = is_moving(now.deformer) && was.time != now.time;
    if (was.deformer != now.deformer || was.update != now.update || moves) {
      return now.update.strategy == "rebuild" ? Stage::build : Stage::refit;
    }
  }
  if (was.time != now.time || was.motion != now.motion || was.build != now.build) {
    return Stage::top_level;
  }
  RenderOptions more = was.render;
  more.samples = now.render.samples;
  if (was.look != now.look || more != now.render || now.render.samples < was.render.samples) {
    return Stage::render;
  }
  if (now.render.samples > was.render.samples) return Stage::refine;
  return Stage::none;
}

}  // namespace tracer
