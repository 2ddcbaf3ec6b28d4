// OBJ files to scenes.
#include "tracer/scene/load_obj.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "temporary_folder.h"

namespace {

using testing::AnyOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using tracer::load_obj;
using tracer::Scene;
using tracer::uvec3;
using tracer::vec2;
using tracer::vec3;

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

// A red pixel.
const unsigned char red_bmp[] = {
    'B', 'M', 58, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0,   24,
    0,   0,   0,  0, 0, 4, 0, 0, 0, 0, 0,  0, 0, 0, 0,  0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 0};
std::string_view red_image() {
  return {reinterpret_cast<const char*>(red_bmp), sizeof red_bmp};
}

struct LoadObj : testing::Test {
  TemporaryFolder folder;

  Scene scene(std::string_view text) { return load_obj(folder.file("scene.obj", text), {}); }
  std::string refusal(std::string_view text) {
    return message_of([&] { scene(text); });
  }
};

bool keeps_promises(const Scene& scene) {
  for (const tracer::Mesh& mesh : scene.meshes) {
    const size_t count = mesh.positions.size();
    if (mesh.triangles.empty() || mesh.normals.size() != count) return false;
    if (!mesh.uvs.empty() && mesh.uvs.size() != count) return false;
    if (mesh.materials.size() != mesh.triangles.size()) return false;
    for (const uvec3& t : mesh.triangles) {
      if (t.x >= count || t.y >= count || t.z >= count) return false;
    }
    for (const vec3& normal : mesh.normals) {
      if (!(std::abs(glm::length(normal) - 1.0f) < 1e-4f)) return false;
    }
    for (const uint32_t material : mesh.materials) {
      if (material >= scene.materials.size()) return false;
    }
  }
  const tracer::TriangleCounts& n = scene.counts;
  return n.read == n.used + n.degenerate + n.non_finite + n.bad_index;
}

TEST_F(LoadObj, OneTriangle) {
  const Scene result = scene(square + "f 1 2 3\n");
  EXPECT_TRUE(keeps_promises(result));
  EXPECT_EQ(result.name, "scene.obj");
  EXPECT_THAT(result.meshes[0].triangles, ElementsAre(uvec3(0, 1, 2)));
  EXPECT_EQ(result.meshes[0].positions[2], vec3(1, 1, 0));
  EXPECT_EQ(result.meshes[0].normals[0], vec3(0, 0, 1));
  EXPECT_THAT(result.meshes[0].uvs, IsEmpty());
  EXPECT_EQ(result.materials[0].name, "default");
  EXPECT_EQ(result.instances.size(), 1u);
  EXPECT_EQ(result.counts.used, 1u);
  EXPECT_THAT(result.warnings, IsEmpty());
}

TEST_F(LoadObj, ShowsSomethingByItself) {
  const Scene result = scene(square + "f 1 2 3\n");
  EXPECT_FALSE(result.lights.empty());
  EXPECT_NE(result.camera.eye, result.camera.target);
}

TEST_F(LoadObj, CornersAreShared) {
  EXPECT_EQ(scene(square + "f 1 2 3\nf 1 3 4\n").meshes[0].positions.size(), 4u);
}

TEST_F(LoadObj, CornersWithOtherUvsAreNot) {
  const Scene result = scene(square + "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/2 3/1 4/1\n");
  EXPECT_EQ(result.meshes[0].positions.size(), 5u);
  EXPECT_EQ(result.meshes[0].uvs.size(), 5u);
  EXPECT_EQ(result.meshes[0].positions[0], result.meshes[0].positions[3]);
}

TEST_F(LoadObj, SomeFacesWithoutUv) {
  const Scene result = scene(square + "vt 1 1\nf 1 2 3\nf 1/1 3/1 4/1\n");
  EXPECT_TRUE(keeps_promises(result));
  EXPECT_EQ(result.meshes[0].uvs[0], vec2(0));
  EXPECT_EQ(result.meshes[0].uvs[3], vec2(1));
}

TEST_F(LoadObj, RelativeIndices) {
  EXPECT_EQ(scene(square + "f -4 -3 -2\n").meshes[0].positions[0], vec3(0, 0, 0));
}

TEST_F(LoadObj, VerticesMayFollow) {
  EXPECT_EQ(scene("f 1 2 3\n" + square).counts.used, 1u);
}

TEST_F(LoadObj, BadVertexIndicesAreLeftOut) {
  const Scene result = scene(square + "f 1 2 5\nf -5 2 3\nf 0 1 2\nf 1 2 900000\nf 1 2 3 4\n");
  EXPECT_TRUE(keeps_promises(result));
  EXPECT_EQ(result.counts.used, 2u);
  EXPECT_EQ(result.counts.bad_index, 4u);
  EXPECT_THAT(
      result.warnings,
      ElementsAre("4 triangles left out: a vertex index is out of range (lines 5, 6, 7, 8)"));
}

TEST_F(LoadObj, BadUvAndNormalIndicesAreIgnored) {
  const Scene result = scene(square + "vt 0 0\nvn 0 0 1\nf 1/7/1 2/-9/1 3/1/8\n");
  EXPECT_TRUE(keeps_promises(result));
  EXPECT_EQ(result.counts.used, 1u);
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("1 face with a texture or normal index")));
}

