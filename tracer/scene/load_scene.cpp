// From the name of a scene to the scene.
#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "tracer/choice.h"
#include "tracer/error.h"
#include "tracer/scene/builtin.h"
#include "tracer/scene/builtin_parts.h"
#include "tracer/scene/load_image.h"
#include "tracer/scene/load_obj.h"
#include "tracer/scene/obj_number.h"
#include "tracer/scene/scene.h"

namespace tracer {
namespace {

struct SceneFileRow {
  std::string_view id;  // the ending, lower case
  Scene (*load)(const std::filesystem::path& file, const Job& job);
};
constexpr SceneFileRow scene_file_rows[] = {{".obj", load_obj}};
constexpr std::span<const SceneFileRow> scene_files = scene_file_rows;

[[noreturn]] void throw_malformed(std::string_view text, std::string_view why) {
  throw Error(fmt::format("{}: {}; write SCENE:name=number,name=number", printable(text), why));
}

Scene load_scene_file(const std::string& name, const Job& job) {
  const std::filesystem::path file = name;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) {
    throw Error(fmt::format(
        "{}: the file does not exist and there is no built-in scene of this name; known are {}",
        printable(name), known_ids(builtin_scenes())));
  }
  if (std::filesystem::is_directory(status)) {
    throw Error(name + ": is a folder; give a scene file (.obj) in it");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw Error(name + ": is not a regular file (it is a pipe, socket or device)");
  }
  std::string ending = file.extension().string();
  for (char& c : ending)
    c = c >= 'A' && c <= 'Z' ? char(c + 32) : c;
  const SceneFileRow* row = find_row(scene_files, ending);
  if (!row) {
    throw Error(
        fmt::format("{}: scene files of this kind cannot be read; supported are {} and sessions "
                    "(.bvhscope); export it as OBJ",
                    name, known_ids(scene_files)));
  }
  return row->load(file, job);
}

SceneParameter parameter_of(std::string_view text, std::string_view word) {
  try {
    return parse_scene_parameter(word);
  } catch (const Error& error) {
    throw_malformed(text, error.what());
  }
}

}  // namespace

bool is_builtin(std::string_view name) {
  return find_row(builtin_scenes(), name) != nullptr;
}

SceneParameter parse_scene_parameter(std::string_view word) {
  const size_t equals = word.find('=');
  if (equals == word.npos || equals == 0) {
    throw Error(fmt::format("\"{}\" is not of the form name=number", printable(word)));
  }
  std::string_view number = word.substr(equals + 1);
  if (!number.empty() && number.front() == '+') number.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || end != number.data() + number.size() || !std::isfinite(value)) {
    throw Error(fmt::format("\"{}\" is not a number", printable(number)));
  }
  return {std::string(word.substr(0, equals)), value};
}

SceneSource parse_scene_source(std::string_view text) {
  if (text.empty()) throw Error("no scene is given; name a file or a built-in scene");
  SceneSource source;
  source.name = text;
  const size_t colon = text.find(':');
  // A file's name may have colons and equals signs as well.
  if (colon == text.npos || !is_builtin(text.substr(0, colon))) return source;
  source.name = text.substr(0, colon);
  std::string_view rest = text.substr(colon + 1);
  for (bool more = true; more;) {
    const size_t comma = rest.find(',');
    SceneParameter parameter = parameter_of(text, rest.substr(0, comma));
    const bool repeated =
        std::any_of(source.parameters.begin(), source.parameters.end(),
                    [&](const SceneParameter& earlier) { return earlier.id == parameter.id; });
    if (repeated) throw_malformed(text, fmt::format("\"{}\" is given twice", parameter.id));
    source.parameters.push_back(std::move(parameter));
    more = comma != rest.npos;
    if (more) rest.remove_prefix(comma + 1);
  }
  return source;
}

std::string to_string(const SceneSource& source) {
  std::string text = source.name;
  char separator = ':';
  for (const SceneParameter& parameter : source.parameters) {
    text += fmt::format("{}{}={}", separator, parameter.id, parameter.value);
    separator = ',';
  }
  return text;
}

Scene load_scene(const SceneSource& source, const Job& job) {
  Scene scene;
  if (is_builtin(source.name)) {
    scene = make_builtin_scene(source, job);
  } else {
    if (!source.parameters.empty()) {
      throw Error(source.name + ": only built-in scenes have parameters");
    }
    scene = load_scene_file(source.name, job);
    add_daylight(scene);  // no scene file brings a sky
  }
  if (job.stopped()) throw Error("loading was stopped");
  if (!source.sky_file.empty()) {
    try {
      scene.sky_image = load_sky(source.sky_file);
      scene.sky.on = true;
    } catch (const Error& error) {
      scene.warnings.push_back(fmt::format("sky {}; the scene's own sky is shown", error.what()));
    }
  }
  return scene;
}

}  // namespace tracer
