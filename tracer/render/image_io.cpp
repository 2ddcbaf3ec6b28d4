// PNG and Radiance HDR through stb_image_write, OpenEXR (32-bit float, ZIP) through tinyexr.
#include "tracer/render/image_io.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <tinyexr.h>

#include "tracer/error.h"
#include "tracer/file_io.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image_write.h>
#pragma GCC diagnostic pop

namespace tracer {
namespace {

void append(void* text, void* data, int size) {
  static_cast<std::string*>(text)->append(static_cast<const char*>(data), size_t(size));
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  if (file != "-") return write_file_atomically(file, bytes);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
  if (!written || std::fflush(stdout) != 0) {
    throw Error("standard output: the picture could not be written");
  }
}

// RGBE has no sign, no infinity and no NaN.
float storable(float value) {
  return value > 0.0f ? std::min(value, 1e37f) : 0.0f;
}

}  // namespace

std::string png_bytes(const Image& image) {
  std::string bytes;
  if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 4, image.pixels.data(),
                             image.width * 4) == 0) {
    throw Error("the picture could not be encoded as PNG: out of memory");
  }
  return bytes;
}

std::string hdr_bytes(int width, int height, const std::vector<vec3>& linear) {
  std::vector<float> values;
  values.reserve(linear.size() * 3);
  for (const vec3& pixel : linear) {
    for (int channel = 0; channel < 3; ++channel)
      values.push_back(storable(pixel[channel]));
  }
  std::string bytes;
  if (stbi_write_hdr_to_func(append, &bytes, width, height, 3, values.data()) == 0) {
    throw Error("the picture could not be encoded as HDR: out of memory");
  }
  return bytes;
}

std::string exr_bytes(int width, int height, const std::vector<vec3>& linear) {
  std::array<std::vector<float>, 3> planes;  // B, G, R: the order that most readers expect
  for (int plane = 0; plane < 3; ++plane) {
    planes[plane].reserve(linear.size());
    for (const vec3& pixel : linear)
      planes[plane].push_back(pixel[2 - plane]);
  }
  std::array<float*, 3> pointers = {planes[0].data(), planes[1].data(), planes[2].data()};
  std::array<EXRChannelInfo, 3> channels{};
  std::array<int, 3> types;
  types.fill(TINYEXR_PIXELTYPE_FLOAT);
  for (int plane = 0; plane < 3; ++plane)
    channels[plane].name[0] = "BGR"[plane];

  EXRHeader header;
  InitEXRHeader(&header);
  header.num_channels = 3;
  header.channels = channels.data();
  header.pixel_types = types.data();
  header.requested_pixel_types = types.data();
  header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
  EXRImage image;
  InitEXRImage(&image);
  image.num_channels = 3;
  image.images = reinterpret_cast<unsigned char**>(pointers.data());
  image.width = width;
  image.height = height;

  unsigned char* memory = nullptr;
  const char* message = nullptr;
  const size_t size = SaveEXRImageToMemory(&image, &header, &memory, &message);
  if (size == 0) {
    const std::string reason = message != nullptr ? message : "out of memory";
    FreeEXRErrorMessage(message);
    throw Error("the picture could not be encoded as EXR: " + reason);
  }
  std::string bytes(reinterpret_cast<const char*>(memory), size);
  std::free(memory);
  return bytes;
}

void write_png(const std::filesystem::path& file, const Image& image) {
  write_bytes(file, png_bytes(image));
}

void write_float_image(const std::filesystem::path& file, int width, int height,
                       const std::vector<vec3>& linear) {
  if (file.extension() == ".hdr") {
    write_bytes(file, hdr_bytes(width, height, linear));
  } else if (file.extension() == ".exr") {
    write_bytes(file, exr_bytes(width, height, linear));
  } else {
    throw Error(file.string() + ": linear pictures are .exr or .hdr files");
  }
}

std::vector<vec3> radiance_of(const Film& film) {
  std::vector<vec3> linear;
  linear.reserve(size_t(film.width) * film.height);
  for (int y = 0; y < film.height; ++y) {
    for (int x = 0; x < film.width; ++x)
      linear.push_back(pixel(film, x, y).radiance);
  }
  return linear;
}

}  // namespace tracer
