// Builders: from boxes to a binary BVH. One builder serves triangles (BLAS) and instances (TLAS).
#pragma once

#include <atomic>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>

#include "tracer/bvh/bvh.h"
#include "tracer/scene/mesh.h"

namespace tracer {

// SAH, the surface area heuristic (MacDonald and Booth 1990; constants as in Aila et al. 2013): the
// expected cost of a random ray that does not stop, in units of triangle tests.
struct BuildOptions {
  std::string builder = "binned";    // id of a BuilderRow
  std::string optimizer = "none";    // id of an OptimizerRow: what is done to the tree afterwards
  uint32_t bins = 32;                // per axis, 2..256
  uint32_t max_leaf_size = 4;        // 1..64 references
  uint32_t max_depth = 64;           // 1..96 edges; deeper nodes become leaves
  float traversal_cost = 1.2f;       // Ct: one inner node, that is two box tests
  float intersection_cost = 1.0f;    // Ci: one triangle test
  uint32_t search_radius = 14;       // of PLOC, in clusters, 1..128
  bool collapse = true;              // subtrees that SAH would rather have as leaves; only trees of
                                     // single primitives and optimised ones have any
  float reinsertion_share = 0.03f;   // of the nodes, in each round, 0.001..1
  uint32_t reinsertion_rounds = 8;   // 1..100
  bool presplit = false;             // large diagonal triangles become several references first
  float split_budget = 0.3f;         // references that splitting may add, a triangle, 0..4
  float min_overlap = 1e-5f;         // of the children of an object split, as a share of the root's
                                     // area, from which on space is split instead, 0..1
  bool rebraid = false;              // the TLAS refers to parts of instances where these fit better
  std::string layout = "binary";     // id of a LayoutRow: how the traversal stores the tree
  std::string widening = "optimal";  // id of a WideningRow: which nodes a wide layout keeps
  std::string occlusion_order = "tree";  // id of an OcclusionOrderRow: of a wide node's children

  bool operator==(const BuildOptions&) const = default;
};

inline constexpr uint32_t max_bins = 256;
inline constexpr uint32_t max_tree_depth = 96;
inline constexpr uint32_t max_leaf_references = 64;
inline constexpr uint32_t max_search_radius = 128;
inline constexpr float min_reinsertion_share = 0.001f;
inline constexpr uint32_t max_reinsertion_rounds = 100;
inline constexpr float max_split_budget = 4.0f;
inline constexpr float min_cost = 0.01f, max_cost = 100.0f;  // Ct and Ci

struct BuildInput {
  std::span<const Box> boxes;  // finite, not empty
  // Where boxes may be split further: the mesh, and which triangle a box is of (its own number if
  // there are none). Without a mesh nothing is split.
  const Mesh* mesh = nullptr;
  std::span<const uint32_t> primitives = {};
};

inline uint32_t primitive_of(const BuildInput& input, uint32_t box) {
  return input.primitives.empty() ? box : input.primitives[box];
}

struct BuildSteps;  // build_steps.h

// What a running build tells to others.
struct BuildLog {
  std::atomic<uint64_t> placed{0};     // references that are in a leaf by now
  std::atomic<uint64_t> optimized{0};  // of the trees that the optimizer is through with, in parts
  BuildSteps* steps = nullptr;         // of one tree; nullptr: nobody wants to know
};

// Which of the options a builder reads, and what it makes.
struct BuilderTraits {
  bool bins = false;
  bool search_radius = false;
  bool splits_space = false;
  bool single_primitives = false;  // leaves of one primitive, to be collapsed
  bool bottom_up = false;          // merges boxes; the others split them
  bool collapses = false;          // unless an optimizer comes first, it does so itself
};

struct BuilderRow {
  std::string_view id, label, help, paper;
  Bvh (*build)(const BuildInput&, const BuildOptions&, BuildLog*, std::stop_token);
  BuilderTraits traits = {};
};

std::span<const BuilderRow> builders();

// Lowers the SAH of a finished tree over these boxes.
struct OptimizerRow {
  std::string_view id, label, help, paper;
  void (*optimize)(Bvh&, const BuildOptions&, BuildLog*, const std::stop_token&);  // or nullptr
  bool reinserts = false;  // reads the options of reinsertion
};

std::span<const OptimizerRow> optimizers();

// Layouts: how the traversal stores the tree.
struct LayoutRow {
  std::string_view id, label, help, paper;
  int width = 2;  // children of a node, at most
  bool quantised = false;
};
std::span<const LayoutRow> layouts();

// How the nodes that a wide layout keeps of the binary tree are chosen.
struct WideningRow {
  std::string_view id, label, help, paper;
};
std::span<const WideningRow> widenings();

// Which child of a wide node shadow rays visit first.
struct OcclusionOrderRow {
  std::string_view id, label, help, paper;
};
std::span<const OcclusionOrderRow> occlusion_orders();

// Throws Error for an unknown builder (naming the known ones) or an option outside its range.
void check(const BuildOptions& options);

// Runs the chosen builder over the boxes, or their parts, and the optimizer. References are
// primitives; with split ones there are more of them than boxes, each once a leaf at most.
// Deterministic for any number of threads. A stopped build returns an empty BVH.
Bvh build(const BuildInput& input, const BuildOptions& options, BuildLog* log,
          std::stop_token stop);

}  // namespace tracer
