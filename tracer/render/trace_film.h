// Filling the film, tile by tile and pass by pass.
#pragma once

#include "tracer/render/film.h"
#include "tracer/render/whitted.h"

namespace tracer {

inline constexpr int coarsest_stride = 8;  // pass 0 goes 8, 4, 2, 1

// A film without content, and what a full one takes.
Film empty_film(int width, int height);
uint64_t film_bytes(int width, int height);

// Pass 0 of one tile, at every stride-th pixel, counting. Takes over the samples of `coarser`, the
// same tile at twice the stride (nullptr: none).
std::shared_ptr<const FilmTile> trace_first_pass(const World& world, const CameraFrame& camera,
                                                 int tile, int stride, const FilmTile* coarser,
                                                 Whitted& whitted);

// One more sample for each pixel of a tile whose pass 0 is complete; counts nothing.
std::shared_ptr<const FilmTile> trace_next_pass(const World& world, const CameraFrame& camera,
                                                int tile, const FilmTile& before, Whitted& whitted);

// Where sample `index` of every pixel lies in it, 0..1; sample 0 is the centre.
// M. Roberts, The Unreasonable Effectiveness of Quasirandom Sequences (R2), 2018.
vec2 sample_position(int index);

}  // namespace tracer
