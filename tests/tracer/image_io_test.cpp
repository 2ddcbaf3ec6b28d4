#include "tracer/render/image_io.h"

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>
#include <tinyexr.h>

#include "tests/tracer/hand_made.h"
#include "tests/tracer/temporary_folder.h"
#include "tracer/error.h"
#include "tracer/file_io.h"
#include "tracer/scene/load_image.h"

namespace tracer {
namespace {

Image gradient() {
  Image image{3, 2, {}};
  for (uint32_t i = 0; i < 6; ++i)
    image.pixels.push_back(opaque(0x102030 * (i + 1)));
  return image;
}

std::vector<vec3> floats() {
  return {{0, 0.5f, 1}, {2, 1000, 1e-3f}, {0.1f, 0.2f, 0.3f}, {5, 6, 7}, {0, 0, 0}, {65504, 1, 1}};
}

TEST(ImageIo, PngReadsBackTheSame) {
  const TemporaryFolder folder;
  write_png(folder.path / "a.png", gradient());
  const Texture read = load_texture(folder.path / "a.png");
  EXPECT_EQ(read.width, 3u);
  EXPECT_EQ(read.height, 2u);
  EXPECT_EQ(read.texels, gradient().pixels);
}

TEST(ImageIo, ExrReadsBackTheSame) {
  const TemporaryFolder folder;
  write_float_image(folder.path / "a.exr", 3, 2, floats());
  const std::string bytes = read_file(folder.path / "a.exr", 1 << 20);
  float* rgba = nullptr;
  int width = 0;
  int height = 0;
  const char* message = nullptr;
  ASSERT_EQ(LoadEXRFromMemory(&rgba, &width, &height,
                              reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
                              &message),
            TINYEXR_SUCCESS)
      << message;
  ASSERT_EQ(width, 3);
  ASSERT_EQ(height, 2);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(vec3(rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2]), floats()[size_t(i)]) << i;
  }
  std::free(rgba);
}

TEST(ImageIo, HdrReadsBackWithinItsPrecision) {
  const TemporaryFolder folder;
  write_float_image(folder.path / "a.hdr", 3, 2, floats());
  const SkyImage read = load_sky(folder.path / "a.hdr");
  ASSERT_EQ(read.texels.size(), 6u);
  for (size_t i = 0; i < 6; ++i) {
    const vec3 expected = floats()[i];
    const float step = std::max({expected.x, expected.y, expected.z}) / 128.0f;
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(read.texels[i][k], expected[k], step) << i;
  }
}

TEST(ImageIo, HdrHasNoFaultyNumbers) {
  const TemporaryFolder folder;
  write_float_image(folder.path / "a.hdr", 3, 1, {vec3(NAN), vec3(infinity), vec3(-1)});
  for (const vec3& texel : load_sky(folder.path / "a.hdr").texels) {
    EXPECT_TRUE(std::isfinite(texel.x)) << texel.x;
    EXPECT_GE(texel.x, 0.0f);
  }
}

TEST(ImageIo, RefusesOtherEndingsAndMissingFolders) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_float_image(folder.path / "a.jpg", 3, 2, floats()), Error);
  EXPECT_THROW(write_png(folder.path / "missing" / "a.png", gradient()), Error);
}

TEST(ImageIo, RadianceIsInTheOrderOfRows) {
  const Film film = hand_made_film(70, 3, [](int x, int y) {
    PixelContent pixel;
    pixel.radiance = vec3(x, y, 1);
    return pixel;
  });
  const std::vector<vec3> linear = radiance_of(film);
  ASSERT_EQ(linear.size(), 210u);
  EXPECT_EQ(linear[2 * 70 + 65], vec3(65, 2, 1));
}

}  // namespace
}  // namespace tracer
