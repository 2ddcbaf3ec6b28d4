// Partial re-braiding: where one box is much too large for an instance, the TLAS refers to nodes of
// its BLAS in place of the root, and rays that reach one go on from there.
// C. Benthin, S. Woop, I. Wald, A. Afra, Improved Two-Level BVHs using Partial Re-Braiding, 2017.
// Where we differ: the paper opens instances that are large beside those around them; we open what
// has less surface in parts. Rays pay for each part that they enter: by the paper's rule they
// visited up to a quarter more nodes of the built-in scenes, where nothing is to be gained.
#pragma once

#include <span>
#include <vector>

#include "tracer/bvh/scene_bvh.h"

namespace tracer {

inline constexpr uint32_t rebraid_budget = 16;  // parts an instance, as the mean of all

// What a TLAS is built over: parts of instances, and the boxes of these in the world.
struct TlasInput {
  std::vector<uint32_t> instances;
  std::vector<EntryPoint> entries;  // empty: every instance is whole
  std::vector<Box> boxes;
};

// By the options of the BVH, whose instances are placed and whose BLASes are there. The entries of
// an instance hold every reference of its BLAS once. Deterministic for any number of threads.
TlasInput tlas_input(const SceneBvh& bvh);

// The boxes in the world of instances from these nodes of their BLASes on; no looser than those of
// tlas_input.
std::vector<Box> part_boxes(const SceneBvh& bvh, std::span<const uint32_t> instances,
                            std::span<const uint32_t> nodes);

}  // namespace tracer
