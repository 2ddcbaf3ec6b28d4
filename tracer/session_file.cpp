// Saved sessions: JSON with "schema", "settings" and "view".
#include "tracer/session_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tracer/choice.h"
#include "tracer/error.h"
#include "tracer/file_io.h"
#include "tracer/scene/builtin.h"
#include "tracer/session_fields.h"

namespace tracer {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int known_schema = 1;
constexpr uint64_t max_session_bytes = uint64_t(64) << 20;
constexpr size_t max_list = 65536;

// The double with the fewest digits that is this float: 0.1, not 0.10000000149.
double shortest(float value) {
  if (!std::isfinite(value)) return 0.0;
  const std::string digits = fmt::format("{}", value);
  double result = 0.0;
  std::from_chars(digits.data(), digits.data() + digits.size(), result);
  return result;
}

class Writer {
 public:
  explicit Writer(Json& json) : json_(json) { json_ = Json::object(); }

  template <class Number>
  void number(const char* name, Number value, Number, Number) {
    if constexpr (std::is_same_v<Number, float>) {
      json_[name] = shortest(value);
    } else {
      json_[name] = value;
    }
  }
  void flag(const char* name, bool value) { json_[name] = value; }
  void text(const char* name, const std::string& value) { json_[name] = value; }
  template <class Row>
  void choice(const char* name, const std::string& id, std::span<const Row>,
              std::string_view = {}) {
    json_[name] = id;
  }
  void color(const char* name, const vec3& value, float) { point(name, value); }
  void point(const char* name, const vec3& value) {
    json_[name] = {shortest(value.x), shortest(value.y), shortest(value.z)};
  }
  template <class Fill>
  void object(const char* name, Fill fill) {
    Writer inner(json_[name]);
    fill(inner);
  }
  template <class Item, class Fill>
  void list(const char* name, std::vector<Item>& items, Fill fill) {
    Json& array = json_[name] = Json::array();
    for (Item& item : items) {
      Writer inner(array.emplace_back());
      fill(inner, item);
    }
  }
  template <class Value, class Fill>
  void optional(const char* name, std::optional<Value>& value, Fill fill) {
    if (!value) {
      json_[name] = nullptr;
      return;
    }
    Writer inner(json_[name]);
    fill(inner, *value);
  }

 private:
  Json& json_;
};

class Reader {
 public:
  // `path` names the object in messages.
  Reader(const Json& json, std::string path, std::vector<std::string>& warnings)
      : json_(json), path_(std::move(path)), warnings_(warnings) {
    if (!json_.is_object()) throw Error(path_ + ": an object is expected");
  }

  template <class Number>
  void number(const char* name, Number& value, Number lo, Number hi) {
    const Json* entry = find(name);
    if (!entry) return;
    if (!entry->is_number()) throw Error(where(name) + ": a number is expected");
    value = ranged(where(name), *entry, lo, hi);
  }
  void flag(const char* name, bool& value) {
    const Json* entry = find(name);
    if (!entry) return;
    if (!entry->is_boolean()) throw Error(where(name) + ": true or false is expected");
    value = entry->get<bool>();
  }
  void text(const char* name, std::string& value) {
    const Json* entry = find(name);
    if (!entry) return;
    if (!entry->is_string()) throw Error(where(name) + ": a text is expected");
    value = entry->get<std::string>();
  }
  template <class Row>
  void choice(const char* name, std::string& id, std::span<const Row> rows,
              std::string_view other = {}) {
    std::string wanted = id;
    text(name, wanted);
    if (find_row(rows, wanted) || (!other.empty() && wanted == other)) {
      id = std::move(wanted);
    } else {
      warnings_.push_back(fmt::format("{}: \"{}\" is not known, {} is used; known are {}{}{}",
                                      where(name), wanted, id, other, other.empty() ? "" : ", ",
                                      known_ids(rows)));
    }
  }
  void color(const char* name, vec3& value, float most) { triple(name, value, 0.0f, most); }
  void point(const char* name, vec3& value) {
    triple(name, value, -largest_setting, largest_setting);
  }
  template <class Fill>
  void object(const char* name, Fill fill) {
    const Json* entry = find(name);
    if (!entry) return;
    Reader inner(*entry, where(name), warnings_);
    fill(inner);
    inner.finish();
  }
  template <class Item, class Fill>
  void list(const char* name, std::vector<Item>& items, Fill fill) {
    const Json* entry = find(name);
    if (!entry) return;
    if (!entry->is_array()) throw Error(where(name) + ": a list is expected");
    if (entry->size() > max_list) {
      throw Error(fmt::format("{}: has more than {} entries", where(name), max_list));
    }
    items.clear();
    for (size_t i = 0; i < entry->size(); ++i) {
      Reader inner((*entry)[i], fmt::format("{}[{}]", where(name), i), warnings_);
      fill(inner, items.emplace_back());
      inner.finish();
    }
  }
  template <class Value, class Fill>
  void optional(const char* name, std::optional<Value>& value, Fill fill) {
    const Json* entry = find(name);
    if (!entry || entry->is_null()) return;
    Reader inner(*entry, where(name), warnings_);
    fill(inner, value.emplace());
    inner.finish();
  }

