// Warnings, errors, and what has been done.
#include <fmt/format.h>

#include "ui/panels.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

constexpr Choice filters[] = {
    {"all", "All", "Everything"},
    {"warnings", "Warnings and errors", "What may need your attention"},
    {"errors", "Errors", "What did not work"},
};

ImVec4 color_of(Severity severity) {
  if (severity == Severity::error) return {1.0f, 0.48f, 0.42f, 1.0f};
  if (severity == Severity::warning) return {0.98f, 0.80f, 0.36f, 1.0f};
  return ImGui::GetStyle().Colors[ImGuiCol_Text];
}

const char* word(Severity severity) {
  return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "info";
}

}  // namespace

void draw_messages(Frame& frame) {
  UiState& state = frame.state;
  std::string chosen(filters[state.message_filter].id);
  if (combo("Show", chosen, std::span<const Choice>(filters), "Which messages are listed")) {
    for (int i = 0; i < 3; ++i) {
      if (filters[i].id == chosen) state.message_filter = i;
    }
  }
  std::vector<size_t> shown;
  for (size_t i = 0; i < state.messages.size(); ++i) {
    if (static_cast<int>(state.messages[i].severity) >= state.message_filter) shown.push_back(i);
  }
  ImGui::SameLine();
  if (button("Copy", "The listed messages, to the clipboard")) {
    std::string text;
    for (const size_t i : shown) {
      text += fmt::format("{}: {}\n", word(state.messages[i].severity), state.messages[i].text);
    }
    ImGui::SetClipboardText(text.c_str());
  }
  ImGui::SameLine();
  if (button("Clear", "Forget all messages")) {
    state.messages.clear();
    shown.clear();
  }
  if (ImGui::BeginChild("list", {0, 0}, true)) {
    if (shown.empty()) hint("No messages.");
    for (const size_t i : shown) {
      ImGui::PushStyleColor(ImGuiCol_Text, color_of(state.messages[i].severity));
      ImGui::TextWrapped("%s: %s", word(state.messages[i].severity),
                         state.messages[i].text.c_str());
      ImGui::PopStyleColor();
    }
    if (ImGui::GetScrollY() >= ImGui::GetScrollMaxY()) ImGui::SetScrollHereY(1.0f);
  }
  ImGui::EndChild();
}

}  // namespace ui
