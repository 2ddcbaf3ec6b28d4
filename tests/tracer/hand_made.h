// A small film and scene made by hand, for tests of what is shown of them.
#pragma once

#include <functional>

#include "tracer/pipeline.h"
#include "tracer/render/trace_film.h"

namespace tracer {

// What a test says about the pixel at x, y; the rest is the default.
struct PixelContent {
  Hit hit;
  ClassCounters counters{};
  uint8_t depth = 0;
  vec3 radiance{0.0f};
};
using Content = std::function<PixelContent(int x, int y)>;

// A film whose tiles have one sample every `stride` pixels.
inline Film hand_made_film(int width, int height, const Content& content, int stride = 1) {
  Film film = empty_film(width, height);
  for (size_t tile = 0; tile < film.tiles.size(); ++tile) {
    const int x0 = int(tile) % tile_columns(width) * tile_size;
    const int y0 = int(tile) / tile_columns(width) * tile_size;
    TileFacts facts;
    facts.stride = stride;
    for (int y = y0; y < std::min(y0 + tile_size, height); y += stride) {
      ++facts.rows;
      facts.columns = 0;
      for (int x = x0; x < std::min(x0 + tile_size, width); x += stride) {
        ++facts.columns;
        const PixelContent pixel = content(x, y);
        facts.hits.push_back(pixel.hit);
        facts.counters.push_back(pixel.counters);
        facts.depth.push_back(pixel.depth);
        facts.radiance.push_back(pixel.radiance);
      }
    }
    FilmTile made;
    made.facts = std::make_shared<const TileFacts>(std::move(facts));
    film.tiles[tile] = std::make_shared<const FilmTile>(std::move(made));
  }
  return film;
}

inline PixelContent pixel_of(const Hit& hit) {
  PixelContent pixel;
  pixel.hit = hit;
  return pixel;
}

inline PixelContent pixel_of(RayClass ray_class, const Counters& counters) {
  PixelContent pixel;
  pixel.counters[int(ray_class)] = counters;
  return pixel;
}

// One triangle in the plane z = 0 that covers the picture of a camera on +z, seen from the front:
// corners (-10,-10,0), (10,-10,0), (0,20,0), uv 0..1. The film is empty.
inline Snapshot hand_made_snapshot() {
  auto scene = std::make_shared<Scene>();
  Mesh mesh;
  mesh.positions = {{-10, -10, 0}, {10, -10, 0}, {0, 20, 0}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  mesh.triangles = {{0, 1, 2}};
  mesh.materials = {0};
  scene->meshes = {mesh};
  scene->instances.resize(1);
  scene->materials.resize(1);

  BvhNode leaf;
  leaf.lo = {-10, -10, 0};
  leaf.hi = {10, 20, 0};
  leaf.count = 1;
  auto blas = std::make_shared<Blas>();
  blas->tree = {{leaf}, {0}, 0};
  auto bvh = std::make_shared<SceneBvh>();
  bvh->blases = {blas};
  bvh->tlas = blas->tree;
  bvh->instances.resize(1);

  Snapshot snapshot;
  snapshot.scene = scene;
  snapshot.bvh = bvh;
  snapshot.settings.look = look_of(*scene);
  snapshot.settings.look->camera = Camera{};  // at (0, 0, 5), looks at the origin
  return snapshot;
}

inline Hit triangle_hit(float u = 0.25f, float v = 0.25f) {
  return {5.0f, u, v, 0, 0};
}

}  // namespace tracer