TEST_F(LoadObj, FacesThatAreNoneAreCounted) {
  const Scene result = scene(square + "f 1 2 3\nf 1 2\nf 1 2 x 4\n");
  EXPECT_EQ(result.counts.read, 4u);
  EXPECT_EQ(result.counts.bad_index, 3u);
}

TEST_F(LoadObj, DegenerateTrianglesAreLeftOut) {
  const Scene result = scene(square + "v 2 0 0\nf 1 2 3\nf 1 1 2\nf 1 2 5\n");
  EXPECT_EQ(result.counts.used, 1u);
  EXPECT_EQ(result.counts.degenerate, 2u);
  EXPECT_THAT(result.warnings, ElementsAre("2 triangles left out: no area (lines 7, 8)"));
}

TEST_F(LoadObj, NonFiniteTrianglesAreLeftOut) {
  const Scene result =
      scene(square + "v nan 0 0\nv 1e39 0 0\nv 0 2e18 0\nf 1 2 3\nf 1 2 5\nf 1 2 6\nf 1 2 7\n");
  EXPECT_TRUE(keeps_promises(result));
  EXPECT_EQ(result.counts.used, 1u);
  EXPECT_EQ(result.counts.non_finite, 3u);
  EXPECT_THAT(result.warnings, Contains(HasSubstr("(lines 9, 10, 11)")));
}

TEST_F(LoadObj, LargestAndSmallestSizes) {
  EXPECT_TRUE(keeps_promises(scene("v 0 0 0\nv 1.8e18 0 0\nv 0 1.8e18 0\nf 1 2 3\n")));
  EXPECT_TRUE(keeps_promises(scene("v 0 0 0\nv 1e-30 0 0\nv 0 1e-30 0\nf 1 2 3\n")));
}

TEST_F(LoadObj, DecimalCommas) {
  const Scene result = scene("v 0 0 0\nv 0,5 0 0\nv 0 0,5 0\nf 1 2 3\n");
  EXPECT_EQ(result.meshes[0].positions[1], vec3(0.5f, 0, 0));
  EXPECT_THAT(result.warnings,
              ElementsAre("2 lines with decimal commas, read as points (lines 2, 3)"));
}

TEST_F(LoadObj, ConcavePolygon) {
  const Scene result = scene("v 2 1 0\nv 0 0 0\nv 2 -1 0\nv 1 0 0\nf 1 2 3 4\n");
  EXPECT_EQ(result.counts.used, 2u);
  for (const vec3& normal : result.meshes[0].normals)
    EXPECT_EQ(normal, vec3(0, 0, 1));
}

