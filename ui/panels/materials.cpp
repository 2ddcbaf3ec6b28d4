// All materials, and what the chosen one does with light.
#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "ui/panels.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::vector<uint32_t> matching(const std::vector<tracer::Material>& materials,
                               const std::string& filter) {
  const std::string wanted = lower(filter);
  std::vector<uint32_t> found;
  for (uint32_t i = 0; i < materials.size(); ++i) {
    if (lower(materials[i].name).find(wanted) != std::string::npos) found.push_back(i);
  }
  return found;
}

// What the material looks like from afar: its albedo with the mean of its texture.
tracer::vec3 mean_color(const Frame& frame, const tracer::Material& material) {
  if (!frame.snapshot.scene || !material.use_texture ||
      material.texture >= frame.snapshot.scene->textures.size()) {
    return material.albedo;
  }
  const tracer::Texture& texture = frame.snapshot.scene->textures[material.texture];
  constexpr int steps = 8;
  tracer::vec3 sum(0.0f);
  for (int i = 0; i < steps * steps; ++i) {
    const tracer::vec2 place(static_cast<float>(i % steps), static_cast<float>(i) / steps);
    sum += tracer::sample(texture, (place + 0.5f) / static_cast<float>(steps));
  }
  return material.albedo * sum / static_cast<float>(steps * steps);
}

void draw_row(Frame& frame, const tracer::Material& material, uint32_t index) {
  const Scope scope("material", index);
  const float side = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const std::string label =
      (material.name.empty() ? fmt::format("material {}", index) : material.name) + "###row";
  const float indent = side + 0.5f * em();
  ImGui::SetCursorScreenPos({at.x + indent, at.y});
  if (ImGui::Selectable(label.c_str(), frame.state.edited_material == index)) {
    frame.state.edited_material = index;
    frame.state.selection.material = index;
  }
  mark("Select");
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + side, at.y + side},
                                            ImGui::GetColorU32(swatch(mean_color(frame, material))),
                                            3.0f);
}

void draw_list(Frame& frame, const std::vector<tracer::Material>& materials) {
  input("Filter", frame.state.material_filter, "part of a name",
        "Show the materials with this name");
  const std::vector<uint32_t> found = matching(materials, frame.state.material_filter);
  hint(fmt::format("{} of {} materials", found.size(), materials.size()),
       "Those that the filter leaves, of all there are");
  const float rows = std::clamp(static_cast<float>(found.size()), 2.0f, 8.0f);
  const float height = (rows + 0.6f) * ImGui::GetTextLineHeightWithSpacing();
  if (ImGui::BeginChild("list", {0, height}, true)) {
    const uint32_t wanted = frame.state.edited_material;
    if (frame.state.show_material) {
      const auto place = std::find(found.begin(), found.end(), wanted);
      const float line = ImGui::GetTextLineHeightWithSpacing();
      ImGui::SetScrollY(line * static_cast<float>(place - found.begin()) - 0.4f * height);
      frame.state.show_material = false;
    }
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(found.size()));
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        draw_row(frame, materials[found[i]], found[i]);
      }
    }
  }
  ImGui::EndChild();
}

void draw_kinds(tracer::Material& material) {
  if (button("Matte", "Neither mirror nor glass")) {
    material.reflectivity = material.transmission = 0.0f;
  }
  ImGui::SameLine();
  if (button("Mirror", "All light is mirrored")) {
    material.reflectivity = 1.0f;
    material.transmission = 0.0f;
  }
  ImGui::SameLine();
  if (button("Glass", "All light enters, or is mirrored by Fresnel's law")) {
    material.reflectivity = 0.0f;
    material.transmission = 1.0f;
  }
}

void draw_editor(Frame& frame, tracer::Material& material) {
  heading(material.name.empty() ? "Material" : material.name.c_str());
  draw_kinds(material);
  color("Albedo", material.albedo, "Linear diffuse colour; multiplied with the texture");
  const bool has_texture =
      frame.snapshot.scene && material.texture < frame.snapshot.scene->textures.size();
  if (has_texture) {
    checkbox("Texture", material.use_texture, "Multiply the albedo with the texture");
    const tracer::Texture& texture = frame.snapshot.scene->textures[material.texture];
    text_row("Image", fmt::format("{} ({} x {})", texture.name, texture.width, texture.height),
             "The texture, its width and height in pixels");
  }
  if (slider("Mirror share", material.reflectivity, 0.0f, 1.0f,
             "Share of the light that is mirrored; the rest is diffuse, or enters as glass")) {
    material.transmission = std::min(material.transmission, 1.0f - material.reflectivity);
  }
  if (slider("Glass share", material.transmission, 0.0f, 1.0f,
             "Share of the light that enters the surface as into glass")) {
    material.reflectivity = std::min(material.reflectivity, 1.0f - material.transmission);
  }
  slider("Index", material.refraction_index, 1.0f, 3.0f,
         "Refraction index of the inside: air 1, water 1.33, glass 1.5, diamond 2.4");
  color("Specular", material.specular, "Linear colour that tints what is mirrored or refracted");
  color("Emission", material.emission, "Linear radiance that the surface itself gives off");
  const bool known =
      frame.snapshot.scene && frame.state.edited_material < frame.snapshot.scene->materials.size();
  if (known && button("As loaded", "Take all edits of this material back")) {
    material = frame.snapshot.scene->materials[frame.state.edited_material];
  }
}

}  // namespace

void draw_materials(Frame& frame) {
  if (!frame.edited.settings.look) {
    hint("The materials appear with the scene.");
    return;
  }
  std::vector<tracer::Material>& materials = frame.edited.settings.look->materials;
  draw_list(frame, materials);
  if (frame.state.edited_material < materials.size()) {
    const Scope scope("edit");
    draw_editor(frame, materials[frame.state.edited_material]);
  } else {
    hint("Choose a material above, or click a surface in the picture.");
  }
}

}  // namespace ui
