// The stages of the pipeline, and which of them an edit makes stale.
#pragma once

#include <string_view>

#include "tracer/settings.h"

namespace tracer {

enum class Stage { load, build, refit, top_level, render, refine, none };
inline constexpr int stage_count = 6;  // without none
std::string_view name(Stage stage);

// The first stage whose result an edit makes stale; later ones are stale too.
Stage first_stale(const Settings& was, const Settings& now);

}  // namespace tracer