TEST_F(LoadObj, PolygonOf5000Corners) {
  std::ostringstream text;
  std::ostringstream face;
  for (int i = 0; i < 5000; ++i) {
    const double angle = 2.0 * 3.14159265358979 * i / 5000.0;
    text << "v " << std::cos(angle) << " 0 " << std::sin(angle) << "\n";
    face << " " << i + 1;
  }
  EXPECT_EQ(scene(text.str() + "f" + face.str() + "\n").counts.used, 4998u);
}

TEST_F(LoadObj, NormalsAreMadeUnit) {
  const Scene result = scene(square + "vn 0 0 55\nf 1//1 2//1 3//1\n");
  EXPECT_EQ(result.meshes[0].normals[0], vec3(0, 0, 1));
}

TEST_F(LoadObj, ZeroAndInfiniteNormalsAreComputed) {
  const Scene result = scene(square + "vn 0 0 0\nvn nan 0 1\nf 1//1 2//2 3//1\n");
  for (const vec3& normal : result.meshes[0].normals)
    EXPECT_EQ(normal, vec3(0, 0, 1));
}

TEST_F(LoadObj, MaterialsInUse) {
  folder.file("my colours.mtl",
              "newmtl red\nKd 1 0 0\nnewmtl unused\nnewmtl dark blue\nKd 0 0 0.2\n");
  const Scene result = scene("mtllib my colours.mtl\n" + square +
                             "f 1 2 3\nusemtl dark blue\nf 1 3 4\nusemtl red\nf 1 2 4\n");
  ASSERT_EQ(result.materials.size(), 3u);
  EXPECT_EQ(result.materials[1].albedo, vec3(0, 0, 0.2f));
  EXPECT_EQ(result.materials[2].albedo, vec3(1, 0, 0));
  EXPECT_THAT(result.meshes[0].materials, ElementsAre(0u, 1u, 2u));
  EXPECT_THAT(result.warnings, IsEmpty());
}

TEST_F(LoadObj, SeveralLibrariesOnOneLine) {
  folder.file("a.mtl", "newmtl a\nKd 1 0 0\n");
  folder.file("b c.mtl", "newmtl b\nKd 0 1 0\n");
  const Scene result =
      scene("mtllib a.mtl b\\ c.mtl\n" + square + "usemtl b\nf 1 2 3\nusemtl a\nf 1 3 4\n");
  EXPECT_EQ(result.materials[0].albedo, vec3(0, 1, 0));
  EXPECT_THAT(result.warnings, IsEmpty());
}

TEST_F(LoadObj, AMissingLibraryIsToldOnce) {
  const Scene result = scene("mtllib no.mtl\nmtllib no.mtl\n" + square + "usemtl a\nf 1 2 3\n");
  EXPECT_EQ(result.materials[0].name, "a");
  EXPECT_THAT(result.warnings,
              ElementsAre("material file no.mtl: the file does not exist; its materials are grey"));
}

TEST_F(LoadObj, UnknownMaterialsAreNamed) {
  folder.file("a.mtl", "newmtl a\n");
  const Scene result = scene("mtllib a.mtl\n" + square + "usemtl b\nf 1 2 3\n");
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("shown grey: b")));
}

TEST_F(LoadObj, TexturesAreSharedAndFoundInAnyCase) {
  folder.file("maps/Red.bmp", red_image());
  folder.file("a.mtl", "newmtl a\nmap_Kd maps\\red.bmp\nnewmtl b\nmap_Kd maps\\red.bmp\n");
  const Scene result = scene("mtllib a.mtl\n" + square + "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n");
  ASSERT_EQ(result.textures.size(), 1u);
  EXPECT_EQ(result.textures[0].texels[0], 0xff0000ffu);
  EXPECT_EQ(result.materials[0].texture, 0u);
  EXPECT_EQ(result.materials[1].texture, 0u);
  EXPECT_THAT(result.warnings, IsEmpty());
}

TEST_F(LoadObj, MissingAndBrokenTexturesAreToldOnce) {
  folder.file("broken.png", "no image");
  folder.file("a.mtl",
              "newmtl a\nmap_Kd no.png\nnewmtl b\nmap_Kd no.png\nnewmtl c\nmap_Kd broken.png\n");
  const Scene result = scene("mtllib a.mtl\n" + square +
                             "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\nusemtl c\nf 1 2 4\n");
  EXPECT_EQ(result.materials[0].texture, tracer::none);
  EXPECT_THAT(result.warnings,
              ElementsAre("texture no.png: the file does not exist; material a is shown without it",
                          HasSubstr("broken.png: cannot be read as an image")));
}

