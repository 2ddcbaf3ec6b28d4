// Records rectangles of widgets.
#include "ui/registry.h"

namespace ui {
namespace {

// Of the table's column that is being drawn, with its panel.
std::string column_name(const Registry& seen) {
  return seen.scope.substr(0, seen.scope.find('/')) + "/" + ImGui::TableGetColumnName();
}

}  // namespace

Registry* registry() {
  return static_cast<Registry*>(ImGui::GetIO().UserData);
}

void mark(std::string_view label, ImVec2 lo, ImVec2 hi) {
  Registry* seen = registry();
  if (seen == nullptr) return;
  const std::string name = seen->scope + std::string(label);
  Item& item = seen->items[name];
  item = {lo, hi, ImGui::GetFrameCount(), ImGui::IsRectVisible(lo, hi)};
  if (name == seen->scroll_to) {
    ImGui::SetScrollHereY(0.5f);
    seen->scroll_to.clear();
  }
}

void mark(std::string_view label) {
  if (registry() != nullptr) mark(label, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
}

void check_explained(std::string_view text, std::string_view help) {
  Registry* seen = registry();
  if (seen == nullptr || !help.empty()) return;
  if (text.find_first_of("0123456789") == std::string_view::npos) return;
  seen->unexplained.insert(seen->scope + std::string(text));
}

void explain_column() {
  if (Registry* seen = registry()) seen->explained_columns.insert(column_name(*seen));
}

void check_cell_explained(std::string_view text) {
  Registry* seen = registry();
  if (seen == nullptr || seen->explained_columns.contains(column_name(*seen))) return;
  check_explained(text, "");
}

Scope::Scope(std::string_view name) {
  ImGui::PushID(name.data(), name.data() + name.size());
  if (Registry* seen = registry()) {
    outer_length_ = seen->scope.size();
    seen->scope.append(name).append("/");
  }
}

Scope::Scope(std::string_view name, size_t index)
    : Scope(std::string(name) + " " + std::to_string(index + 1)) {}

Scope::~Scope() {
  if (Registry* seen = registry()) seen->scope.resize(outer_length_);
  ImGui::PopID();
}

}  // namespace ui
