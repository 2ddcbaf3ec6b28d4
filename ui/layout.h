// Where the panels are: four regions, each a tab bar, with draggable borders.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace ui {

enum class Region { left, centre, right, bottom };
inline constexpr int region_count = 4;
inline constexpr std::array<const char*, region_count> region_names = {"left", "centre", "right",
                                                                       "bottom"};

struct PanelPlace {
  std::string panel;  // id of a PanelRow
  Region region = Region::right;
  bool shown = true;
  bool operator==(const PanelPlace&) const = default;
};

// Sizes are in unscaled pixels, so a layout survives a change of the scale.
struct Layout {
  float left = 330.0f;
  float right = 340.0f;
  float bottom = 230.0f;
  std::vector<PanelPlace> panels;               // in the order of their tabs
  std::array<std::string, region_count> front;  // the chosen tab of each region
  std::array<bool, region_count> raise = {};    // bring `front` to the front in the next frame

  bool operator==(const Layout&) const = default;
};

Layout default_layout();

PanelPlace* find_place(Layout& layout, std::string_view panel);
bool is_shown(const Layout& layout, std::string_view panel);

// Shows the panel in its region and brings it to the front.
void show_panel(Layout& layout, std::string_view panel);
void hide_panel(Layout& layout, std::string_view panel);
void move_panel(Layout& layout, std::string_view panel, Region region);

}  // namespace ui
