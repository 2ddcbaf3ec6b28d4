// Moves, shows and hides panels.
#include "ui/layout.h"

#include <algorithm>

#include "ui/panels.h"

namespace ui {
namespace {

// After a panel left a region, the first one that is still there comes to the front.
void choose_front(Layout& layout, Region region, std::string_view gone) {
  std::string& front = layout.front[static_cast<int>(region)];
  if (front != gone) return;
  front.clear();
  for (const PanelPlace& place : layout.panels) {
    if (place.shown && place.region == region && place.panel != gone) {
      front = place.panel;
      layout.raise[static_cast<int>(region)] = true;
      return;
    }
  }
}

}  // namespace

Layout default_layout() {
  Layout layout;
  for (const PanelRow& row : panels()) {
    layout.panels.push_back({row.id, row.region, true});
    std::string& front = layout.front[static_cast<int>(row.region)];
    if (front.empty()) front = row.id;
  }
  layout.raise.fill(true);
  return layout;
}

PanelPlace* find_place(Layout& layout, std::string_view panel) {
  for (PanelPlace& place : layout.panels) {
    if (place.panel == panel) return &place;
  }
  return nullptr;
}

bool is_shown(const Layout& layout, std::string_view panel) {
  return std::any_of(layout.panels.begin(), layout.panels.end(),
                     [&](const PanelPlace& place) { return place.shown && place.panel == panel; });
}

void show_panel(Layout& layout, std::string_view panel) {
  PanelPlace* place = find_place(layout, panel);
  if (place == nullptr) return;
  place->shown = true;
  layout.front[static_cast<int>(place->region)] = place->panel;
  layout.raise[static_cast<int>(place->region)] = true;
}

void hide_panel(Layout& layout, std::string_view panel) {
  PanelPlace* place = find_place(layout, panel);
  if (place == nullptr) return;
  place->shown = false;
  choose_front(layout, place->region, panel);
}

void move_panel(Layout& layout, std::string_view panel, Region region) {
  PanelPlace* place = find_place(layout, panel);
  if (place == nullptr) return;
  choose_front(layout, place->region, panel);
  place->region = region;
  // The newcomer is the last tab of its region.
  std::rotate(layout.panels.begin() + (place - layout.panels.data()),
              layout.panels.begin() + (place - layout.panels.data()) + 1, layout.panels.end());
  show_panel(layout, panel);
}

}  // namespace ui
