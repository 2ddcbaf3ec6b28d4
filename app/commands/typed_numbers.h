// Numbers, points, pixels, sizes and ranges as they are typed.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/settings.h"

namespace app {

// All numbers of "1,2,3" or "0:10"; nothing if a part is not a finite number.
std::optional<std::vector<float>> parse_numbers(std::string_view text, char separator);

// These throw UsageError, naming the option.

// "1,2.5,-3".
tracer::vec3 parse_point(const std::string& text, std::string_view option);

// "640,360", whole pixels from the upper left corner.
glm::ivec2 parse_pixel(const std::string& text, std::string_view option);

// "1280x720" within 1..max_image_size.
glm::ivec2 parse_size(const std::string& text, std::string_view option);

// "0:10" of --range, the first less than the second.
tracer::ValueRange parse_range(const std::string& text);

}  // namespace app
