// Numbers in OBJ and MTL files.
#include "tracer/scene/obj_number.h"

#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tracer {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

size_t count_digits(std::string_view word, size_t from) {
  size_t end = from;
  while (end < word.size() && is_digit(word[end]))
    ++end;
  return end - from;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(obj_blanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(obj_blanks) - first + 1);
}

std::string_view next_word(std::string_view& rest) {
  size_t first = 0;
  while (first < rest.size() && obj_blanks.find(rest[first]) != obj_blanks.npos)
    ++first;
  size_t end = first;
  while (end < rest.size() && obj_blanks.find(rest[end]) == obj_blanks.npos)
    ++end;
  const std::string_view word = rest.substr(first, end - first);
  rest.remove_prefix(end);
  return word;
}

bool is_plain_number(std::string_view word) {
  size_t at = 0;
  if (at < word.size() && (word[at] == '+' || word[at] == '-')) ++at;
  const size_t whole = count_digits(word, at);
  at += whole;
  size_t fraction = 0;
  if (at < word.size() && word[at] == '.') {
    fraction = count_digits(word, ++at);
    at += fraction;
  }
  if (whole + fraction == 0) return false;
  if (at < word.size() && (word[at] == 'e' || word[at] == 'E')) {
    ++at;
    if (at < word.size() && (word[at] == '+' || word[at] == '-')) ++at;
    const size_t exponent = count_digits(word, at);
    if (exponent == 0 || exponent > 3) return false;
    at += exponent;
  }
  return at == word.size();
}

Number parse_number(std::string_view word) {
  const Number bad = {std::numeric_limits<double>::infinity(), NumberFault::bad};
  NumberFault fault = NumberFault::none;
  std::string pointed;
  const size_t comma = word.find(',');
  if (comma != word.npos) {
    pointed = word;
    pointed[comma] = '.';
    if (!is_plain_number(pointed)) return bad;
    word = pointed;
    fault = NumberFault::comma;
  }
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  if (word.empty() || word.front() == '+') return bad;
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return bad;
  if (error == std::errc::result_out_of_range) {
    // Too large or too small for a double: the exponent's sign tells which.
    return word.find("e-") == word.npos && word.find("E-") == word.npos ? bad : Number{0.0, fault};
  }
  if (error != std::errc() || !std::isfinite(value)) return bad;
  return {value, fault};
}

std::string number_word(double value) {
  if (!std::isfinite(value)) return "1e999";
  return fmt::format("{:.9g}", value);
}

void add(LineList& list, uint64_t line, uint64_t count) {
  list.count += count;
  if (!list.first.empty() && list.first.back() == line) return;
  if (list.first.size() < 5) {
    list.first.push_back(line);
  } else {
    list.more = true;
  }
}

std::string lines_text(const LineList& list) {
  std::string text = list.first.size() == 1 ? "line " : "lines ";
  text += fmt::format("{}", fmt::join(list.first, ", "));
  if (list.more) text += ", ...";
  return text;
}

std::string counted(uint64_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string printable(std::string_view text) {
  constexpr size_t longest = 200;
  std::string result(text.substr(0, longest));
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  if (text.size() > longest) result += "...";
  return result;
}

}  // namespace tracer
