// Choices are rows: what the user can choose from is one constexpr table of rows, each with at
// least `id` (the word on the command line and in JSON), `label` and `help`.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tracer {

// The row with this id, or nullptr.
template <class Row>
const Row* find_row(std::span<const Row> rows, std::string_view id) {
  for (const Row& row : rows) {
    if (row.id == id) return &row;
  }
  return nullptr;
}

// "a, b, c": for messages about an unknown id.
template <class Row>
std::string known_ids(std::span<const Row> rows) {
  std::string text;
  for (const Row& row : rows) {
    if (!text.empty()) text += ", ";
    text += row.id;
  }
  return text;
}

}  // namespace tracer
