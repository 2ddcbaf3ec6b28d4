// Thin wrappers of ImGui's widgets: a label on the left, the control on the right, a tooltip that
// explains it, and a record of where it is (registry.h).
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <imgui.h>

#include "tracer/math/types.h"

namespace ui {

// The size of a text line: what all lengths of ours are multiples of.
inline float em() {
  return ImGui::GetFontSize();
}

// Of the last item; long texts are wrapped.
void tooltip(std::string_view help);

bool button(const char* label, const char* help, float width = 0.0f);
bool menu_item(const char* label, const char* keys, const char* help, bool chosen = false,
               bool enabled = true);

// All return true in the frame in which they change the value.
bool checkbox(const char* label, bool& value, const char* help);
// The same with the label behind the box, where rows have no columns.
bool tick(const char* label, bool& value, const char* help);
bool slider(const char* label, float& value, float lo, float hi, const char* help,
            const char* format = "%.3f", bool logarithmic = false);
bool slider(const char* label, int& value, int lo, int hi, const char* help,
            bool logarithmic = false);
bool slider(const char* label, uint32_t& value, uint32_t lo, uint32_t hi, const char* help);
bool drag(const char* label, float& value, float speed, float lo, float hi, const char* help,
          const char* format = "%.3f");
bool drag(const char* label, int& value, int lo, int hi, const char* help);
bool drag3(const char* label, tracer::vec3& value, float speed, const char* help,
           const char* format = "%.3f");
// Linear red, green, blue as numbers, beside a swatch that opens a picker; no upper limit.
bool color(const char* label, tracer::vec3& linear, const char* help);
bool input(const char* label, std::string& text, const char* hint, const char* help);

struct Choice {
  std::string_view id, label, help;
};
bool combo(const char* label, std::string& id, std::span<const Choice> choices, const char* help);

// One entry for each row of a table (tracer/choice.h).
template <class Row>
std::vector<Choice> choices_of(std::span<const Row> rows) {
  std::vector<Choice> choices;
  for (const Row& row : rows)
    choices.push_back({row.id, row.label, row.help});
  return choices;
}
template <class Row>
bool combo(const char* label, std::string& id, std::span<const Row> rows, const char* help) {
  const std::vector<Choice> choices = choices_of(rows);
  return combo(label, id, std::span<const Choice>(choices), help);
}

// Ticked if `ids` has the id; inverted: if it has not.
void tick(std::set<std::string, std::less<>>& ids, std::string_view id, std::string_view label,
          std::string_view help, bool inverted);

// A label and a text that can be read but not edited.
void text_row(const char* label, std::string_view text, const char* help);
void heading(const char* text);
// What an empty panel says, or a figure in passing; numbers need a help.
void hint(std::string_view text, std::string_view help = {});

// A text that may have numbers; wrapped as ImGui is told to.
void text(std::string_view text, std::string_view help);

// Of a table: the next column's header, and a text in the next column, which is explained by that;
// cell_text stays in its column.
void header(const char* label, std::string_view help);
void cell(std::string_view text);
void cell_text(std::string_view text);

// Begins a row: the label, then the place and width of the control.
void row_label(const char* label, const char* help);

// "12,345,678"; "12.3 MiB".
std::string grouped(uint64_t number);
std::string byte_size(uint64_t bytes);
// Four significant digits, without an exponent where that is short.
std::string short_number(double number);

// A linear value as sRGB 0..1; a colour brighter than 1 is scaled down to it.
ImVec4 swatch(tracer::vec3 linear);

}  // namespace ui
