// The file browser's window.
#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <imgui.h>
#if __has_include(<imgui_stdlib.h>)
#include <imgui_stdlib.h>
#else
#include <misc/cpp/imgui_stdlib.h>
#endif

#include "ui/browse.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

namespace fs = std::filesystem;

constexpr size_t max_recent_files = 12;

void remember(UiState& state, const std::string& file) {
  std::vector<std::string>& files = state.recent_files;
  files.erase(std::remove(files.begin(), files.end(), file), files.end());
  files.insert(files.begin(), file);
  if (files.size() > max_recent_files) files.resize(max_recent_files);
}

void hand_on(Frame& frame, const fs::path& file) {
  const std::string name = file.string();
  switch (frame.state.browser.purpose) {
    case FilePurpose::open_scene:
      remember(frame.state, name);
      frame.requests.open = name;
      break;
    case FilePurpose::open_sky:
      frame.edited.settings.source.sky_file = name;
      if (frame.edited.settings.look) frame.edited.settings.look->sky.on = true;
      break;
    case FilePurpose::save_picture:
      frame.requests.save_picture = name;
      break;
    case FilePurpose::open_session:
      frame.requests.open_session = name;
      break;
    case FilePurpose::save_session:
      frame.requests.save_session = name;
      break;
  }
}

// The folder's path, each part a button.
void draw_breadcrumbs(FileBrowser& browser) {
  const Scope scope("path");
  const fs::path shown = browser.folder;
  fs::path chosen, built;
  const float right = ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x;
  int index = 0;
  for (const fs::path& part : shown) {
    if (part.empty()) continue;
    built /= part;
    const std::string name = part.string();
    if (index > 0) {
      ImGui::SameLine(0, 0.2f * em());
      const float width = ImGui::CalcTextSize(name.c_str()).x + em();
      if (ImGui::GetCursorScreenPos().x + width > right) ImGui::NewLine();
    }
    ImGui::PushID(index++);
    if (ImGui::Button(name.c_str())) chosen = built;
    mark(name);
    ImGui::PopID();
  }
  if (!chosen.empty()) enter_folder(browser, chosen);
}

void draw_places(Frame& frame, std::optional<fs::path>& chosen) {
  FileBrowser& browser = frame.state.browser;
  const Scope scope("places");
  heading("Places");
  if (const char* home = std::getenv("HOME")) {
    if (ImGui::Selectable("Home")) enter_folder(browser, home);
    mark("Home");
  }
  if (ImGui::Selectable("Start folder")) {
    std::error_code error;
    enter_folder(browser, fs::current_path(error));
  }
  mark("Start folder");
  tooltip("The folder that the program was started in");
  if (ImGui::Selectable("/")) enter_folder(browser, "/");
  if (browser.purpose != FilePurpose::open_scene || frame.state.recent_files.empty()) return;
  heading("Recent");
  for (const std::string& file : frame.state.recent_files) {
    ImGui::PushID(file.c_str());
    if (ImGui::Selectable(fs::path(file).filename().c_str())) chosen = file;
    mark(file);
    tooltip(file);
    ImGui::PopID();
  }
}

// The names of the folder; a click fills in the name, a double click takes it.
void draw_entries(FileBrowser& browser, std::optional<fs::path>& chosen) {
  const Scope scope("files");
  if (browser.entries.empty()) {
    hint(fmt::format("No folders and no {} here. Tick \"All files\" to see the rest.",
                     purpose_row(browser.purpose).what));
    return;
  }
  const ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY;
  if (!ImGui::BeginTable("entries", 2, flags)) return;
  ImGui::TableSetupColumn("Name", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("Size", ImGuiTableColumnFlags_WidthFixed, 6.0f * em());
  fs::path entered;
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(browser.entries.size()));
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const FileEntry& entry = browser.entries[i];
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      const std::string shown = entry.folder ? entry.name + "/" : entry.name;
      const bool selected = browser.typed == entry.name;
      const ImGuiSelectableFlags row =
          ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowDoubleClick;
      ImGui::PushID(i);
      if (ImGui::Selectable(shown.c_str(), selected, row)) {
        if (entry.folder) {
          entered = browser.folder / entry.name;
        } else {
          browser.typed = entry.name;
          browser.confirm = false;
          if (ImGui::IsMouseDoubleClicked(0)) chosen = browser.folder / entry.name;
        }
      }
      mark(entry.name);
      ImGui::PopID();
      ImGui::TableNextColumn();
      if (!entry.folder) hint(byte_size(entry.bytes));
    }
  }
  ImGui::EndTable();
  if (!entered.empty()) enter_folder(browser, entered);
}

