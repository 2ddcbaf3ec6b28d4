// Where we differ from the paper: a triangle's priority is the cube root of the square of its
// length times the area that splitting could save, and planes come from a cubic grid.
#include "tracer/bvh/presplit.h"

#include <bit>
#include <cmath>

#include "tracer/bvh/clip.h"

namespace tracer {

namespace {

constexpr uint32_t max_splits = 63;  // of one triangle
constexpr float grid_cells = 1 << 20;

// Cubic cells over the whole mesh. Planes with a larger power of two in their index come first:
// they are where a builder is likely to cut.
struct Grid {
  float4 lo;
  float cell;

  // The upper border belongs to the last cell.
  uint32_t cell_of(float at, int axis) const {
    return static_cast<uint32_t>(std::min((at - lo[axis]) / cell, grid_cells - 1.0f));
  }

  struct Plane {
    int axis = -1;  // -1: the box lies within one cell
    float at = 0.0f;
  };
  Plane best_plane(const Bounds& box) const {
    Plane best;
    int best_level = 0;
    float best_size = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      const uint32_t from = cell_of(box.lo[axis], axis), to = cell_of(box.hi[axis], axis);
      const int level = std::bit_width(from ^ to);
      const float size = box.hi[axis] - box.lo[axis];
      if (level == 0 || level < best_level || (level == best_level && size <= best_size)) continue;
      const uint32_t index = to >> (level - 1) << (level - 1);
      const float at = lo[axis] + cell * static_cast<float>(index);
      if (!(at > box.lo[axis] && at < box.hi[axis])) continue;
      best = {axis, at};
      best_level = level;
      best_size = size;
    }
    return best;
  }
};

Bounds bounds_of(const Box& box) {
  return {float4{box.lo.x, box.lo.y, box.lo.z, 0.0f}, float4{box.hi.x, box.hi.y, box.hi.z, 0.0f}};
}

float longest(const Bounds& box) {
  const int axis = longest_axis(box);
  return box.hi[axis] - box.lo[axis];
}

// Half the area of the boxes of infinitely many pieces.
float ideal_half_area(const Corners& corners) {
  const vec3 a = xyz(corners.a);
  const vec3 sides = glm::abs(glm::cross(xyz(corners.b) - a, xyz(corners.c) - a));
  return 0.5f * (sides.x + sides.y + sides.z);
}

uint32_t splits_at(float priority, float factor) {
  return static_cast<uint32_t>(std::min(priority * factor, static_cast<float>(max_splits)));
}

class Presplitter {
 public:
  Presplitter(const Mesh& mesh, std::span<const Box> boxes, float most_filled)
      : mesh_(mesh), boxes_(boxes) {
    Box all;
    for (const Box& box : boxes)
      all = united(all, box);
    const vec3 size = extent(all);
    grid_ = {bounds_of(all).lo, std::max(size.x, std::max(size.y, size.z)) / grid_cells};
    priorities_.resize(boxes.size());
    const auto count = static_cast<uint32_t>(boxes.size());
    for_chunks(0, count, [&](size_t, uint32_t begin, uint32_t end) {
      for (uint32_t i = begin; i < end; ++i) {
        const Bounds box = bounds_of(boxes_[i]);
        const float length = longest(box);
        const float area = half_area(box);
        const float ideal = ideal_half_area(corners_of(mesh_, i));
        const float saved = ideal <= most_filled * area ? std::max(area - ideal, 0.0f) : 0.0f;
        // The areas of large scenes overflow when they are multiplied.
        priorities_[i] = std::cbrt(length) * std::cbrt(length) * std::cbrt(saved);
      }
    });
  }

  // The largest factor that spends at most the budget.
  float factor_for(uint64_t budget) const {
    float largest = 0.0f;
    for (const float priority : priorities_)
      largest = std::max(largest, priority);
    if (!(largest > 0.0f) || !std::isfinite(1.0f / largest)) return 0.0f;
    float lo = 0.0f, hi = static_cast<float>(max_splits + 1) / largest;
    while (splits(hi) < budget && hi < 1e30f / largest)
      hi *= 2.0f;
    for (int step = 0; step < 24; ++step) {
      const float middle = 0.5f * (lo + hi);
      (splits(middle) <= budget ? lo : hi) = middle;
    }
    return lo;
  }

  SplitBoxes split(float factor, const std::stop_token& stop) const {
    const auto count = static_cast<uint32_t>(boxes_.size());
    std::vector<SplitBoxes> pieces((count + chunk_size - 1) / chunk_size);
    for_chunks(0, count, [&](size_t chunk, uint32_t begin, uint32_t end) {
      for (uint32_t i = begin; i < end && !stop.stop_requested(); ++i) {
        split(corners_of(mesh_, i), bounds_of(boxes_[i]), splits_at(priorities_[i], factor),
              pieces[chunk].boxes);
        pieces[chunk].primitives.resize(pieces[chunk].boxes.size(), i);
      }
    });
    SplitBoxes all;
    for (const SplitBoxes& piece : pieces) {
      all.boxes.insert(all.boxes.end(), piece.boxes.begin(), piece.boxes.end());
      all.primitives.insert(all.primitives.end(), piece.primitives.begin(), piece.primitives.end());
    }
    return all;
  }

 private:
  uint64_t splits(float factor) const {
    const auto count = static_cast<uint32_t>(priorities_.size());
    std::vector<uint64_t> sums((count + chunk_size - 1) / chunk_size);
    for_chunks(0, count, [&](size_t chunk, uint32_t begin, uint32_t end) {
      uint64_t sum = 0;
      for (uint32_t i = begin; i < end; ++i)
        sum += splits_at(priorities_[i], factor);
      sums[chunk] = sum;
    });
    uint64_t sum = 0;
    for (const uint64_t piece : sums)
      sum += piece;
    return sum;
  }

  // `splits` more cuts of the part of a triangle in `box`, shared out by the length of the pieces.
  void split(const Corners& corners, const Bounds& box, uint32_t splits,
             std::vector<Box>& out) const {
    const Grid::Plane plane = splits > 0 ? grid_.best_plane(box) : Grid::Plane{};
    if (plane.axis < 0) {
      out.push_back({xyz(box.lo), xyz(box.hi)});
      return;
    }
    const Clipped parts = clip(corners, box, plane.axis, plane.at);
    if (is_empty(parts.left) || is_empty(parts.right)) {
      const Bounds& rest = is_empty(parts.left) ? parts.right : parts.left;
      // Rounding has left nothing on either side: keep what there was.
      split(corners, is_empty(rest) ? box : rest, is_empty(rest) ? 0 : splits - 1, out);
      return;
    }
    const float left = longest(parts.left), right = longest(parts.right);
    const float share = static_cast<float>(splits - 1) * left / (left + right);
    const uint32_t left_splits = std::min(static_cast<uint32_t>(share + 0.5f), splits - 1);
    split(corners, parts.left, left_splits, out);
    split(corners, parts.right, splits - 1 - left_splits, out);
  }

  const Mesh& mesh_;
  std::span<const Box> boxes_;
  Grid grid_{};
  std::vector<float> priorities_;
};

}  // namespace

SplitBoxes presplit(const Mesh& mesh, std::span<const Box> boxes, float budget, float most_filled,
                    const std::stop_token& stop) {
  const Presplitter presplitter(mesh, boxes, most_filled);
  const double most = static_cast<double>(budget) * static_cast<double>(boxes.size());
  return presplitter.split(presplitter.factor_for(static_cast<uint64_t>(most)), stop);
}

}  // namespace tracer
