#include "tracer/session_file.h"

#include <cmath>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tracer/choice.h"
#include "tracer/error.h"
#include "tracer/file_io.h"
#include "tracer/scene/builtin.h"

namespace tracer {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int schema = 1;
constexpr uint64_t max_session_bytes = 64u << 20;

// Each struct's fields are named once, for the way out and the way in.
template <class Fields>
void describe(Fields& fields, Camera& camera) {
  fields("eye", camera.eye);
  fields("target", camera.target);
  fields("up", camera.up);
  fields("fov_degrees", camera.fov_degrees);
  fields("orthographic", camera.orthographic);
}

template <class Fields>
void describe(Fields& fields, Light& light) {
  fields("name", light.name);
  fields("position", light.position);
  fields("color", light.color);
  fields("intensity", light.intensity);
  fields("on", light.on);
}

template <class Fields>
void describe(Fields& fields, Material& material) {
  fields("name", material.name);
  fields("albedo", material.albedo);
  fields("texture", material.texture);
  fields("use_texture", material.use_texture);
  fields("reflectivity", material.reflectivity);
  fields("transmission", material.transmission);
  fields("refraction_index", material.refraction_index);
  fields("specular", material.specular);
  fields("emission", material.emission);
}

template <class Fields>
void describe(Fields& fields, SkySettings& sky) {
  fields("on", sky.on);
  fields("rotation_degrees", sky.rotation_degrees);
  fields("intensity", sky.intensity);
  fields("flat_color", sky.flat_color);
}

template <class Fields>
void describe(Fields& fields, Look& look) {
  fields("camera", look.camera);
  fields("lights", look.lights);
  fields("ambient", look.ambient);
  fields("sky", look.sky);
  fields("materials", look.materials);
}

template <class Fields>
void describe(Fields& fields, SceneParameter& parameter) {
  fields("id", parameter.id);
  fields("value", parameter.value);
}

template <class Fields>
void describe(Fields& fields, SceneSource& source) {
  fields("name", source.name);
  fields("parameters", source.parameters);
  fields("sky_file", source.sky_file);
}

template <class Fields>
void describe(Fields& fields, BuildOptions& options) {
  fields("builder", options.builder);
  fields("bins", options.bins);
  fields("max_leaf_size", options.max_leaf_size);
  fields("max_depth", options.max_depth);
  fields("traversal_cost", options.traversal_cost);
  fields("intersection_cost", options.intersection_cost);
}

template <class Fields>
void describe(Fields& fields, RenderOptions& options) {
  fields("width", options.width);
  fields("height", options.height);
  fields("ray_depth", options.ray_depth);
  fields("samples", options.samples);
  fields("shadows", options.shadows);
}

template <class Fields>
void describe(Fields& fields, ValueRange& range) {
  fields("lo", range.lo);
  fields("hi", range.hi);
}

template <class Fields>
void describe(Fields& fields, ViewOptions& view) {
  fields("view", view.view);
  fields("counter", view.counter);
  fields("ray_class", view.ray_class);
  fields("colormap", view.colormap);
  fields("range", view.range);
  fields("logarithmic", view.logarithmic);
  fields("exposure", view.exposure);
  fields("tone_map", view.tone_map);
  fields("legend", view.legend);
}

template <class Fields>
void describe(Fields& fields, Settings& settings) {
  fields("scene", settings.source);
  fields("build", settings.build);
  fields("layout", settings.layout);
  fields("time", settings.time);
  fields("render", settings.render);
  fields("look", settings.look);
}

template <class Fields>
void describe(Fields& fields, SavedSession& session) {
  fields("settings", session.settings);
  fields("view", session.view);
}

template <class T>
struct is_vector : std::false_type {};
template <class T>
struct is_vector<std::vector<T>> : std::true_type {};
template <class T>
struct is_optional : std::false_type {};
template <class T>
struct is_optional<std::optional<T>> : std::true_type {};

template <class T>
Json written(T& value);

struct Writer {
  Json json = Json::object();

  template <class T>
  void operator()(const char* key, T& value) {
    json[key] = written(value);
  }
};

template <class T>
Json written(T& value) {
  if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
    return value;
  } else if constexpr (std::is_same_v<T, vec3>) {
    return Json::array({value.x, value.y, value.z});
  } else if constexpr (is_optional<T>::value) {
    return value ? written(*value) : Json(nullptr);
  } else if constexpr (is_vector<T>::value) {
    Json array = Json::array();
    for (auto& item : value)
      array.push_back(written(item));
    return array;
  } else {
    Writer writer;
    describe(writer, value);
    return std::move(writer.json);
  }
}

