// Point lights, ambient light and the sky.
#include <algorithm>

#include <fmt/format.h>

#include "ui/actions.h"
#include "ui/panels.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

void add_light(Frame& frame, std::vector<tracer::Light>& lights) {
  tracer::Light light;
  const float size = scene_size(frame.snapshot);
  light.name = fmt::format("light {}", lights.size() + 1);
  if (frame.snapshot.bvh) {
    light.position = tracer::center(tracer::bounds(*frame.snapshot.bvh)) +
                     0.4f * size * glm::vec3(0.3f, 1.0f, 0.3f);
  }
  light.intensity = 0.5f * size * size;  // bright enough at the scene's distance
  frame.state.selection = {};
  frame.state.selection.light = static_cast<uint32_t>(lights.size());
  lights.push_back(light);
}

// Returns true if the light shall go.
bool draw_light(Frame& frame, tracer::Light& light, uint32_t index) {
  const Scope scope("light", index);
  uint32_t& selected = frame.state.selection.light;
  ImGui::Checkbox("##on", &light.on);
  mark("On");
  tooltip("Whether the light shines");
  ImGui::SameLine();
  ImGui::PushStyleColor(ImGuiCol_Header, ImGui::GetStyle().Colors[ImGuiCol_FrameBg]);
  const std::string shown = (light.name.empty() ? std::string("light") : light.name) + "###name";
  const bool was = selected == index;
  if (ImGui::Selectable(shown.c_str(), was)) {
    frame.state.selection = {};
    selected = was ? tracer::none : index;
  }
  ImGui::PopStyleColor();
  mark("Select");
  tooltip("Select the light; its handle in the picture is lit");
  ImGui::Indent();
  const float speed = 0.002f * scene_size(frame.snapshot);
  drag3("Position", light.position, speed, "World units; its handle in the picture can be dragged");
  color("Colour", light.color,
        "Linear red, green, blue; irradiance at distance d is colour x "
        "intensity x cos / d²");
  drag("Intensity", light.intensity, std::max(0.005f * light.intensity, 0.001f), 0.0f, 1e9f,
       "Multiplies the colour", "%.4g");
  if (selected == index) input("Name", light.name, "name", "Only for you to tell lights apart");
  const bool remove = button("Remove", "Take this light out of the scene");
  ImGui::Unindent();
  return remove;
}

void draw_sky(Frame& frame, tracer::Look& look) {
  heading("Sky");
  checkbox("Sky on", look.sky.on, "What rays see that hit nothing; off: black");
  slider("Rotation", look.sky.rotation_degrees, -180.0f, 180.0f, "About the up axis (+y)", "%.1f°");
  slider("Strength", look.sky.intensity, 0.0f, 20.0f, "Multiplies the sky's radiance", "%.3f",
         true);
  const bool has_image = frame.snapshot.scene && !frame.snapshot.scene->sky_image.texels.empty();
  if (!has_image) color("Flat colour", look.sky.flat_color, "Linear radiance of the whole sky");
  std::string& file = frame.edited.settings.source.sky_file;
  const std::string image =
      has_image ? frame.snapshot.scene->sky_image.name : std::string("none, a flat colour");
  text_row("Image", image, "The equirectangular picture on the sky");
  if (button("Open sky...", "Another sky: an equirectangular .hdr file")) {
    browse(frame, FilePurpose::open_sky);
  }
  if (!file.empty()) {
    ImGui::SameLine();
    if (button("Scene's own sky", "Without the opened file")) file.clear();
  }
}

}  // namespace

void draw_lights(Frame& frame) {
  if (!frame.edited.settings.look) {
    hint("The lights appear with the scene.");
    return;
  }
  tracer::Look& look = *frame.edited.settings.look;
  heading("Point lights");
  if (look.lights.empty()) hint("No light: the scene is lit by its ambient light and the sky.");
  size_t removed = look.lights.size();
  for (uint32_t i = 0; i < look.lights.size(); ++i) {
    if (draw_light(frame, look.lights[i], i)) removed = i;
  }
  if (removed < look.lights.size()) {
    look.lights.erase(look.lights.begin() + static_cast<std::ptrdiff_t>(removed));
    frame.state.selection.light = tracer::none;
  }
  if (button("Add a light", "A new point light above the scene")) add_light(frame, look.lights);
  heading("Ambient");
  color("Ambient", look.ambient,
        "Linear radiance that reaches every diffuse surface, shadow or not");
  draw_sky(frame, look);
}

}  // namespace ui
