// Wavefront OBJ and MTL: from files to a scene.
#include "tracer/scene/load_obj.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include "tracer/error.h"
#include "tracer/file_io.h"
#include "tracer/scene/find_file.h"
#include "tracer/scene/load_image.h"
#include "tracer/scene/load_mtl.h"
#include "tracer/scene/obj_file.h"

namespace tracer {
namespace {

constexpr uint64_t max_obj_bytes = uint64_t(8) << 30;
constexpr uint64_t max_mtl_bytes = uint64_t(64) << 20;
constexpr float crease_degrees = 50.0f;  // an octagonal column is round, a hexagonal one is not

using Warnings = std::vector<std::string>;

// What the arguments of one mtllib line name: one file with blanks in its name, or several files.
std::vector<std::string> library_names(const std::filesystem::path& folder,
                                       const std::string& arguments) {
  if (find_file(folder, arguments).path) return {arguments};
  std::vector<std::string> names;
  std::string name;
  for (size_t i = 0; i <= arguments.size(); ++i) {
    const bool at_blank = i == arguments.size() || obj_blanks.find(arguments[i]) != obj_blanks.npos;
    if (!at_blank || (i < arguments.size() && i > 0 && arguments[i - 1] == '\\')) {
      name += arguments[i];
    } else if (!name.empty()) {
      names.push_back(name);
      name.clear();
    }
  }
  return names;
}

struct Libraries {
  std::map<std::string, MtlMaterial> materials;
  bool complete = true;  // no file is missing
};

void warn_about_materials(const std::string& name, const MtlFile& file, Warnings& warnings) {
  const auto warn = [&](const LineList& list, const char* noun, const char* what) {
    if (!list.count) return;
    warnings.push_back(fmt::format("material file {}: {} {} ({})", name, counted(list.count, noun),
                                   what, lines_text(list)));
  };
  warn(file.bad_numbers, "line", "without the numbers that belong there");
  warn(file.out_of_range, "line", "with numbers out of range, brought into it");
  warn(file.repeated, "name", "given again, otherwise; the first material of a name is shown");
}

Libraries load_libraries(const std::filesystem::path& folder, const std::vector<std::string>& lines,
                         Warnings& warnings) {
  Libraries result;
  std::vector<std::string> seen;
  for (const std::string& line : lines) {
    for (const std::string& name : library_names(folder, line)) {
      if (std::find(seen.begin(), seen.end(), name) != seen.end()) continue;
      seen.push_back(name);
      const FoundFile found = find_file(folder, name);
      if (found.path) {
        try {
          MtlFile file = parse_mtl(read_file(*found.path, max_mtl_bytes));
          warn_about_materials(printable(name), file, warnings);
          result.materials.merge(file.materials);
        } catch (const Error& error) {
          result.complete = false;
          warnings.emplace_back(error.what());
        }
        continue;
      }
      result.complete = false;
      warnings.push_back(fmt::format("material file {}: {}; its materials are grey",
                                     printable(name), found.problem));
    }
  }
  return result;
}

// The scene's materials, of those names that faces use, and where each name went.
struct UsedMaterials {
  std::vector<MtlMaterial> materials;
  std::vector<uint32_t> ids;  // by ObjFile::materials; none: no face uses it
  std::vector<UvTransform> transforms;
};

UsedMaterials used_materials(const ObjFile& file, const Libraries& libraries, Warnings& warnings) {
  UsedMaterials result;
  result.ids.assign(file.materials.size(), none);
  result.transforms.resize(file.materials.size());
  for (const ObjFace& face : file.faces)
    result.ids[face.material] = 0;
  std::string unknown;
  for (size_t i = 0; i < file.materials.size(); ++i) {
    if (result.ids[i] == none) continue;
    result.ids[i] = uint32_t(result.materials.size());
    const std::string name(trimmed(file.materials[i]));
    const auto found = libraries.materials.find(name);
    if (found != libraries.materials.end()) {
      result.materials.push_back(found->second);
      result.transforms[i] = {found->second.uv_scale, found->second.uv_offset};
      continue;
    }
    result.materials.emplace_back();
    result.materials.back().material.name = name.empty() ? "default" : printable(name);
    if (!name.empty()) unknown += (unknown.empty() ? "" : ", ") + printable(name);
  }
  if (!unknown.empty() && libraries.complete) {
    warnings.push_back("materials that no MTL file defines, shown grey: " + unknown);
  }
  return result;
}

// Some exporters write transparency the wrong way round; nobody makes a scene of nothing.
void mend_invisible(std::vector<MtlMaterial>& materials, Warnings& warnings) {
  const bool invisible =
      std::all_of(materials.begin(), materials.end(), [](const MtlMaterial& material) {
        return material.material.transmission >= 1.0f && material.material.refraction_index == 1.0f;
      });
  if (!invisible) return;
  for (MtlMaterial& material : materials)
    material.material.transmission = 0.0f;
  warnings.emplace_back("all materials are fully transparent (d 0 or Tr 1); shown opaque");
}

uint64_t texture_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES);
  const long page_bytes = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && page_bytes > 0 ? uint64_t(pages) * uint64_t(page_bytes) / 4
                                     : uint64_t(1) << 30;
}

