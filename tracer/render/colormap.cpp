// Colour maps as tables of 17 equally spaced sRGB colours with straight lines between.
// viridis, inferno and plasma: S. van der Walt and N. Smith, 2015 (CC0); turbo: A. Mikhailov, 2019;
// each sampled at 17 points of its 256, which is within 6/255 everywhere. temperature: the
// diverging map of K. Moreland, Diverging Color Maps for Scientific Visualization, 2009, evaluated
// by our own arithmetic.
#include "tracer/render/colormap.h"

#include <algorithm>
#include <cmath>

namespace tracer {
namespace {

constexpr int steps = 16;
using Table = uint32_t[steps + 1];  // 0xRRGGBB

constexpr Table viridis = {0x440154, 0x48186a, 0x472d7b, 0x424086, 0x3b528b, 0x33638d,
                           0x2c728e, 0x26818e, 0x21908c, 0x1f9f88, 0x28ae80, 0x3ebc74,
                           0x5dc963, 0x82d34c, 0xabdc32, 0xd5e21a, 0xfde725};
constexpr Table turbo = {0x30123b, 0x4040a1, 0x466be3, 0x4293ff, 0x29bbec, 0x18dcc3,
                         0x31f299, 0x6bfd64, 0xa3fd3c, 0xcced34, 0xedd03a, 0xfdae35,
                         0xfb8022, 0xec520f, 0xd23105, 0xac1701, 0x7a0403};
constexpr Table inferno = {0x000004, 0x0b0724, 0x210c4a, 0x3c0965, 0x57106d, 0x70196e,
                           0x89226a, 0xa32b61, 0xbb3755, 0xd14644, 0xe35932, 0xf1711e,
                           0xf98d0a, 0xfcab0f, 0xf9ca32, 0xf2e865, 0xfcffa4};
constexpr Table plasma = {0x0d0887, 0x310596, 0x4c02a1, 0x6600a7, 0x7e03a8, 0x9511a2,
                          0xa92396, 0xbb3587, 0xcb4778, 0xd9596a, 0xe66c5c, 0xf07f4f,
                          0xf89441, 0xfdab33, 0xfdc328, 0xf9dd25, 0xf0f921};
constexpr Table temperature = {0x3b4cc0, 0x4e68d7, 0x6282ea, 0x779af7, 0x8db0fe, 0xa3c2ff,
                               0xb8d0f9, 0xccd9ee, 0xdddddd, 0xecd3c6, 0xf5c4ad, 0xf7b194,
                               0xf49a7b, 0xec7f63, 0xde614c, 0xcb3e38, 0xb40426};

vec3 unpack(uint32_t color) {
  return vec3(color >> 16, (color >> 8) & 0xff, color & 0xff) / 255.0f;
}

// NaN is shown as the lowest value; views keep it out.
float clamped(float t) {
  return t > 0.0f ? std::min(t, 1.0f) : 0.0f;
}

vec3 interpolated(const Table& table, float t) {
  const float x = clamped(t) * steps;
  const int index = std::min(int(x), steps - 1);
  return glm::mix(unpack(table[index]), unpack(table[index + 1]), x - float(index));
}

constexpr ColormapRow rows[] = {
    {"viridis", "Viridis", "Dark blue to yellow; even steps, readable without colour vision",
     [](float t) { return interpolated(viridis, t); }},
    {"turbo", "Turbo", "Dark blue over green to dark red; shows the finest differences",
     [](float t) { return interpolated(turbo, t); }},
    {"inferno", "Inferno", "Black over red to pale yellow",
     [](float t) { return interpolated(inferno, t); }},
    {"plasma", "Plasma", "Blue over magenta to yellow",
     [](float t) { return interpolated(plasma, t); }},
    {"temperature", "Temperature", "Blue is low, light grey the middle, red high",
     [](float t) { return interpolated(temperature, t); }},
    {"grey", "Grey", "Black to white", [](float t) { return vec3(clamped(t)); }},
};

}  // namespace

std::span<const ColormapRow> colormaps() {
  return rows;
}

}  // namespace tracer
