// Records rectangles of widgets.
#include "ui/registry.h"

namespace ui {

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