struct LoadedTexture {
  Texture texture;
  std::string problem;
};

LoadedTexture try_texture(const std::filesystem::path& folder, const std::string& name) {
  const FoundFile found = find_file(folder, name);
  if (!found.path) return {{}, fmt::format("texture {}: {}", printable(name), found.problem)};
  try {
    return {load_texture(*found.path), {}};
  } catch (const std::exception& error) {
    return {{}, error.what()};
  }
}

// Each file once, in parallel; materials whose texture cannot be had go without.
void load_textures(const std::filesystem::path& folder, const std::vector<MtlMaterial>& used,
                   Scene& scene, const Job& job) {
  std::vector<std::string> names;
  std::map<std::string, uint32_t> ids;  // in names
  for (const MtlMaterial& material : used) {
    if (material.texture.empty()) continue;
    if (ids.try_emplace(material.texture, uint32_t(names.size())).second) {
      names.push_back(material.texture);
    }
  }
  constexpr size_t batch = 8;  // then progress, cancelling and the memory limit are looked at
  const uint64_t memory_limit = texture_memory();
  uint64_t memory = 0;
  std::vector<uint32_t> places(names.size(), none);  // in scene.textures
  for (size_t first = 0; first < names.size(); first += batch) {
    if (job.stopped()) throw Error("loading was stopped");
    job.progress(0.85f + 0.15f * float(first) / float(names.size()),
                 fmt::format("reading {} textures", names.size()));
    if (memory > memory_limit) {
      scene.warnings.push_back(fmt::format(
          "{} textures left out: all together they would take more than a quarter of the memory",
          names.size() - first));
      break;
    }
    const size_t count = std::min(batch, names.size() - first);
    std::vector<LoadedTexture> loaded(count);
    tbb::parallel_for(size_t(0), count,
                      [&](size_t i) { loaded[i] = try_texture(folder, names[first + i]); });
    for (size_t i = 0; i < count; ++i) {
      if (!loaded[i].problem.empty()) {
        const std::string& name = names[first + i];
        const auto user = std::find_if(used.begin(), used.end(), [&](const MtlMaterial& material) {
          return material.texture == name;
        });
        scene.warnings.push_back(fmt::format("{}; material {} is shown without it",
                                             loaded[i].problem, printable(user->material.name)));
        continue;
      }
      memory += 4 * loaded[i].texture.texels.size();
      places[first + i] = uint32_t(scene.textures.size());
      scene.textures.push_back(std::move(loaded[i].texture));
    }
  }
  for (size_t i = 0; i < used.size(); ++i) {
    if (!used[i].texture.empty()) scene.materials[i].texture = places[ids[used[i].texture]];
  }
}

void warn_about_text(const ObjTextReport& report, Warnings& warnings) {
  if (report.bad_numbers.count) {
    warnings.push_back(fmt::format("{} without the finite numbers that belong there ({})",
                                   counted(report.bad_numbers.count, "coordinate line"),
                                   lines_text(report.bad_numbers)));
  }
  if (report.decimal_commas.count) {
    warnings.push_back(fmt::format("{} with decimal commas, read as points ({})",
                                   counted(report.decimal_commas.count, "line"),
                                   lines_text(report.decimal_commas)));
  }
}

