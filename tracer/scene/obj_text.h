// The text of an OBJ file on its way to tinyobjloader, line by line: what that parser would choke
// on or read wrongly is mended or left out here, and counted.
#pragma once

#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/progress.h"
#include "tracer/scene/obj_number.h"

namespace tracer {

struct ObjTextReport {
  std::vector<std::string> libraries;  // what follows each mtllib
  LineList bad_numbers;                // coordinates that are no finite number, or missing
  LineList decimal_commas;             // read as points
  LineList bad_faces;                  // left out; the count is in triangles
  uint64_t understood = 0;             // lines with an OBJ keyword
  uint64_t unknown = 0;                // other lines
};

// Only v, vn, vt, f and usemtl lines come out. Each is well formed: three finite numbers (two for
// vt) or "1e999" in place of a bad one, indices that fit 32 bits, no carriage return, no
// continuation. Deriving is the standard library's way to feed a stream. The text must outlive it;
// most of it is handed out in place.
class ObjText : public std::streambuf {
 public:
  ObjText(std::string_view text, const Job& job);

  // Of the line handed out last, from 1. A continued line has the number of its last part.
  uint64_t line() const { return line_; }
  const ObjTextReport& report() const { return report_; }

 protected:
  int_type underflow() override;

 private:
  bool next_line(std::string_view& line);
  std::string_view next_raw_line();
  std::string_view cleaned(std::string_view line);
  std::string_view with_numbers(std::string_view line, std::string_view numbers, int wanted,
                                int required);
  std::string_view with_face(std::string_view line, std::string_view corners);

  std::string_view text_;
  size_t at_ = 0;
  size_t reported_ = 0;  // bytes, at the last progress report
  uint64_t line_ = 0;
  const Job& job_;
  ObjTextReport report_;
  std::string joined_;  // a line put together from continued ones
  std::string mended_;  // a line written anew
  bool newline_owed_ = false;
  char newline_ = '\n';
};

}  // namespace tracer
