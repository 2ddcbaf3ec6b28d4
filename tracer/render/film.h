// The film holds facts, colours are a view of them. It is a grid of immutable tiles, so that a
// snapshot of it is a copy of pointers and can be read while the next pass is being traced.
#pragma once

#include <memory>
#include <vector>

#include "tracer/bvh/counters.h"
#include "tracer/math/ray.h"

namespace tracer {

inline constexpr int tile_size = 64;  // pixels

// What pass 0 found, at one sample every `stride` pixels (8, 4, 2, then 1), through the centre of
// the block's upper left pixel.
struct TileFacts {
  int stride = 1;
  int columns = 0;  // samples in a row
  int rows = 0;
  std::vector<Hit> hits;                // columns * rows
  std::vector<ClassCounters> counters;  // columns * rows
  std::vector<uint8_t> depth;           // bounces the deepest ray of the sample reached
  std::vector<vec3> radiance;           // linear, of pass 0
};

struct FilmTile {
  std::shared_ptr<const TileFacts> facts;
  std::vector<vec3> sum;  // radiance of all passes, a pixel; empty after pass 0
  int samples = 1;        // passes in it
};

struct Film {
  int width = 0;
  int height = 0;
  std::vector<std::shared_ptr<const FilmTile>> tiles;  // row by row; nullptr: nothing there yet
};

inline int tile_columns(int width) {
  return (width + tile_size - 1) / tile_size;
}

// One pixel's facts; nothing if its tile has none yet or the pixel is outside.
struct PixelFacts {
  const Hit* hit = nullptr;
  const ClassCounters* counters = nullptr;
  int depth = 0;
  vec3 radiance{0.0f};  // the mean over the passes
};
PixelFacts pixel(const Film& film, int x, int y);

// Of one sample of a tile that has facts: the mean over the passes. After pass 0 the samples are
// the pixels.
inline vec3 radiance_at(const FilmTile& tile, size_t sample) {
  return tile.sum.empty() ? tile.facts->radiance[sample] : tile.sum[sample] / float(tile.samples);
}

}  // namespace tracer
