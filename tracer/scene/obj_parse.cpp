// OBJ text to arrays, through tinyobjloader's callbacks: they hand over whole faces of any size and
// the indices as written, and need no memory of their own.
#include <algorithm>
#include <istream>
#include <unordered_map>

#include <tiny_obj_loader.h>

#include "tracer/error.h"
#include "tracer/scene/obj_file.h"

namespace tracer {
namespace {

constexpr size_t most_corners = 0x7fffffff;     // 32-bit ids
constexpr size_t most_polygon_corners = 65535;  // more is no polygon that anybody meant

struct Reading {
  ObjFile file;
  ObjText* text;
  std::unordered_map<std::string, uint32_t> material_ids;
  uint32_t material = 0;
};

// From what is written (1 the first, -1 the last so far, 0 none). Ones that are still too high are
// found at the end, as the element may follow.
int32_t resolved(int written, size_t count, int32_t if_none) {
  if (written > 0) return written - 1;
  if (written == 0) return if_none;
  const int64_t index = int64_t(count) + written;
  return index < 0 ? bad_obj_index : int32_t(index);
}

void add_face(void* user, tinyobj::index_t* corners, int count) {
  Reading& reading = *static_cast<Reading*>(user);
  ObjFile& file = reading.file;
  const uint64_t line = reading.text->line();
  if (size_t(count) > most_polygon_corners) {
    add(file.report.bad_faces, line, uint64_t(count) - 2);
    return;
  }
  if (file.corners.size() + size_t(count) > most_corners) {
    throw Error("more than 2147483647 face corners; split the file");
  }
  file.faces.push_back({uint32_t(file.corners.size()), uint32_t(count), reading.material,
                        uint32_t(std::min<uint64_t>(line, 0xffffffffu))});
  for (int i = 0; i < count; ++i) {
    const tinyobj::index_t& written = corners[i];
    file.corners.push_back({resolved(written.vertex_index, file.positions.size(), bad_obj_index),
                            resolved(written.texcoord_index, file.uvs.size(), -1),
                            resolved(written.normal_index, file.normals.size(), -1)});
  }
}

void use_material(void* user, const char* name, int) {
  Reading& reading = *static_cast<Reading*>(user);
  const auto [place, is_new] =
      reading.material_ids.try_emplace(name, uint32_t(reading.file.materials.size()));
  if (is_new) reading.file.materials.emplace_back(name);
  reading.material = place->second;
}

tinyobj::callback_t callbacks() {
  tinyobj::callback_t result;
  result.vertex_cb = [](void* user, float x, float y, float z, float) {
    static_cast<Reading*>(user)->file.positions.emplace_back(x, y, z);
  };
  result.normal_cb = [](void* user, float x, float y, float z) {
    static_cast<Reading*>(user)->file.normals.emplace_back(x, y, z);
  };
  result.texcoord_cb = [](void* user, float u, float v, float) {
    static_cast<Reading*>(user)->file.uvs.emplace_back(u, v);
  };
  result.index_cb = add_face;
  result.usemtl_cb = use_material;
  return result;
}

void merge(LineList& into, const LineList& from) {
  into.count += from.count;
  into.more = into.more || from.more || into.first.size() + from.first.size() > 5;
  into.first.insert(into.first.end(), from.first.begin(), from.first.end());
  std::sort(into.first.begin(), into.first.end());
  if (into.first.size() > 5) into.first.resize(5);
}

void mark_out_of_range(ObjFile& file) {
  const auto mark = [](int32_t& index, size_t count) {
    if (index >= 0 && size_t(index) >= count) index = bad_obj_index;
  };
  for (ObjCorner& corner : file.corners) {
    mark(corner.position, file.positions.size());
    mark(corner.uv, file.uvs.size());
    mark(corner.normal, file.normals.size());
  }
}

}  // namespace

ObjFile parse_obj(std::string_view text, const Job& job) {
  ObjText lines(text, job);
  Reading reading;
  reading.text = &lines;
  reading.file.materials.emplace_back();
  reading.material_ids[""] = 0;

  std::istream stream(&lines);
  std::string warnings;
  std::string errors;
  // Without a material reader: mtllib lines were collected by `lines`.
  tinyobj::LoadObjWithCallback(stream, callbacks(), &reading, nullptr, &warnings, &errors);
  if (job.stopped()) throw Error("loading was stopped");

  const LineList too_large = reading.file.report.bad_faces;
  reading.file.report = lines.report();
  merge(reading.file.report.bad_faces, too_large);
  mark_out_of_range(reading.file);
  return std::move(reading.file);
}

}  // namespace tracer
