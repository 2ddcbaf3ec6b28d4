// Whole passes over a film.
#include "tracer/render/passes.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace tracer {
namespace {

using Tracers = tbb::enumerable_thread_specific<Whitted>;

// function(tile, whitted) for all tiles in parallel.
template <class Function>
void for_tiles(const Film& film, Tracers& tracers, const std::stop_token& stop,
               const Function& function) {
  tbb::parallel_for(
      size_t{0}, film.tiles.size(),
      [&](size_t tile) {
        if (!stop.stop_requested()) function(int(tile), tracers.local());
      },
      tbb::simple_partitioner{});
}

}  // namespace

Film first_pass(const World& world, const CameraFrame& camera, const std::stop_token& stop) {
  Film film = empty_film(world.options.width, world.options.height);
  Tracers tracers;
  for_tiles(film, tracers, stop, [&](int tile, Whitted& whitted) {
    film.tiles[tile] = trace_first_pass(world, camera, tile, 1, nullptr, whitted);
  });
  return film;
}

RayRates next_pass(const World& world, const CameraFrame& camera, Film& film,
                   const std::stop_token& stop) {
  Tracers tracers;
  for_tiles(film, tracers, stop, [&](int tile, Whitted& whitted) {
    film.tiles[tile] = trace_next_pass(world, camera, tile, *film.tiles[tile], whitted);
  });
  RayRates rates{};
  for (const Whitted& whitted : tracers) {
    for (size_t i = 0; i < rates.size(); ++i)
      rates[i] += whitted.rates()[i];
  }
  return rates;
}

}  // namespace tracer
