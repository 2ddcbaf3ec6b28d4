// Where the widgets are on the screen, by label: how tests find what to click.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

#include <imgui.h>

namespace ui {

struct Item {
  ImVec2 lo{0, 0}, hi{0, 0};
  int frame = -1;        // in which it was drawn last
  bool visible = false;  // some of it is inside its window
};

// Hung into ImGuiIO::UserData by whoever wants to know; without one nothing is recorded.
struct Registry {
  std::map<std::string, Item, std::less<>> items;  // "lights/light 1/intensity"
  std::string scope;                               // "lights/light 1/"
  std::string scroll_to;                           // an item whose window shall scroll to it
  std::set<std::string, std::less<>> unexplained;  // texts with a number that no tooltip defines
  std::set<std::string, std::less<>> explained_columns;  // of tables, whose header has a tooltip
};

Registry* registry();

// Records the last item, or a rectangle, under the current scope.
void mark(std::string_view label);
void mark(std::string_view label, ImVec2 lo, ImVec2 hi);

// Notes a text with a digit whose help is empty; for a cell of a table its column's header helps.
void check_explained(std::string_view text, std::string_view help);
void check_cell_explained(std::string_view text);
void explain_column();

// While it lives, ImGui's ids and the recorded labels are under `name`.
class Scope {
 public:
  explicit Scope(std::string_view name);
  Scope(std::string_view name, size_t index);
  ~Scope();
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;

 private:
  size_t outer_length_ = 0;
};

}  // namespace ui
