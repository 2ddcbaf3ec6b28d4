// MTL text to materials.
#include <gtest/gtest.h>

#include "tracer/scene/load_mtl.h"

namespace {

using tracer::MtlMaterial;
using tracer::vec2;
using tracer::vec3;

MtlMaterial only(std::string_view lines) {
  const auto materials = tracer::parse_mtl("newmtl m\n" + std::string(lines)).materials;
  EXPECT_EQ(materials.size(), 1u);
  return materials.empty() ? MtlMaterial{} : materials.begin()->second;
}

TEST(Mtl, NamesWithBlanks) {
  const auto materials =
      tracer::parse_mtl("\xef\xbb\xbfnewmtl  Material #25 \r\nKd 1 0 0\r\n").materials;
  ASSERT_EQ(materials.count("Material #25"), 1u);
  EXPECT_EQ(materials.at("Material #25").material.albedo, vec3(1, 0, 0));
}

TEST(Mtl, TheFirstOfANameCounts) {
  EXPECT_EQ(only("Kd 1 0 0\nnewmtl m\nKd 0 1 0\n").material.albedo, vec3(1, 0, 0));
}

TEST(Mtl, GreyWithoutKd) {
  EXPECT_EQ(only("").material.albedo, vec3(0.8f));
}

TEST(Mtl, OneNumberIsGrey) {
  EXPECT_EQ(only("Kd 0.5\n").material.albedo, vec3(0.5f));
}

TEST(Mtl, ValuesAreBroughtIntoRange) {
  const auto material = only("Kd 5 -1 0.5\nKe 1e30 -1 nan\nNi 0\nTr -1\nillum 99\n").material;
  EXPECT_EQ(material.albedo, vec3(1, 0, 0.5f));
  EXPECT_EQ(material.emission, vec3(1e6f, 0, 1e6f));
  EXPECT_EQ(material.refraction_index, 1.0f);
  EXPECT_EQ(material.transmission, 0.0f);
}

TEST(Mtl, SaysWhichLinesWereMended) {
  const tracer::MtlFile file = tracer::parse_mtl(
      "newmtl a\r\nKd 0.2 0.3 nan\r\nKs 5 -1 0\r\nKd 0.5\r\nNi abc\r\nnewmtl a\r\nKd 1 1 1 1\r\n");
  EXPECT_EQ(tracer::lines_text(file.bad_numbers), "lines 2, 5");
  EXPECT_EQ(tracer::lines_text(file.out_of_range), "line 3");
  EXPECT_EQ(tracer::lines_text(file.repeated), "line 6");
}

TEST(Mtl, AMaterialGivenTwiceAlikeIsNoFault) {
  const tracer::MtlFile file = tracer::parse_mtl(
      "newmtl a\nKd 1 0 0\nnewmtl b\nnewmtl a\nKd 1 0 0\nnewmtl a\nKd 0 1 0\nnewmtl b\n");
  EXPECT_EQ(tracer::lines_text(file.repeated), "line 6");
}

TEST(Mtl, KeysInAnyCase) {
  EXPECT_EQ(only("KD 1 0 1\n").material.albedo, vec3(1, 0, 1));
}

TEST(Mtl, TextureNameWithBlanks) {
  EXPECT_EQ(only("map_Kd my wood.png \n").texture, "my wood.png");
}

TEST(Mtl, TextureOptions) {
  const MtlMaterial material = only("map_Kd -clamp on -s 2 3 1 -o 0.1 wood.png\n");
  EXPECT_EQ(material.texture, "wood.png");
  EXPECT_EQ(material.uv_scale, vec2(2, 3));
  EXPECT_EQ(material.uv_offset, vec2(0.1f, 0));
  EXPECT_EQ(only("map_Kd -blendu off -bm 3 -mm 0 1 -imfchan r -texres 64 a.png").texture, "a.png");
}

TEST(Mtl, TextureIsNotDarkened) {
  EXPECT_EQ(only("map_Kd a.png\n").material.albedo, vec3(1.0f));
  EXPECT_EQ(only("Kd 0 0 0\nmap_Kd a.png\n").material.albedo, vec3(1.0f));
  EXPECT_EQ(only("Kd 0.5 0.5 0.5\nmap_Kd a.png\n").material.albedo, vec3(0.5f));
}

TEST(Mtl, MirrorByIllumination) {
  const auto mirror = only("Ks 0.8 0.4 0\nillum 3\n").material;
  EXPECT_NEAR(mirror.reflectivity, 0.4f, 1e-6f);
  EXPECT_EQ(mirror.specular, vec3(1, 0.5f, 0));
  EXPECT_EQ(only("Ks 0.8 0.4 0\nillum 2\n").material.reflectivity, 0.0f);
}

TEST(Mtl, DissolveIsAThinPane) {
  const auto pane = only("d 0.25\nillum 2\n").material;
  EXPECT_EQ(pane.transmission, 0.75f);
  EXPECT_EQ(pane.refraction_index, 1.0f);
  EXPECT_EQ(only("Tr 0.25\n").material.transmission, 0.25f);
  EXPECT_EQ(only("d -halo 0.5\n").material.transmission, 0.5f);
}

TEST(Mtl, GlassRefracts) {
  const auto glass = only("Kd 0.1 0 0\nNi 1.33\nillum 7\n").material;
  EXPECT_NEAR(glass.transmission, 0.9f, 1e-6f);
  EXPECT_EQ(glass.refraction_index, 1.33f);
  EXPECT_EQ(only("d 0.5\nNi 2.4\n").material.refraction_index, 2.4f);
  EXPECT_EQ(only("illum 6\nTf 0.5 1 1\n").material.specular, vec3(0.5f, 1, 1));
  EXPECT_EQ(only("illum 6\nKd 0 0 0\n").material.refraction_index, 1.5f);
}

TEST(Mtl, SharesNeverExceedOne) {
  const auto material = only("Ks 1 1 1\nillum 3\nd 0.3\n").material;
  EXPECT_LE(material.reflectivity + material.transmission, 1.0f);
}

TEST(Mtl, AlphaMapIsSeen) {
  EXPECT_TRUE(only("map_d leaf.png\n").has_alpha_map);
}

TEST(Mtl, RubbishGivesNothing) {
  EXPECT_TRUE(tracer::parse_mtl("").materials.empty());
  EXPECT_TRUE(tracer::parse_mtl("Kd 1 0 0\nfoo\n").materials.empty());
  std::string bytes;
  for (int i = 0; i < 4096; ++i)
    bytes += char(i * 7919 >> 3);
  EXPECT_NO_THROW(tracer::parse_mtl(bytes));
}

TEST(Mtl, NumbersThatAreNoneAreLeftOut) {
  EXPECT_EQ(only("Kd spectral file.rfl 1\nd abc\nNi 1e99999999999\n").material.albedo, vec3(0.8f));
}

}  // namespace
