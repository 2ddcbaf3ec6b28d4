// The functions behind the rows of builtin.cpp, one a file. `values` are in the order of the row's
// parameters, whole numbers inside their ranges. A stopped job throws Error.
#pragma once

#include <span>

#include "tracer/scene/scene.h"

namespace tracer {

Scene make_teapots(std::span<const double> values, const Job& job);
Scene make_showcase(std::span<const double> values, const Job& job);
Scene make_massive(std::span<const double> values, const Job& job);
Scene make_sticks(std::span<const double> values, const Job& job);
Scene make_needles(std::span<const double> values, const Job& job);
Scene make_stadium(std::span<const double> values, const Job& job);
Scene make_stacked(std::span<const double> values, const Job& job);
Scene make_hairball(std::span<const double> values, const Job& job);
Scene make_terrain(std::span<const double> values, const Job& job);

}  // namespace tracer
