// Reads numbers that were typed.
#include "app/commands/typed_numbers.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "app/commands/command.h"

namespace app {

std::optional<std::vector<float>> parse_numbers(std::string_view text, char separator) {
  std::vector<float> numbers;
  while (true) {
    const size_t end = text.find(separator);
    std::string_view word = text.substr(0, end);
    if (word.starts_with('+')) word.remove_prefix(1);
    float value = 0.0f;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || rest != word.data() + word.size() || !std::isfinite(value)) {
      return std::nullopt;
    }
    numbers.push_back(value);
    if (end == std::string_view::npos) return numbers;
    text.remove_prefix(end + 1);
  }
}

tracer::vec3 parse_point(const std::string& text, std::string_view option) {
  const std::optional<std::vector<float>> numbers = parse_numbers(text, ',');
  if (!numbers || numbers->size() != 3) {
    throw UsageError(fmt::format("{}: '{}' is not a point; write X,Y,Z", option, text));
  }
  return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

tracer::ValueRange parse_range(const std::string& text) {
  const std::optional<std::vector<float>> numbers = parse_numbers(text, ':');
  if (!numbers || numbers->size() != 2 || !((*numbers)[0] < (*numbers)[1])) {
    throw UsageError(
        fmt::format("--range: '{}' is not a range; write LO:HI with LO less than HI", text));
  }
  return {(*numbers)[0], (*numbers)[1]};
}

glm::ivec2 parse_pixel(const std::string& text, std::string_view option) {
  const std::optional<std::vector<float>> numbers = parse_numbers(text, ',');
  const auto whole = [](float number) {
    return number == std::floor(number) && std::abs(number) < 1e6f;
  };
  if (!numbers || numbers->size() != 2 || !whole((*numbers)[0]) || !whole((*numbers)[1])) {
    throw UsageError(
        fmt::format("{}: '{}' is not a pixel; write X,Y in whole pixels from the upper left corner",
                    option, text));
  }
  return {int((*numbers)[0]), int((*numbers)[1])};
}

glm::ivec2 parse_size(const std::string& text, std::string_view option) {
  const std::optional<std::vector<float>> numbers = parse_numbers(text, 'x');
  const bool whole = numbers && numbers->size() == 2 &&
                     (*numbers)[0] == std::floor((*numbers)[0]) &&
                     (*numbers)[1] == std::floor((*numbers)[1]);
  if (!whole) {
    throw UsageError(
        fmt::format("{}: '{}' is not a size; write WxH in pixels, as in 1280x720", option, text));
  }
  for (const float side : *numbers) {
    if (side < 1.0f || side > float(tracer::max_image_size)) {
      throw UsageError(fmt::format("{}: {} is out of range; both sides are 1 to {} pixels", option,
                                   text, tracer::max_image_size));
    }
  }
  return {int((*numbers)[0]), int((*numbers)[1])};
}

}  // namespace app