// The line to type in, and the buttons.
void draw_bottom(FileBrowser& browser, const PurposeRow& row, std::optional<fs::path>& chosen) {
  if (!browser.error.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, {1.0f, 0.55f, 0.45f, 1.0f});
    ImGui::TextWrapped("%s", browser.error.c_str());
    ImGui::PopStyleColor();
  }
  if (browser.confirm) ImGui::TextWrapped("%s exists. Replace it?", browser.typed.c_str());
  const float button_width = 6.5f * em();
  const float spacing = ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 2.0f * (button_width + spacing));
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  const std::string before = browser.typed;
  const bool entered = ImGui::InputTextWithHint("##name", "Name or path", &browser.typed,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  if (browser.typed != before) browser.confirm = false;
  mark("name");
  tooltip("A name in this folder, or a path; Enter takes it or enters a folder");
  ImGui::SameLine();
  const char* accept = browser.confirm ? "Replace" : row.accept;
  const bool accepted = button(accept, "Take this file", button_width);
  if (entered || accepted) {
    if (const std::optional<fs::path> taken = take_typed(browser)) chosen = taken;
  }
  ImGui::SameLine();
  if (button("Cancel", "Close this window", button_width)) browser.visible = false;
  if (ImGui::Checkbox("All files", &browser.all_files)) enter_folder(browser, browser.folder);
  mark("All files");
  tooltip("Not only files with a known ending");
  ImGui::SameLine();
  std::string endings;
  for (const std::string& ending : row.endings)
    endings += " *" + ending;
  hint("Known here:" + endings);
}

bool escape_pressed(const Frame& frame) {
  return std::any_of(frame.keys.begin(), frame.keys.end(),
                     [](const KeyPress& pressed) { return pressed.key == key_escape; });
}

void draw_contents(Frame& frame, const PurposeRow& row) {
  FileBrowser& browser = frame.state.browser;
  const Scope scope("browser");
  std::optional<fs::path> chosen;
  draw_breadcrumbs(browser);
  const float below = (browser.error.empty() && !browser.confirm ? 2.0f : 4.0f) *
                      ImGui::GetFrameHeightWithSpacing();
  const float height = -below - ImGui::GetStyle().ItemSpacing.y;
  if (ImGui::BeginChild("places", {13.0f * em(), height}, true)) draw_places(frame, chosen);
  ImGui::EndChild();
  ImGui::SameLine();
  if (ImGui::BeginChild("files", {0, height}, true)) draw_entries(browser, chosen);
  ImGui::EndChild();
  draw_bottom(browser, row, chosen);
  if (escape_pressed(frame)) browser.visible = false;
  if (chosen) {
    hand_on(frame, *chosen);
    browser.visible = false;
  }
}

}  // namespace

void draw_browser(Frame& frame) {
  FileBrowser& browser = frame.state.browser;
  const char* id = "###file browser";
  const PurposeRow row = purpose_row(browser.purpose);
  const std::string title = std::string(row.title) + id;
  if (browser.opening) {
    ImGui::OpenPopup(title.c_str());
    browser.opening = false;
    browser.visible = true;
  }
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const ImVec2 size = {std::min(50.0f * em(), 0.95f * display.x),
                       std::min(34.0f * em(), 0.9f * display.y)};
  ImGui::SetNextWindowSize(size, ImGuiCond_Appearing);
  ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
  if (!ImGui::BeginPopupModal(title.c_str(), &browser.visible, ImGuiWindowFlags_NoSavedSettings)) {
    browser.visible = false;
    return;
  }
  draw_contents(frame, row);
  if (!browser.visible) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

}  // namespace ui
