// The table of built-in scenes, and where their files are.
#include "tracer/scene/builtin.h"

#include <array>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "tracer/choice.h"
#include "tracer/error.h"
#include "tracer/scene/builtin_makers.h"

namespace tracer {
namespace {

constexpr SceneParameterRow detail_row(double default_value) {
  return {"detail",
          "Teapot detail",
          "Quads along the edge of each of a teapot's 32 patches.",
          default_value,
          2,
          256};
}
constexpr SceneParameterRow seed_row = {
    "seed", "Seed", "Another number gives another scene of the same kind.", 1, 0, 1e9};

constexpr std::array teapots_parameters = {detail_row(10)};
constexpr std::array showcase_parameters = {
    detail_row(24),
    SceneParameterRow{"floor", "Floor squares", "Squares along one side.", 24, 1, 1000}};
constexpr std::array massive_parameters = {
    SceneParameterRow{"instances", "Instances", "Small teapots on the big one.", 11000, 1, 1e6},
    detail_row(10)};
constexpr std::array sticks_parameters = {
    SceneParameterRow{"sticks", "Sticks", "Number of instances.", 300, 1, 100000},
    SceneParameterRow{"rings", "Rings", "Along a stick, sixteen triangles from one to the next.",
                      65, 2, 10000},
    seed_row};
constexpr std::array needles_parameters = {
    SceneParameterRow{"triangles", "Triangles", "Number of needles.", 20000, 1, 1e7}, seed_row};
constexpr std::array stadium_parameters = {detail_row(64)};
constexpr std::array stacked_parameters = {
    SceneParameterRow{"copies", "Copies", "How often the same triangle is there.", 200, 1, 1e6},
    SceneParameterRow{"concentric", "Concentric triangles", "Triangles with the same centre.", 200,
                      1, 1e6}};
constexpr std::array hairball_parameters = {
    SceneParameterRow{"strands", "Strands", "Number of hairs.", 4000, 1, 100000},
    SceneParameterRow{"segments", "Segments", "Pieces of one hair, six triangles each.", 24, 1,
                      100},
    seed_row};
constexpr std::array terrain_parameters = {
    SceneParameterRow{"triangles", "Triangles", "How many there shall be, to within 1 %.", 1e6,
                      1000, 1e7},
    seed_row};

constexpr std::array<BuiltinSceneRow, 9> rows = {{
    {"teapots", "Sixteen teapots",
     "One BLAS, sixteen instances: they turn and bounce and only the TLAS is built again.",
     teapots_parameters, make_teapots},
    {"showcase", "Showcase",
     "Mirror and glass on a checker floor: reflected and refracted rays cost more than primary "
     "ones.",
     showcase_parameters, make_showcase},
    {"massive", "Massive",
     "Thousands of instances of one teapot: memory stays that of one BLAS plus the TLAS.",
     massive_parameters, make_massive},
    {"sticks", "Sticks",
     "Long instances that stand askew: their boxes are full of others, until re-braiding cuts them "
     "into parts.",
     sticks_parameters, make_sticks},
    {"needles", "Needles",
     "Long thin triangles in all directions: their boxes are nearly empty and overlap each other.",
     needles_parameters, make_needles},
    {"stadium", "Teapot in a stadium",
     "A detailed teapot in a huge sparse stadium: middle splits waste levels, SAH finds it at "
     "once.",
     stadium_parameters, make_stadium},
    {"stacked", "Stacked triangles",
     "Equal triangles and equal centres: no split can separate them, so a builder has to give up.",
     stacked_parameters, make_stacked},
    {"hairball", "Hairball",
     "Thin curved tubes in every direction: a ray passes very many boxes before it hits anything.",
     hairball_parameters, make_hairball},
    {"terrain", "Terrain",
     "An even height field of any size: the friendly case, for build speed and memory.",
     terrain_parameters, make_terrain},
}};

std::string known_parameters(const BuiltinSceneRow& row) {
  return known_ids(row.parameters);
}

}  // namespace

std::span<const BuiltinSceneRow> builtin_scenes() {
  return rows;
}

Scene make_builtin_scene(const SceneSource& source, const Job& job) {
  const BuiltinSceneRow* row = find_row(builtin_scenes(), source.name);
  if (!row) {
    throw Error(fmt::format("unknown scene \"{}\"; built-in scenes are: {}", source.name,
                            known_ids(builtin_scenes())));
  }
  std::vector<double> values;
  for (const SceneParameterRow& parameter : row->parameters) {
    values.push_back(parameter.default_value);
  }
  for (const SceneParameter& given : source.parameters) {
    const SceneParameterRow* parameter = find_row(row->parameters, given.id);
    if (!parameter) {
      throw Error(fmt::format("scene {}: unknown parameter \"{}\"; it has: {}", row->id, given.id,
                              known_parameters(*row)));
    }
    if (!(given.value >= parameter->min && given.value <= parameter->max) ||
        given.value != std::floor(given.value)) {
      throw Error(fmt::format("scene {}: {} = {} is not a whole number from {} to {}", row->id,
                              given.id, given.value, parameter->min, parameter->max));
    }
    values[static_cast<size_t>(parameter - row->parameters.data())] = given.value;
  }
  Scene scene = row->make(values, job);
  if (job.stopped()) throw Error(fmt::format("scene {}: stopped", row->id));
  scene.name = row->id;
  for (const Mesh& mesh : scene.meshes)
    scene.counts.read += mesh.triangles.size();
  scene.counts.used = scene.counts.read;
  return scene;
}

std::filesystem::path asset_path(std::string_view name) {
  namespace fs = std::filesystem;
  std::vector<fs::path> folders;
  if (const char* folder = std::getenv("BVHSCOPE_ASSETS_DIR")) folders.emplace_back(folder);
  folders.emplace_back(BVHSCOPE_ASSETS);
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  if (!failed) {
    const fs::path beside = program.parent_path();
    folders.push_back(beside / "assets");
    folders.push_back(beside / ".." / "assets");
    folders.push_back(beside / ".." / "share" / "bvhscope" / "assets");
  }
  for (const fs::path& folder : folders) {
    fs::path file = folder / name;
    if (fs::exists(file, failed)) return file;
  }
  return folders.front() / name;
}

}  // namespace tracer
