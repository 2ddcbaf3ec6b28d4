// Image files: what loads, what is refused, and the check of HDR runs.
#include "tracer/scene/load_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "temporary_folder.h"
#include "tracer/scene/hdr_check.h"

namespace {

using testing::HasSubstr;
using tracer::check_hdr;
using tracer::load_sky;
using tracer::load_texture;
using tracer::vec3;

std::string from_hex(std::string_view hex) {
  std::string bytes;
  for (size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes += char(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  }
  return bytes;
}

// A red and a blue pixel.
const std::string_view png_rgb =
    "89504e470d0a1a0a0000000d49484452000000020000000108020000007b40e8dd0000000d4944415478da63f8cf"
    "0004ff01070001ff3d7d8c490000000049454e44ae426082";
// One 16-bit grey pixel, 0x8040.
const std::string_view png_gray16 =
    "89504e470d0a1a0a0000000d49484452000000010000000110000000006aee47160000000b4944415478da636870"
    "0000014300c1cc70e2ea0000000049454e44ae426082";
// Palette of (1,2,3) and red, one bit a pixel: first the first, then the second.
const std::string_view png_palette =
    "89504e470d0a1a0a0000000d4948445200000002000000010103000000ceecedc900000006504c5445010203ff00"
    "00b8d6a2090000000a4944415478da637000000042004184bf8e620000000049454e44ae426082";
// Headers that promise 16384 x 16384 and 70000 x 1 pixels, without them.
const std::string_view png_huge =
    "89504e470d0a1a0a0000000d494844520000400000004000080200000026aa87d3000000084944415478da030000"
    "0000016fddc9910000000049454e44ae426082";
const std::string_view png_wide =
    "89504e470d0a1a0a0000000d49484452000111700000000108020000007d21ea1c000000084944415478da030000"
    "0000016fddc9910000000049454e44ae426082";

// Uncompressed, 24 bits, `red` then `blue`.
std::string tga() {
  std::string bytes(18, '\0');
  bytes[2] = 2;
  bytes[12] = 2;
  bytes[14] = 1;
  bytes[16] = 24;
  return bytes + std::string("\0\0\xff\xff\0\0", 6);
}

std::string hdr_header(int width, int height) {
  return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
         std::to_string(width) + "\n";
}

// A scanline of eight pixels of radiance (1, 0.5, 0.25): three runs and a dump.
std::string hdr_scanline() {
  constexpr char bytes[] =
      "\2\2\0\x08"
      "\x88\x80"
      "\x88\x40"
      "\x88\x20"
      "\x08\x81\x81\x81\x81\x81\x81\x81\x81";
  return {bytes, sizeof bytes - 1};
}

struct LoadImage : testing::Test {
  TemporaryFolder folder;
};

TEST_F(LoadImage, PngRowsAndBytes) {
  const tracer::Texture texture = load_texture(folder.file("a.png", from_hex(png_rgb)));
  EXPECT_EQ(texture.name, "a.png");
  EXPECT_EQ(texture.width, 2u);
  EXPECT_EQ(texture.height, 1u);
  EXPECT_EQ(texture.texels, (std::vector<uint32_t>{0xff0000ffu, 0xffff0000u}));
}

TEST_F(LoadImage, SixteenBitGrey) {
  EXPECT_EQ(load_texture(folder.file("a.png", from_hex(png_gray16))).texels,
            (std::vector<uint32_t>{0xff808080u}));
}

TEST_F(LoadImage, Palette) {
  EXPECT_EQ(load_texture(folder.file("a.png", from_hex(png_palette))).texels,
            (std::vector<uint32_t>{0xff030201u, 0xff0000ffu}));
}

TEST_F(LoadImage, TgaByItsEnding) {
  EXPECT_EQ(load_texture(folder.file("a.TGA", tga())).texels,
            (std::vector<uint32_t>{0xff0000ffu, 0xffff0000u}));
  EXPECT_THAT(message_of([&] { load_texture(folder.file("a.png", tga())); }),
              HasSubstr("it is not a PNG, JPEG, TGA, BMP or Radiance HDR file"));
}

TEST_F(LoadImage, ContentDecidesNotTheEnding) {
  EXPECT_EQ(load_texture(folder.file("a.jpg", from_hex(png_rgb))).width, 2u);
}

TEST_F(LoadImage, TooLargeByHeaderIsRefused) {
  EXPECT_THAT(message_of([&] { load_texture(folder.file("a.png", from_hex(png_huge))); }),
              HasSubstr("it has 16384 x 16384 pixels; the limits are"));
  EXPECT_NE(message_of([&] { load_texture(folder.file("b.png", from_hex(png_wide))); }), "");
}

TEST_F(LoadImage, BrokenFilesAreRefused) {
  EXPECT_THAT(message_of([&] { load_texture(folder.file("e.png")); }), HasSubstr("it is empty"));
  EXPECT_THAT(message_of([&] { load_texture(folder.file("t.jpg", "not an image")); }),
              HasSubstr("it is not a PNG"));
  EXPECT_THAT(message_of([&] { load_texture(folder.file("g.gif", "GIF89a\1\0\1\0\0\0\0")); }),
              HasSubstr("it is not a PNG"));
  const std::string png = from_hex(png_rgb);
  for (size_t length = 1; length < png.size() - 12; ++length) {
    EXPECT_NE(message_of([&] { load_texture(folder.file("c.png", png.substr(0, length))); }), "")
        << length;
  }
}

TEST_F(LoadImage, FoldersAndMissingFilesAreRefused) {
  EXPECT_THAT(message_of([&] { load_texture(folder.path); }), HasSubstr("is a folder"));
  EXPECT_THAT(message_of([&] { load_texture(folder.path / "no.png"); }),
              HasSubstr("does not exist"));
}

TEST_F(LoadImage, SkyWithRuns) {
  const std::string bytes = hdr_header(8, 2) + hdr_scanline() + hdr_scanline();
  const tracer::SkyImage sky = load_sky(folder.file("a.hdr", bytes));
  EXPECT_EQ(sky.width, 8u);
  EXPECT_EQ(sky.height, 2u);
  ASSERT_EQ(sky.texels.size(), 16u);
  for (const vec3& texel : sky.texels)
    EXPECT_EQ(texel, vec3(1.0f, 0.5f, 0.25f));
}

TEST_F(LoadImage, SkyWithoutRuns) {
  const std::string pixel = "\x80\x40\x20\x81";
  const tracer::SkyImage sky = load_sky(folder.file("a.hdr", hdr_header(2, 1) + pixel + pixel));
  EXPECT_EQ(sky.texels, (std::vector<vec3>(2, vec3(1.0f, 0.5f, 0.25f))));
}

TEST_F(LoadImage, SkyValuesAreLimited) {
  const tracer::SkyImage sky =
      load_sky(folder.file("a.hdr", hdr_header(1, 1) + "\xff\xff\xff\xff"));
  EXPECT_EQ(sky.texels[0], vec3(1e8f));
}

TEST_F(LoadImage, SkyFromAnOrdinaryImage) {
  EXPECT_EQ(load_sky(folder.file("a.png", from_hex(png_rgb))).texels[0], vec3(1, 0, 0));
}

// stb_image 2.27 would loop for ever on some of these.
TEST_F(LoadImage, EveryCutOffSkyIsRefused) {
  const std::string bytes = hdr_header(8, 2) + hdr_scanline() + hdr_scanline();
  for (size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_NE(message_of([&] { load_sky(folder.file("a.hdr", bytes.substr(0, length))); }), "")
        << length;
  }
}

TEST(HdrCheck, RunsMustFit) {
  const std::string head = hdr_header(8, 1) + std::string("\2\2\0\x08", 4);
  EXPECT_EQ(check_hdr(hdr_header(8, 1) + hdr_scanline()).problem, "");
  EXPECT_NE(check_hdr(head + "\x89\x80\x88\x40\x88\x20\x88\x81").problem, "");
  EXPECT_NE(check_hdr(head + std::string(100, '\0')).problem, "");
  EXPECT_NE(check_hdr(hdr_header(9, 1) + hdr_scanline() + std::string(100, 'x')).problem, "");
}

TEST(HdrCheck, LaterScanlinesNeedRunsToo) {
  EXPECT_NE(check_hdr(hdr_header(8, 2) + hdr_scanline() + std::string(100, 'x')).problem, "");
}

TEST(HdrCheck, HeadersAreUnderstoodOrRefused) {
  EXPECT_EQ(check_hdr(hdr_header(70000, 3)).width, 70000u);
  for (const char* text : {"", "#?RADIANCE", "#?RADIANCE\n\n-Y 1 +X 1\nabcd", "P6\n1 1\n255\n",
                           "#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n+X 1 -Y 1\nabcd",
                           "#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y -1 +X 1\nabcd",
                           "#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 99999999999 +X 1\nabcd",
                           "#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 1\nabcd"}) {
    EXPECT_NE(check_hdr(text).problem, "") << text;
  }
}

}  // namespace
