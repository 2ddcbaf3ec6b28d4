// Checking a typed number while the command line is parsed.
#pragma once

#include <charconv>
#include <string>
#include <type_traits>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace app {

// Refuses what is not a number of this kind within the limits, NaN included.
template <class Value>
CLI::Validator number_from(Value least, Value most) {
  return CLI::Validator(
      [least, most](const std::string& text) {
        Value value{};
        const char* end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data() + (text[0] == '+'), end, value);
        if (error == std::errc() && rest == end && value >= least && value <= most) {
          return std::string();
        }
        return fmt::format("'{}' is not a {}number from {} to {}", text,
                           std::is_integral_v<Value> ? "whole " : "", least, most);
      },
      "");
}

}  // namespace app
