// Numbers in OBJ and MTL files, checked before tinyobjloader reads them: it takes "0,5", "nan" and
// "abc" for 0 and its exponents overflow.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tracer {

inline constexpr std::string_view obj_blanks = " \t\v\f";

std::string_view trimmed(std::string_view text);

// Takes the next word off the front of `rest`; empty at the end.
std::string_view next_word(std::string_view& rest);

// Digits with an optional sign, point and exponent of at most three digits: safe to hand on.
bool is_plain_number(std::string_view word);

enum class NumberFault { none, comma, bad };
struct Number {
  double value = 0.0;  // infinite if bad
  NumberFault fault = NumberFault::none;
};
// Reads also a decimal comma ("0,5"). Anything else, nan and infinity included, is bad.
Number parse_number(std::string_view word);

// As a word that tinyobjloader reads back: 9 digits, "1e999" for what is not finite.
std::string number_word(double value);

// How often something occurred and on which lines first. Lines come in ascending order.
struct LineList {
  uint64_t count = 0;
  std::vector<uint64_t> first;  // five lines at most
  bool more = false;            // there were others
};
void add(LineList& list, uint64_t line, uint64_t count = 1);
std::string lines_text(const LineList& list);  // "line 3" or "lines 3, 7, ..."

std::string counted(uint64_t count, std::string_view noun);  // "1 face", "2 faces"

// Fit for a message: control characters replaced, shortened.
std::string printable(std::string_view text);

}  // namespace tracer
