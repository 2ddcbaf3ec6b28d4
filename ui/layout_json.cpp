// The lasting choices of the user as JSON.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "tracer/choice.h"
#include "ui/panels.h"

namespace ui {
namespace {

using Json = nlohmann::ordered_json;

// Each read leaves the value as it is when the entry is missing or of another type.
void read(const Json& json, const char* key, float& value, float lo, float hi) {
  if (!json.is_object() || !json.contains(key) || !json[key].is_number()) return;
  value = std::clamp(json[key].get<float>(), lo, hi);
}
void read(const Json& json, const char* key, bool& value) {
  if (json.is_object() && json.contains(key) && json[key].is_boolean()) value = json[key];
}
void read(const Json& json, const char* key, std::string& value) {
  if (json.is_object() && json.contains(key) && json[key].is_string()) value = json[key];
}

void read_panels(const Json& json, Layout& layout) {
  if (!json.is_array()) return;
  for (const Json& entry : json) {
    std::string panel, region;
    read(entry, "panel", panel);
    read(entry, "region", region);
    PanelPlace* place = find_place(layout, panel);
    const auto name = std::find(region_names.begin(), region_names.end(), region);
    if (place == nullptr || name == region_names.end()) continue;
    bool shown = place->shown;
    read(entry, "shown", shown);
    move_panel(layout, panel, static_cast<Region>(name - region_names.begin()));
    if (!shown) hide_panel(layout, panel);
  }
}

}  // namespace

std::string layout_to_json(const UiState& state) {
  Json json;
  json["schema"] = 1;
  json["left"] = state.layout.left;
  json["right"] = state.layout.right;
  json["bottom"] = state.layout.bottom;
  Json& places = json["panels"] = Json::array();
  for (const PanelPlace& place : state.layout.panels) {
    places.push_back({{"panel", place.panel},
                      {"region", region_names[static_cast<int>(place.region)]},
                      {"shown", place.shown}});
  }
  for (int i = 0; i < region_count; ++i)
    json["front"][region_names[i]] = state.layout.front[i];
  json["scale"] = state.user_scale;
  json["picture_size"] = static_cast<int>(state.picture_size);
  json["fly_speed"] = state.fly_speed;
  json["show_gizmo"] = state.show_gizmo;
  json["show_lights"] = state.show_lights;
  json["show_values"] = state.show_values;
  json["tree_columns"] = state.tree.columns;
  json["recent_files"] = state.recent_files;
  // File names need not be valid UTF-8.
  return json.dump(1, ' ', false, Json::error_handler_t::replace);
}

void layout_from_json(UiState& state, std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return;
  Layout& layout = state.layout;
  read(json, "left", layout.left, 120.0f, 4000.0f);
  read(json, "right", layout.right, 120.0f, 4000.0f);
  read(json, "bottom", layout.bottom, 60.0f, 4000.0f);
  if (json.contains("panels")) read_panels(json["panels"], layout);
  for (int i = 0; json.contains("front") && i < region_count; ++i) {
    std::string front;
    read(json["front"], region_names[i], front);
    const PanelPlace* place = find_place(layout, front);
    if (place != nullptr && place->shown && place->region == static_cast<Region>(i)) {
      layout.front[i] = front;
    }
  }
  layout.raise.fill(true);
  read(json, "scale", state.user_scale, 0.0f, 4.0f);
  float size = static_cast<float>(state.picture_size);
  read(json, "picture_size", size, 0.0f, 3.0f);
  state.picture_size = static_cast<PictureSize>(size);
  read(json, "fly_speed", state.fly_speed, 0.01f, 100.0f);
  read(json, "show_gizmo", state.show_gizmo);
  read(json, "show_lights", state.show_lights);
  read(json, "show_values", state.show_values);
  if (json.contains("tree_columns") && json["tree_columns"].is_array()) {
    state.tree.columns.clear();
    for (const Json& column : json["tree_columns"]) {
      if (!column.is_string()) continue;
      const std::string id = column;
      const bool known = tracer::find_row(tracer::node_measures(), id) != nullptr;
      const auto& shown = state.tree.columns;
      if (known && std::find(shown.begin(), shown.end(), id) == shown.end()) {
        state.tree.columns.push_back(id);
      }
    }
  }
  if (json.contains("recent_files") && json["recent_files"].is_array()) {
    state.recent_files.clear();
    for (const Json& file : json["recent_files"]) {
      if (file.is_string() && state.recent_files.size() < 12) state.recent_files.push_back(file);
    }
  }
}

}  // namespace ui