template <class T>
void read(const Json& json, const std::string& where, T& value);

struct Reader {
  const Json& json;
  std::string where;  // "file: settings.render"

  template <class T>
  void operator()(const char* key, T& value) {
    const auto found = json.find(key);
    if (found == json.end()) return;
    const char* separator = where.ends_with(": ") ? "" : ".";
    read(*found, where + separator + key, value);
  }
};

void expect(bool fits, const std::string& where, const char* what) {
  if (!fits) throw Error(fmt::format("{} is not {}", where, what));
}

template <class T>
void read_number(const Json& json, const std::string& where, T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    expect(json.is_number() && std::isfinite(json.get<T>()), where, "a finite number");
  } else {
    expect(json.is_number_integer() && json.get<int64_t>() >= std::numeric_limits<T>::min() &&
               json.get<int64_t>() <= int64_t(std::numeric_limits<T>::max()),
           where, "a whole number of that range");
  }
  value = json.get<T>();
}

template <class T>
void read(const Json& json, const std::string& where, T& value) {
  if constexpr (std::is_same_v<T, bool>) {
    expect(json.is_boolean(), where, "true or false");
    value = json.get<bool>();
  } else if constexpr (std::is_arithmetic_v<T>) {
    read_number(json, where, value);
  } else if constexpr (std::is_same_v<T, std::string>) {
    expect(json.is_string(), where, "a text");
    value = json.get<std::string>();
  } else if constexpr (std::is_same_v<T, vec3>) {
    expect(json.is_array() && json.size() == 3, where, "three numbers");
    for (int axis = 0; axis < 3; ++axis)
      read_number(json[size_t(axis)], where, value[axis]);
  } else if constexpr (is_optional<T>::value) {
    value.reset();
    if (!json.is_null()) read(json, where, value.emplace());
  } else if constexpr (is_vector<T>::value) {
    expect(json.is_array(), where, "a list");
    value.assign(json.size(), {});
    for (size_t i = 0; i < json.size(); ++i) {
      read(json[i], fmt::format("{}[{}]", where, i), value[i]);
    }
  } else {
    expect(json.is_object(), where, "an object");
    Reader reader{json, where};
    describe(reader, value);
  }
}

bool is_file_name(const std::string& name) {
  return !name.empty() && find_row(builtin_scenes(), name) == nullptr;
}

std::string stored(const std::string& name, const fs::path& folder) {
  const fs::path file = fs::absolute(name).lexically_normal();
  const fs::path relative = file.lexically_relative(folder);
  return relative.empty() || *relative.begin() == ".." ? file.string() : relative.string();
}

}  // namespace

std::string session_json(const SavedSession& session) {
  SavedSession copy = session;
  Json json = {{"schema", schema}};
  json.update(written(copy));
  // File names need not be valid UTF-8.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

SavedSession parse_session(std::string_view text, std::string_view file) {
  const Json json = Json::parse(text, nullptr, false);
  const std::string where = fmt::format("{}: ", file);
  if (!json.is_object() || !json.contains("schema")) {
    throw Error(where + "this is not a saved session of bvhscope");
  }
  int found = 0;
  read_number(json["schema"], where + "schema", found);
  if (found > schema) {
    throw Error(fmt::format("{}written by a later bvhscope (schema {}, this one knows {})", where,
                            found, schema));
  }
  SavedSession session;
  Reader reader{json, where};
  describe(reader, session);
  return session;
}

void write_session(const fs::path& file, SavedSession session) {
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  SceneSource& source = session.settings.source;
  if (is_file_name(source.name)) source.name = stored(source.name, folder);
  if (!source.sky_file.empty()) source.sky_file = stored(source.sky_file, folder);
  write_file_atomically(file, session_json(session));
}

SavedSession read_session(const fs::path& file) {
  SavedSession session = parse_session(read_file(file, max_session_bytes), file.string());
  // An absolute name replaces the folder.
  const fs::path folder = file.parent_path();
  SceneSource& source = session.settings.source;
  if (is_file_name(source.name)) source.name = (folder / source.name).string();
  if (!source.sky_file.empty()) source.sky_file = (folder / source.sky_file).string();
  return session;
}

bool is_session_file(const fs::path& file) {
  return file.extension() == ".bvhscope";
}

}  // namespace tracer