void warn_about_faces(const LineList& malformed, const ObjFaults& faults, Warnings& warnings) {
  const auto left_out = [&](const LineList& list, const char* why) {
    if (!list.count) return;
    warnings.push_back(fmt::format("{} left out: {} ({})", counted(list.count, "triangle"), why,
                                   lines_text(list)));
  };
  left_out(malformed, "the face cannot be understood");
  left_out(faults.bad_index, "a vertex index is out of range");
  left_out(faults.non_finite, "a vertex is not finite or beyond 1.844e18");
  left_out(faults.degenerate, "no area");
  if (faults.bad_attribute.count) {
    warnings.push_back(
        fmt::format("{} with a texture or normal index out of range, shown without "
                    "it ({})",
                    counted(faults.bad_attribute.count, "face"), lines_text(faults.bad_attribute)));
  }
}

[[noreturn]] void throw_nothing_to_show(const std::string& name, std::string_view text,
                                        const ObjTextReport& report, bool has_faces,
                                        const Warnings& warnings) {
  const bool is_binary = text.substr(0, 4096).find('\0') != text.npos;
  if (is_binary || report.understood < report.unknown) {
    throw Error(name +
                ": this is not the text of a Wavefront OBJ file; nothing in it was "
                "understood as one");
  }
  std::string message = name + ": no triangle can be shown";
  if (!has_faces) message += ": the file has no faces (f lines); is its end missing?";
  for (const std::string& warning : warnings)
    message += "; " + warning;
  throw Error(message);
}

// Over the left shoulder of the default camera, as bright as the middle of the scene needs.
Light key_light(const Box& box) {
  const vec3 offset = 0.5f * glm::length(extent(box)) * vec3(-0.5f, 2.0f, 1.5f);
  Light light;
  light.name = "key";
  light.position = center(box) + offset;
  light.intensity = 0.8f * glm::dot(offset, offset);
  return light;
}

Scene load(const std::filesystem::path& file, const Job& job) {
  const std::string name = file.string();
  job.progress(0.0f, "reading the file");
  std::string text = read_file(file, max_obj_bytes);
  if (text.empty()) throw Error(name + ": the file is empty");
  ObjFile parsed = parse_obj(text, job);

  Scene scene;
  scene.name = file.filename().string();
  warn_about_text(parsed.report, scene.warnings);
  Warnings library_warnings;
  const Libraries libraries =
      load_libraries(file.parent_path(), parsed.report.libraries, library_warnings);
  UsedMaterials used = used_materials(parsed, libraries, library_warnings);

  job.progress(0.75f, "making the mesh");
  ObjFaults faults;
  Mesh mesh = make_mesh(parsed, used.ids, used.transforms, scene.counts, faults);
  warn_about_faces(parsed.report.bad_faces, faults, scene.warnings);
  if (mesh.triangles.empty()) {
    const bool has_faces = !parsed.faces.empty() || parsed.report.bad_faces.count > 0;
    throw_nothing_to_show(name, text, parsed.report, has_faces, scene.warnings);
  }
  text = {};
  parsed = {};
  if (job.stopped()) throw Error("loading was stopped");
  fill_missing_normals(mesh, crease_degrees);
  mesh.name = file.stem().string();
  scene.meshes.push_back(std::move(mesh));
  scene.instances.emplace_back().name = scene.meshes[0].name;

  scene.warnings.insert(scene.warnings.end(), library_warnings.begin(), library_warnings.end());
  mend_invisible(used.materials, scene.warnings);
  for (const MtlMaterial& material : used.materials)
    scene.materials.push_back(material.material);
  const auto has_alpha_map = [](const MtlMaterial& material) { return material.has_alpha_map; };
  if (const auto count =
          std::count_if(used.materials.begin(), used.materials.end(), has_alpha_map)) {
    scene.warnings.push_back(
        fmt::format("{} with a transparency texture (map_d), which is not used",
                    counted(uint64_t(count), "material")));
  }
  load_textures(file.parent_path(), used.materials, scene, job);

  const Box box = bounds(scene);
  scene.camera = default_camera(box);
  scene.lights.push_back(key_light(box));
  scene.ambient = vec3(0.2f);
  return scene;
}

}  // namespace

Scene load_obj(const std::filesystem::path& file, const Job& job) {
  try {
    return load(file, job);
  } catch (const std::bad_alloc&) {
    throw Error(file.string() + ": not enough memory to load this file");
  }
}

}  // namespace tracer
