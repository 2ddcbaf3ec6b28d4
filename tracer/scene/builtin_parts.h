// What several built-in scenes are put together from.
#pragma once

#include <functional>
#include <string_view>

#include "tracer/scene/scene.h"

namespace tracer {

// Loads an image of the assets folder into the scene and returns its index. If that fails, warns
// and returns `none`: the material then shows its plain albedo.
uint32_t add_asset_texture(Scene& scene, std::string_view file);
// The daylight sky of the assets folder; if that fails, warns, and the sky is one flat colour.
void add_daylight(Scene& scene);

uint32_t add_material(Scene& scene, const Material& material);
uint32_t add_matt(Scene& scene, const char* name, vec3 albedo);
uint32_t add_bricks(Scene& scene);  // with the texture of the assets folder
uint32_t add_mirror(Scene& scene);
// Eight muted colours that are told apart easily; returns the index of the first.
uint32_t add_palette(Scene& scene);
inline constexpr uint32_t palette_size = 8;

// Around the y axis; exact normals, u around and v from pole to pole. 2 columns (rows - 1)
// triangles; columns >= 3, rows >= 2.
Mesh make_sphere(uint32_t columns, uint32_t rows);

// Corners counter-clockwise as seen from the front; corners and normal are the triangle's own.
void add_flat_triangle(Mesh& mesh, vec3 a, vec3 b, vec3 c, uint32_t material);
// a b c d counter-clockwise as seen from the front.
void add_flat_quad(Mesh& mesh, vec3 a, vec3 b, vec3 c, vec3 d, uint32_t material);

// The last mesh as it stands, under its own name.
void add_instance(Scene& scene);

// Object to world: +y along the normal (of unit length), turned about it by an angle in radians.
mat4 standing_on(vec3 point, vec3 normal, float turned, float size);

// Moves every vertex of part into mesh, with its triangles given this material.
void append(Mesh& mesh, const Mesh& part, const mat4& rigid_and_scale, uint32_t material);

// fill(first, last) for all items [0, count) in parallel, in at most 100 portions, after each of
// which the job hears of the progress from `begin` to `end`. A stopped job throws Error.
void fill_in_parallel(size_t count, const Job& job, float begin, float end, std::string_view what,
                      const std::function<void(size_t first, size_t last)>& fill);

}  // namespace tracer
