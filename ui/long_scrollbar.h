// The scroll bar of a list of many millions of rows: ImGui's own has floats for positions, which
// jump there.
#pragma once

#include <imgui.h>

namespace ui {

// `top`: the first row on the screen; `page`: how many there are. The wheel turns it where the
// mouse is over the list, from `lo` to `hi`.
struct LongList {
  double rows = 0.0, page = 1.0;
  ImVec2 lo{0, 0}, hi{0, 0};
};
void long_scrollbar(const char* label, double& top, const LongList& list, ImVec2 at, ImVec2 size,
                    const char* help);

}  // namespace ui