  // Tells about the fields that nobody asked for.
  void finish() const {
    for (const auto& entry : json_.items()) {
      if (std::find(known_.begin(), known_.end(), entry.key()) == known_.end()) {
        warnings_.push_back(where(entry.key()) + ": not known, ignored");
      }
    }
  }

 private:
  std::string where(const std::string& name) const { return path_ + "." + name; }

  const Json* find(const char* name) {
    known_.emplace_back(name);
    const auto found = json_.find(name);
    return found == json_.end() ? nullptr : &*found;
  }

  template <class Number>
  Number ranged(const std::string& name, const Json& entry, Number lo, Number hi) {
    double value = entry.get<double>();
    if (!std::is_floating_point_v<Number>) value = std::round(value);
    const double limited = std::clamp(value, double(lo), double(hi));
    if (limited != value) {
      warnings_.push_back(
          fmt::format("{}: {} is outside {}..{}; {} is used", name, value, lo, hi, limited));
    }
    return static_cast<Number>(limited);
  }

  void triple(const char* name, vec3& value, float lo, float hi) {
    const Json* entry = find(name);
    if (!entry) return;
    const bool fits = entry->is_array() && entry->size() == 3 &&
                      std::all_of(entry->begin(), entry->end(),
                                  [](const Json& number) { return number.is_number(); });
    if (!fits) throw Error(where(name) + ": a list of three numbers is expected");
    for (int i = 0; i < 3; ++i) {
      value[i] = ranged(fmt::format("{}[{}]", where(name), i), (*entry)[size_t(i)], lo, hi);
    }
  }

  const Json& json_;
  std::string path_;
  std::vector<std::string>& warnings_;
  std::vector<std::string> known_;
};

bool is_file_name(const std::string& name) {
  return !name.empty() && find_row(builtin_scenes(), name) == nullptr;
}

std::string stored(const std::string& name, const fs::path& folder) {
  const fs::path file = fs::absolute(name).lexically_normal();
  const fs::path relative = file.lexically_relative(folder);
  return relative.empty() || *relative.begin() == ".." ? file.string() : relative.string();
}

// What no single field's range can say.
void mend(SavedSession& session) {
  if (session.settings.look) {
    for (Material& material : session.settings.look->materials) {
      const float most = 1.0f - material.transmission;
      if (material.reflectivity <= most) continue;
      session.warnings.push_back(
          fmt::format("settings.look.materials: reflectivity and transmission of \"{}\" are more "
                      "than 1 together; reflectivity {} is used",
                      material.name, most));
      material.reflectivity = most;
    }
  }
  std::optional<ValueRange>& range = session.view.range;
  if (range && range->lo > range->hi) {
    session.warnings.emplace_back("view.range: lo is above hi; they were exchanged");
    std::swap(range->lo, range->hi);
  }
  BoxOptions& boxes = session.view.boxes;
  if (boxes.first_level > boxes.last_level) {
    session.warnings.emplace_back("view.boxes: first_level is below last_level; exchanged");
    std::swap(boxes.first_level, boxes.last_level);
  }
}

SavedSession parsed(const Json& json) {
  const auto schema = json.is_object() ? json.find("schema") : json.end();
  if (schema == json.end() || !schema->is_number_integer()) {
    throw Error("this is not a saved session of bvhscope");
  }
  if (*schema != known_schema) {
    throw Error(fmt::format("written by a later bvhscope (schema {}, this one knows {})",
                            schema->dump(), known_schema));
  }
  SavedSession session;
  for (const auto& entry : json.items()) {
    if (entry.key() == "settings") {
      Reader reader(entry.value(), "settings", session.warnings);
      session_fields(reader, session.settings);
      reader.finish();
    } else if (entry.key() == "view") {
      Reader reader(entry.value(), "view", session.warnings);
      session_fields(reader, session.view);
      reader.finish();
    } else if (entry.key() != "schema") {
      session.warnings.push_back(entry.key() + ": not known, ignored");
    }
  }
  mend(session);
  return session;
}

}  // namespace

std::string session_json(const SavedSession& session) {
  SavedSession copy = session;
  Json json = {{"schema", known_schema}};
  Writer settings(json["settings"]);
  session_fields(settings, copy.settings);
  Writer view(json["view"]);
  session_fields(view, copy.view);
  // File names need not be valid UTF-8.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

SavedSession parse_session(std::string_view text, std::string_view file) {
  try {
    return parsed(Json::parse(text));
  } catch (const Json::exception&) {
    throw Error(fmt::format("{}: this is not a saved session of bvhscope, or a part of one", file));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file, error.what()));
  }
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
