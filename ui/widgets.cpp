// The wrappers.
#include "ui/widgets.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>
#if __has_include(<imgui_stdlib.h>)
#include <imgui_stdlib.h>
#else
#include <misc/cpp/imgui_stdlib.h>
#endif

#include "ui/registry.h"

namespace ui {
namespace {

using tracer::vec3;

std::string hidden(const char* label) {
  return std::string("##") + label;
}

// After the control: its place, and the same help as on its label.
void finish(const char* label, const char* help) {
  mark(label);
  check_explained(std::string(label) + " 1", help);
  tooltip(help);
}

float encoded(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}
float decoded(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

float brightness(const vec3& linear) {
  return std::max({linear.x, linear.y, linear.z, 1.0f});
}

// The picker works on sRGB 0..1; a light's colour keeps its strength.
bool picker(vec3& linear) {
  const ImVec4 shown = swatch(linear);
  float srgb[3] = {shown.x, shown.y, shown.z};
  const bool changed = ImGui::ColorPicker3("##picker", srgb, ImGuiColorEditFlags_NoSidePreview);
  mark("picker");
  if (changed) {
    linear = brightness(linear) * vec3(decoded(srgb[0]), decoded(srgb[1]), decoded(srgb[2]));
  }
  return changed;
}

// The entries of an open combo box; ends its scope before the popup ends.
bool pick_choice(const char* label, std::string& id, std::span<const Choice> choices) {
  bool changed = false;
  const Scope scope(label);
  for (const Choice& choice : choices) {
    const bool chosen = choice.id == id;
    if (ImGui::Selectable(std::string(choice.label).c_str(), chosen) && !chosen) {
      id = choice.id;
      changed = true;
    }
    mark(choice.id);
    tooltip(choice.help);
    if (chosen && ImGui::IsWindowAppearing()) ImGui::SetScrollHereY(0.5f);
  }
  return changed;
}

}  // namespace

void tooltip(std::string_view help) {
  if (help.empty() || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  if (ImGui::IsMouseDown(0)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(26.0f * em());
  ImGui::TextUnformatted(help.data(), help.data() + help.size());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

bool button(const char* label, const char* help, float width) {
  const bool pressed = ImGui::Button(label, {width, 0});
  finish(label, help);
  return pressed;
}

bool menu_item(const char* label, const char* keys, const char* help, bool chosen, bool enabled) {
  const bool pressed = ImGui::MenuItem(label, keys, chosen, enabled);
  finish(label, help);
  return pressed;
}

void row_label(const char* label, const char* help) {
  const float width = ImGui::GetContentRegionAvail().x;
  const float left = ImGui::GetCursorPosX();
  const float column = std::min(0.42f * width, 9.5f * em());
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(label);
  tooltip(help);
  ImGui::SameLine(left + column);
  ImGui::SetNextItemWidth(std::min(width - column, 24.0f * em()));
}

bool checkbox(const char* label, bool& value, const char* help) {
  row_label(label, help);
  const bool changed = ImGui::Checkbox(hidden(label).c_str(), &value);
  finish(label, help);
  return changed;
}

bool tick(const char* label, bool& value, const char* help) {
  const bool changed = ImGui::Checkbox(label, &value);
  finish(label, help);
  return changed;
}

bool slider(const char* label, float& value, float lo, float hi, const char* help,
            const char* format, bool logarithmic) {
  row_label(label, help);
  const ImGuiSliderFlags flags =
      ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  const bool changed = ImGui::SliderFloat(hidden(label).c_str(), &value, lo, hi, format, flags);
  finish(label, help);
  return changed;
}

bool slider(const char* label, int& value, int lo, int hi, const char* help, bool logarithmic) {
  row_label(label, help);
  const ImGuiSliderFlags flags =
      ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  const bool changed = ImGui::SliderInt(hidden(label).c_str(), &value, lo, hi, "%d", flags);
  finish(label, help);
  return changed;
}

bool slider(const char* label, uint32_t& value, uint32_t lo, uint32_t hi, const char* help) {
  int number = static_cast<int>(value);
  const bool changed = slider(label, number, static_cast<int>(lo), static_cast<int>(hi), help);
  if (changed) value = static_cast<uint32_t>(number);
  return changed;
}

bool drag(const char* label, float& value, float speed, float lo, float hi, const char* help,
          const char* format) {
  row_label(label, help);
  const bool changed = ImGui::DragFloat(hidden(label).c_str(), &value, speed, lo, hi, format,
                                        ImGuiSliderFlags_AlwaysClamp);
  finish(label, help);
  return changed;
}

bool drag(const char* label, int& value, int lo, int hi, const char* help) {
  row_label(label, help);
  const bool changed = ImGui::DragInt(hidden(label).c_str(), &value, 1.0f, lo, hi, "%d",
                                      ImGuiSliderFlags_AlwaysClamp);
  finish(label, help);
  return changed;
}

bool drag3(const char* label, vec3& value, float speed, const char* help, const char* format) {
  row_label(label, help);
  vec3 edited = value;
  const bool changed =
      ImGui::DragFloat3(hidden(label).c_str(), &edited.x, speed, 0.0f, 0.0f, format);
  finish(label, help);
  if (!changed || !std::isfinite(edited.x + edited.y + edited.z)) return false;
  value = edited;
  return true;
}

bool color(const char* label, vec3& linear, const char* help) {
  row_label(label, help);
  const Scope scope(label);
  const float swatch_width = ImGui::GetFrameHeight();
  ImGui::SetNextItemWidth(ImGui::CalcItemWidth() - swatch_width -
                          ImGui::GetStyle().ItemInnerSpacing.x);
  vec3 edited = linear;
  const float speed = 0.005f * brightness(linear);
  bool changed = ImGui::DragFloat3("##numbers", &edited.x, speed, 0.0f, 1e9f, "%.3g",
                                   ImGuiSliderFlags_AlwaysClamp);
  finish("numbers", help);
  if (changed && std::isfinite(edited.x + edited.y + edited.z)) linear = edited;
  ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
  if (ImGui::ColorButton("##swatch", swatch(linear), ImGuiColorEditFlags_NoTooltip,
                         {swatch_width, swatch_width})) {
    ImGui::OpenPopup("picker");
  }
  finish("swatch", "Choose the colour");
  if (ImGui::BeginPopup("picker")) {
    changed |= picker(linear);
    ImGui::EndPopup();
  }
  return changed;
}

bool input(const char* label, std::string& text, const char* hint, const char* help) {
  row_label(label, help);
  const bool changed = ImGui::InputTextWithHint(hidden(label).c_str(), hint, &text);
  finish(label, help);
  return changed;
}

bool combo(const char* label, std::string& id, std::span<const Choice> choices, const char* help) {
  row_label(label, help);
  std::string shown = id;
  std::string_view about;
  for (const Choice& choice : choices) {
    if (choice.id != id) continue;
    shown = choice.label;
    about = choice.help;
  }
  const bool open =
      ImGui::BeginCombo(hidden(label).c_str(), shown.c_str(), ImGuiComboFlags_HeightLarge);
  if (!open) {
    mark(label);
    tooltip(about.empty() ? std::string(help) : fmt::format("{}\n\n{}: {}", help, shown, about));
    return false;
  }
  const bool changed = pick_choice(label, id, choices);
  ImGui::EndCombo();
  return changed;
}

void tick(std::set<std::string, std::less<>>& ids, std::string_view id, std::string_view label,
          std::string_view help, bool inverted) {
  bool on = ids.contains(id) != inverted;
  if (ImGui::Checkbox(std::string(label).c_str(), &on)) {
    if (on != inverted) {
      ids.emplace(id);
    } else {
      ids.erase(std::string(id));
    }
  }
  mark(id);
  tooltip(help);
}

void text_row(const char* label, std::string_view text, const char* help) {
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0, 0));
  row_label(label, help);
  ImGui::PopStyleVar();
  ImGui::PushTextWrapPos(0.0f);
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  ImGui::PopTextWrapPos();
  finish(label, help);
}

void heading(const char* text) {
  ImGui::Dummy({0, 0.15f * em()});
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::PushStyleColor(ImGuiCol_Text, {0.55f, 0.72f, 0.90f, 1.0f});
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
  const float y = std::floor(from.y + 0.55f * em()) + 0.5f;
  const float begin = ImGui::GetItemRectMax().x + 0.5f * em();
  const float end = from.x + ImGui::GetContentRegionAvail().x;
  if (end > begin) {
    ImGui::GetWindowDrawList()->AddLine({begin, y}, {end, y},
                                        ImGui::GetColorU32(ImGuiCol_Separator));
  }
}

void hint(std::string_view text, std::string_view help) {
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyle().Colors[ImGuiCol_TextDisabled]);
  ImGui::PushTextWrapPos(0.0f);
  ui::text(text, help);
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

void text(std::string_view text, std::string_view help) {
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  check_explained(text, help);
  tooltip(help);
}

void header(const char* label, std::string_view help) {
  ImGui::TableNextColumn();
  ImGui::TableHeader(label);
  mark(std::string("column ") + label);
  if (!help.empty()) explain_column();
  tooltip(help);
}

void cell(std::string_view text) {
  if (ImGui::TableNextColumn()) cell_text(text);
}

void cell_text(std::string_view text) {
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  check_cell_explained(text);
}

std::string grouped(uint64_t number) {
  std::string digits = std::to_string(number);
  for (size_t at = digits.size(); at > 3; at -= 3)
    digits.insert(at - 3, ",");
  return digits;
}

std::string byte_size(uint64_t bytes) {
  const double size = static_cast<double>(bytes);
  if (bytes < 1024) return fmt::format("{} B", bytes);
  if (bytes < 1024 * 1024) return fmt::format("{:.1f} KiB", size / 1024.0);
  if (bytes < 1024ull * 1024 * 1024) return fmt::format("{:.1f} MiB", size / (1024.0 * 1024.0));
  return fmt::format("{:.2f} GiB", size / (1024.0 * 1024.0 * 1024.0));
}

std::string short_number(double number) {
  const double size = std::abs(number);
  if (size != 0.0 && (size < 1e-3 || size >= 1e7)) return fmt::format("{:.3e}", number);
  if (size >= 1000.0) return fmt::format("{:.0f}", number);
  return fmt::format("{:.4g}", number);
}

ImVec4 swatch(vec3 linear) {
  linear = glm::max(linear, vec3(0.0f)) / brightness(linear);
  return {encoded(linear.x), encoded(linear.y), encoded(linear.z), 1.0f};
}

}  // namespace ui
