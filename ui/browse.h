// The file browser's behaviour; its state is in file_browser.h.
#pragma once

#include <optional>
#include <span>

#include "ui/workspace_state.h"

namespace ui {

struct PurposeRow {
  FilePurpose purpose;
  const char *title, *accept, *what;
  bool save;
  std::vector<std::string> endings;  // with the dot, lower case; the first is added when missing
};
PurposeRow purpose_row(FilePurpose purpose);

void open_browser(FileBrowser& browser, FilePurpose purpose);

// Lists a folder; on failure the old one stays and `error` says why.
void enter_folder(FileBrowser& browser, const std::filesystem::path& folder);

// What typing a name or path and pressing Enter does: enters a folder, or gives the chosen file, or
// sets `error` or `confirm`.
std::optional<std::filesystem::path> take_typed(FileBrowser& browser);

// Draws the popup, if it is open, and hands the chosen file on.
void draw_browser(Frame& frame);

}  // namespace ui
