// The text of an OBJ file on its way to tinyobjloader.
#include "tracer/scene/obj_text.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace tracer {
namespace {

constexpr size_t progress_step = size_t(4) << 20;  // bytes

// Keywords that carry nothing for us.
constexpr std::array<std::string_view, 20> other_keywords = {
    "g",    "o",    "s",    "l",    "p",   "vp", "cstype", "deg", "curv", "curv2",
    "surf", "parm", "trim", "hole", "end", "mg", "lod",    "vw",  "t",    "usemap"};

// An index of up to nine digits, or ten that do not overflow, at the front of `word`.
bool take_index(std::string_view& word) {
  size_t at = !word.empty() && (word[0] == '-' || word[0] == '+') ? 1 : 0;
  const size_t first = at;
  int64_t value = 0;
  while (at < word.size() && word[at] >= '0' && word[at] <= '9' && at - first < 10) {
    value = 10 * value + (word[at] - '0');
    ++at;
  }
  if (at == first || value > INT32_MAX) return false;
  word.remove_prefix(at);
  return true;
}

// i, i/j, i//k or i/j/k. Slashes at the end are taken off `word`: tinyobjloader would read the next
// corner's number there.
bool is_corner(std::string_view& word) {
  while (!word.empty() && word.back() == '/')
    word.remove_suffix(1);
  std::string_view rest = word;
  if (!take_index(rest)) return false;
  for (int part = 0; part < 2 && !rest.empty(); ++part) {
    if (rest.front() != '/') return false;
    rest.remove_prefix(1);
    if (rest.front() != '/' && !take_index(rest)) return false;
  }
  return rest.empty();
}

}  // namespace

ObjText::ObjText(std::string_view text, const Job& job) : text_(text), job_(job) {
  if (text_.substr(0, 3) == "\xef\xbb\xbf") at_ = 3;  // UTF-8 byte order mark
}

ObjText::int_type ObjText::underflow() {
  if (newline_owed_) {
    newline_owed_ = false;
    setg(&newline_, &newline_, &newline_ + 1);
    return traits_type::to_int_type('\n');
  }
  std::string_view line;
  while (next_line(line)) {
    line = cleaned(line);
    if (line.empty()) continue;
    newline_owed_ = true;
    char* const begin = const_cast<char*>(line.data());  // a get area is only read
    setg(begin, begin, begin + line.size());
    return traits_type::to_int_type(*begin);
  }
  return traits_type::eof();
}

// A line ends with \n, \r\n or \r.
std::string_view ObjText::next_raw_line() {
  const std::string_view rest = text_.substr(at_);
  std::string_view line = rest.substr(0, rest.find('\n'));
  size_t used = std::min(line.size() + 1, rest.size());
  const size_t carriage_return = line.find('\r');
  if (carriage_return != line.npos) {
    if (carriage_return + 1 < line.size()) used = carriage_return + 1;
    line = line.substr(0, carriage_return);
  }
  at_ += used;
  ++line_;
  return line;
}

// False at the end or when the job was stopped.
bool ObjText::next_line(std::string_view& line) {
  if (at_ >= text_.size()) return false;
  if (at_ - reported_ >= progress_step) {
    reported_ = at_;
    if (job_.stopped()) return false;
    job_.progress(0.7f * float(double(at_) / double(text_.size())), "reading the file");
  }
  line = trimmed(next_raw_line());
  // A comment that ends with a backslash (a path, say) is not continued.
  if (line.empty() || line.back() != '\\' || line.front() == '#') return true;
  joined_.clear();
  while (!line.empty() && line.back() == '\\') {
    joined_ += line.substr(0, line.size() - 1);
    joined_ += ' ';
    if (at_ >= text_.size()) break;
    line = trimmed(next_raw_line());
    if (line.empty() || line.back() != '\\') joined_ += line;
  }
  line = trimmed(joined_);
  return true;
}

// What tinyobjloader shall see of a line; empty: nothing.
std::string_view ObjText::cleaned(std::string_view line) {
  std::string_view rest = line;
  const std::string_view keyword = next_word(rest);
  if (keyword.empty() || keyword.front() == '#') return {};
  ++report_.understood;
  if (keyword == "v") return with_numbers(line, rest, 3, 3);
  if (keyword == "vn") return with_numbers(line, rest, 3, 3);
  if (keyword == "vt") return with_numbers(line, rest, 2, 1);
  if (keyword == "f" || keyword == "fo") return with_face(line, rest);
  if (keyword == "usemtl") {
    mended_ = "usemtl ";
    mended_ += trimmed(rest);
    std::replace(mended_.begin(), mended_.end(), '\0', '?');
    return mended_;
  }
  if (keyword == "mtllib") {
    report_.libraries.emplace_back(trimmed(rest));
  } else if (std::find(other_keywords.begin(), other_keywords.end(), keyword) ==
             other_keywords.end()) {
    --report_.understood;
    ++report_.unknown;
  }
  return {};
}

// The line itself if all its numbers are plain, else one with exactly the wanted numbers.
std::string_view ObjText::with_numbers(std::string_view line, std::string_view numbers, int wanted,
                                       int required) {
  int plain = 0;
  bool all_plain = true;
  for (std::string_view rest = numbers; all_plain;) {
    const std::string_view word = next_word(rest);
    if (word.empty()) break;
    all_plain = is_plain_number(word);
    ++plain;
  }
  if (all_plain && plain >= required) return line;

  mended_ = line.substr(0, line.size() - numbers.size());
  NumberFault worst = NumberFault::none;
  for (int i = 0; i < wanted; ++i) {
    std::string_view word = next_word(numbers);
    if (!word.empty() && word.front() == '#') word = numbers = {};
    if (word.empty() && i >= required) break;
    const Number number = parse_number(word);
    worst = std::max(worst, number.fault);
    mended_ += ' ';
    mended_ += number_word(number.value);
  }
  if (worst == NumberFault::comma) add(report_.decimal_commas, line_);
  if (worst == NumberFault::bad) add(report_.bad_numbers, line_);
  return mended_;
}

// The line if it has three good corners or more; else nothing, and it is counted.
std::string_view ObjText::with_face(std::string_view line, std::string_view corners) {
  uint64_t count = 0;
  bool good = true;
  bool as_it_is = line[1] != 'o';  // "fo" is an old spelling of "f"
  for (std::string_view rest = corners;;) {
    std::string_view word = next_word(rest);
    if (word.empty()) break;
    if (word.front() == '#') {
      as_it_is = false;
      break;
    }
    const size_t length = word.size();
    good = good && is_corner(word);
    as_it_is = as_it_is && word.size() == length;
    ++count;
  }
  if (!good || count < 3) {
    add(report_.bad_faces, line_, std::max<uint64_t>(count, 3) - 2);
    return {};
  }
  if (as_it_is) return line;
  mended_ = std::string(1, 'f');
  for (uint64_t i = 0; i < count; ++i) {
    std::string_view word = next_word(corners);
    is_corner(word);
    mended_ += ' ';
    mended_ += word;
  }
  return mended_;
}

}  // namespace tracer
