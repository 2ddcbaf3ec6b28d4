// Text drawn into pictures: a small stroke font of our own, so that a legend looks the same on
// every machine, with or without fonts.
#pragma once

#include <string_view>

#include "tracer/render/image.h"

namespace tracer {

// One unit is a seventh of a capital letter's height; letters hang down two units below the line.
inline constexpr float text_ascent = 7.0f;
inline constexpr float text_descent = 2.0f;

// In pixels, for a unit of so many pixels.
float text_width(std::string_view text, float unit);

// The upper left corner of the first letter is the point (x, y) in pixels. color is 0xRRGGBB.
// Printable ASCII; anything else is a box. Clipped at the image's borders.
void draw_text(Image& image, float x, float y, std::string_view text, float unit, uint32_t color);

}  // namespace tracer
