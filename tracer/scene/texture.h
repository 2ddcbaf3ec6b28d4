// Textures: 8-bit sRGB images on surfaces.
#pragma once

#include <string>

#include "tracer/math/types.h"
#include "tracer/scene/texels.h"

namespace tracer {

struct Texture {
  std::string name;
  uint32_t width = 0;
  uint32_t height = 0;
  Texels<uint32_t> texels;  // width * height, row 0 on top; bytes R, G, B, A; sRGB
};

// Linear RGB at uv, bilinear, repeating. Grey for an empty texture.
vec3 sample(const Texture& texture, vec2 uv);

// The same in two steps, so that others can be taken while the memory answers: where uv is between
// four texels, fetched into the cache, and what is there.
struct TexturePlace {
  uint32_t upper_left = 0, upper_right = 0, lower_left = 0, lower_right = 0;
  float across = 0.0f, down = 0.0f;  // weights of the right and lower ones
};
TexturePlace fetch(const Texture& texture, vec2 uv);
vec3 sample_fetched(const Texture& texture, const TexturePlace& place);

// sRGB byte -> linear 0..1 and back (IEC 61966-2-1).
float linear_from_srgb(uint8_t value);
float srgb_from_linear(float value);

}  // namespace tracer
