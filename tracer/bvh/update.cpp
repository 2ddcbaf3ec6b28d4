// The update strategies.
#include "tracer/bvh/update.h"

#include <fmt/format.h>

#include "tracer/choice.h"
#include "tracer/error.h"

namespace tracer {
namespace {

constexpr UpdateRow rows[] = {
    {"refit", "Refit",
     "Keep the trees that were built over the meshes at rest and give their nodes new boxes: the "
     "cheapest update; the trees get worse the more the shape changes"},
    {"rebuild", "Rebuild",
     "Build the trees anew in each frame: the best trees at the highest price"},
    {"every", "Rebuild every N", "Build anew in frame 0, N, 2 N ... and refit that tree in between",
     true},
    {"growth", "Rebuild on growth",
     "Refit until the SAH is F times what it was after the build, then build anew; begins with the "
     "tree at rest whenever a swing of the deformer begins",
     false, true},
};

template <class Value>
void check_range(std::string_view option, Value value, Value lo, Value hi) {
  // Written so that NaN is outside.
  if (!(value >= lo && value <= hi)) {
    throw Error(fmt::format("{} {} is outside {}..{}", option, value, lo, hi));
  }
}

}  // namespace

std::span<const UpdateRow> updates() {
  return rows;
}

void check(const UpdateOptions& options) {
  if (!find_row(updates(), options.strategy)) {
    throw Error(fmt::format("unknown update strategy '{}'; known: {}", options.strategy,
                            known_ids(updates())));
  }
  check_range("frames between builds", options.every, 1u, max_every);
  check_range("growth", options.growth, min_growth, max_growth);
  check_range("frame rate", options.frames_per_second, 1.0f, max_frame_rate);
}

}  // namespace tracer
