// A check of Radiance HDR files (G. Ward, Real Pixels, 1991) before stb_image decodes them.
#include "tracer/scene/hdr_check.h"

#include <charconv>

#include "tracer/scene/load_image.h"

namespace tracer {
namespace {

constexpr size_t longest_header_line = 1000;  // stb_image reads no more

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  size_t left() const { return bytes_.size(); }
  void skip(size_t count) { bytes_.remove_prefix(count); }
  uint32_t peek(size_t at) const { return static_cast<unsigned char>(bytes_[at]); }

  // False at the end of the data.
  bool line(std::string_view& line) {
    const size_t end = bytes_.find('\n');
    if (end == bytes_.npos) return false;
    line = bytes_.substr(0, end);
    skip(end + 1);
    return true;
  }

 private:
  std::string_view bytes_;
};

// "-Y 512 +X 1024"
bool read_size(std::string_view line, HdrCheck& result) {
  const auto number = [&](std::string_view before, uint32_t& value) {
    if (line.substr(0, before.size()) != before) return false;
    line.remove_prefix(before.size());
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
    line.remove_prefix(size_t(end - line.data()));
    return error == std::errc();
  };
  return number("-Y ", result.height) && number(" +X ", result.width);
}

// One component of a scanline: runs (128 + count, value) and dumps (count, values).
bool skip_component(Reader& reader, uint32_t width) {
  for (uint32_t done = 0; done < width;) {
    if (reader.left() < 2) return false;
    const uint32_t code = reader.peek(0);
    const uint32_t count = code > 128 ? code - 128 : code;
    const size_t bytes = code > 128 ? 2 : 1 + size_t(count);
    if (count == 0 || count > width - done || reader.left() < bytes) return false;
    reader.skip(bytes);
    done += count;
  }
  return true;
}

bool starts_scanline(const Reader& reader) {
  return reader.left() >= 4 && reader.peek(0) == 2 && reader.peek(1) == 2 && reader.peek(2) < 128;
}

std::string check_pixels(Reader& reader, const HdrCheck& size) {
  const bool may_have_runs = size.width >= 8 && size.width < 32768;
  if (!may_have_runs || !starts_scanline(reader)) {
    const uint64_t needed = uint64_t(4) * size.width * size.height;
    return reader.left() < needed ? "the file is cut off" : "";
  }
  for (uint32_t row = 0; row < size.height; ++row) {
    if (reader.left() < 4) return "the file is cut off";
    if (!starts_scanline(reader) || (reader.peek(2) << 8 | reader.peek(3)) != size.width) {
      return "a scanline is corrupt";
    }
    reader.skip(4);
    for (int component = 0; component < 4; ++component) {
      if (!skip_component(reader, size.width)) return "the file is cut off or corrupt";
    }
  }
  return {};
}

}  // namespace

HdrCheck check_hdr(std::string_view bytes) {
  HdrCheck result;
  Reader reader(bytes);
  std::string_view line;
  if (!reader.line(line) || (line != "#?RADIANCE" && line != "#?RGBE")) {
    result.problem = "it is not a Radiance HDR file";
    return result;
  }
  bool known_format = false;
  do {
    if (!reader.line(line) || line.size() > longest_header_line) {
      result.problem = "its header is cut off";
      return result;
    }
    known_format |= line == "FORMAT=32-bit_rle_rgbe";
  } while (!line.empty());
  if (!known_format) {
    result.problem = "its format is not 32-bit_rle_rgbe";
  } else if (!reader.line(line) || line.size() > longest_header_line || !read_size(line, result)) {
    result.problem = "its size line is not of the form -Y height +X width";
  } else if (result.width == 0 || result.height == 0) {
    result.problem = "it has no pixels";
  } else if (result.width <= max_image_side && result.height <= max_image_side) {
    result.problem = check_pixels(reader, result);
  }
  return result;
}

}  // namespace tracer
