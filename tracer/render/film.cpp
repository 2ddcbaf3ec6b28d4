// Reading one pixel of the film.
#include "tracer/render/film.h"

namespace tracer {

PixelFacts pixel(const Film& film, int x, int y) {
  if (x < 0 || y < 0 || x >= film.width || y >= film.height) return {};
  const size_t index = size_t(y / tile_size) * tile_columns(film.width) + x / tile_size;
  if (index >= film.tiles.size() || !film.tiles[index] || !film.tiles[index]->facts) return {};
  const TileFacts& facts = *film.tiles[index]->facts;
  const int row = y % tile_size / facts.stride;
  const int column = x % tile_size / facts.stride;
  const size_t sample = size_t(row) * facts.columns + column;
  return {&facts.hits[sample], &facts.counters[sample], facts.depth[sample],
          radiance_at(*film.tiles[index], sample)};
}

}  // namespace tracer
