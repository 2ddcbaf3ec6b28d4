// Builders: from boxes to a binary BVH. One builder serves triangles (BLAS) and instances (TLAS).
#pragma once

#include <atomic>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>

#include "tracer/bvh/bvh.h"

namespace tracer {

// SAH, the surface area heuristic (MacDonald and Booth 1990; constants as in Aila et al. 2013): the
// expected cost of a random ray that does not stop, in units of triangle tests.
struct BuildOptions {
  std::string builder = "binned";  // id of a BuilderRow
  std::string optimizer = "none";  // id of an OptimizerRow: what is done to the tree afterwards
  uint32_t bins = 32;              // per axis, 2..256
  uint32_t max_leaf_size = 4;      // 1..64 references
  uint32_t max_depth = 64;         // 1..96 edges; deeper nodes become leaves
  float traversal_cost = 1.2f;     // Ct: one inner node, that is two box tests
  float intersection_cost = 1.0f;  // Ci: one triangle test
  uint32_t search_radius = 14;     // of PLOC, in clusters, 1..128
  bool collapse = true;            // subtrees that SAH would rather have as leaves; only trees of
                                   // single primitives and optimised ones have any

  bool operator==(const BuildOptions&) const = default;
};

inline constexpr uint32_t max_bins = 256;
inline constexpr uint32_t max_tree_depth = 96;
inline constexpr uint32_t max_leaf_references = 64;
inline constexpr uint32_t max_search_radius = 128;
inline constexpr float min_cost = 0.01f, max_cost = 100.0f;  // Ct and Ci

struct BuildInput {
  std::span<const Box> boxes;  // finite, not empty
};

// What a running build tells to others.
struct BuildLog {
  std::atomic<uint64_t> placed{0};  // references that are in a leaf by now
};

struct BuilderRow {
  std::string_view id, label, help, paper;
  Bvh (*build)(const BuildInput&, const BuildOptions&, BuildLog*, std::stop_token);
  bool uses_bins = false, uses_search_radius = false;  // which of the options it reads
  bool single_primitives = false;                      // leaves of one primitive, to be collapsed
};

std::span<const BuilderRow> builders();

// Lowers the SAH of a finished tree over these boxes.
struct OptimizerRow {
  std::string_view id, label, help, paper;
  void (*optimize)(Bvh&, const BuildOptions&, const std::stop_token&);  // nullptr: nothing
};

std::span<const OptimizerRow> optimizers();

// Throws Error for an unknown builder (naming the known ones) or an option outside its range.
void check(const BuildOptions& options);

// Runs the chosen builder. Deterministic for any number of threads. A stopped build returns an
// empty BVH.
Bvh build(const BuildInput& input, const BuildOptions& options, BuildLog* log,
          std::stop_token stop);

}  // namespace tracer