TEST_F(LoadObj, TexturesOutsideAreRefused) {
  folder.file("red.bmp", red_image());
  folder.file("scene/a.mtl", "newmtl a\nmap_Kd ../red.bmp\n");
  const Scene result =
      load_obj(folder.file("scene/x.obj", "mtllib a.mtl\n" + square + "usemtl a\nf 1 2 3\n"), {});
  EXPECT_THAT(result.textures, IsEmpty());
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("outside of the scene's folder")));
}

TEST_F(LoadObj, TextureScaleMovesUvs) {
  folder.file("red.bmp", red_image());
  folder.file("a.mtl", "newmtl a\nmap_Kd -s 2 3 -o 0.5 red.bmp\nnewmtl b\nmap_Kd red.bmp\n");
  const Scene result = scene("mtllib a.mtl\n" + square +
                             "vt 1 1\nusemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 1/1 3/1 4/1\n");
  EXPECT_EQ(result.meshes[0].uvs[0], vec2(2.5f, 3.0f));
  EXPECT_EQ(result.meshes[0].uvs[5], vec2(1.0f, 1.0f));
}

TEST_F(LoadObj, InvertedTransparencyIsMended) {
  folder.file("a.mtl", "newmtl a\nTr 1\n");
  const Scene result = scene("mtllib a.mtl\n" + square + "usemtl a\nf 1 2 3\n");
  EXPECT_EQ(result.materials[0].transmission, 0.0f);
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("fully transparent")));
}

TEST_F(LoadObj, RefusesWhatIsNoObj) {
  EXPECT_THAT(refusal(""), HasSubstr("scene.obj: the file is empty"));
  EXPECT_THAT(refusal("Dear reader,\nthis is prose.\n"), HasSubstr("not the text of a Wavefront"));
  EXPECT_THAT(refusal(std::string("\x89PNG\r\n\x1a\n\0\0\0\rv 1 2 3", 20)),
              HasSubstr("not the text of a Wavefront"));
}

TEST_F(LoadObj, RefusesWhatHasNoTriangles) {
  EXPECT_THAT(refusal("# only this\n"), HasSubstr("the file has no faces"));
  EXPECT_THAT(refusal(square + "l 1 2\np 3\n"), HasSubstr("the file has no faces"));
  EXPECT_THAT(refusal(square + "f 1 1 1\n"), HasSubstr("1 triangle left out: no area (line 5)"));
}

TEST_F(LoadObj, ATruncatedFileShowsItsBeginning) {
  const Scene result = scene(square + "f 1 2 3\nf 1 3");
  EXPECT_EQ(result.counts.used, 1u);
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("(line 6)")));
}

TEST_F(LoadObj, AnyPrefixLoadsOrIsRefused) {
  const std::string text = "mtllib a.mtl\n" + square + "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n";
  for (size_t length = 0; length < text.size(); ++length) {
    const std::string message = refusal(text.substr(0, length));
    EXPECT_THAT(message, AnyOf("", HasSubstr("scene.obj: "))) << length;
  }
}

TEST_F(LoadObj, AStoppedLoadSaysSo) {
  std::stop_source stop;
  stop.request_stop();
  const auto file = folder.file("scene.obj", square + "f 1 2 3\n");
  EXPECT_THAT(message_of([&] { load_obj(file, {stop.get_token(), {}}); }), HasSubstr("stopped"));
}

TEST_F(LoadObj, ProgressRises) {
  std::vector<float> fractions;
  const auto file = folder.file("scene.obj", square + "f 1 2 3\n");
  load_obj(file, {{}, [&](float fraction, std::string_view) { fractions.push_back(fraction); }});
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_GE(fractions.size(), 2u);
}

}  // namespace
