// A check of Radiance HDR files before stb_image decodes them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tracer {

struct HdrCheck {
  uint32_t width = 0;
  uint32_t height = 0;
  std::string problem;  // empty: complete and safe to decode
};

// Walks over all runs without decoding them. A cut-off scanline makes stb_image before 2.28 loop
// for ever (CVE-2021-42715).
HdrCheck check_hdr(std::string_view bytes);

}  // namespace tracer
