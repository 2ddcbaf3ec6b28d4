// Which scene: names, parameters, files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "temporary_folder.h"
#include "tracer/scene/scene.h"

namespace {

using testing::AllOf;
using testing::HasSubstr;
using tracer::load_scene;
using tracer::parse_scene_source;
using tracer::SceneSource;

std::string refusal(const std::string& name) {
  return message_of([&] {
    SceneSource source;
    source.name = name;
    load_scene(source, {});
  });
}

TEST(SceneSource, NameAlone) {
  EXPECT_EQ(parse_scene_source("teapots"), (SceneSource{"teapots", {}, ""}));
  EXPECT_EQ(parse_scene_source("dir/a=b:c.obj").name, "dir/a=b:c.obj");
}

TEST(SceneSource, Parameters) {
  EXPECT_EQ(parse_scene_source("terrain:triangles=1e6,seed=-2"),
            (SceneSource{"terrain", {{"triangles", 1e6}, {"seed", -2}}, ""}));
}

TEST(SceneSource, ThereAndBack) {
  for (const char* text : {"teapots", "terrain:triangles=1000000,seed=0.1", "x.obj"}) {
    EXPECT_EQ(to_string(parse_scene_source(text)), text);
  }
}

TEST(SceneSource, MalformedParameters) {
  for (const char* text :
       {"terrain:", "terrain:seed", "terrain:seed=", "terrain:=1", "terrain:seed=1,",
        "terrain:seed=1x", "terrain:seed=nan", "terrain:seed=1,seed=2"}) {
    EXPECT_THAT(message_of([&] { parse_scene_source(text); }),
                AllOf(HasSubstr(text), HasSubstr("write SCENE:name=number")));
  }
  EXPECT_NE(message_of([] { parse_scene_source(""); }), "");
}

TEST(LoadScene, UnknownNameListsTheKnownOnes) {
  EXPECT_THAT(refusal("teapotz"),
              AllOf(HasSubstr("teapotz: the file does not exist"), HasSubstr("teapots")));
}

TEST(LoadScene, FilesByTheirEnding) {
  const TemporaryFolder folder;
  SceneSource source;
  source.name = folder.file("a.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").string();
  EXPECT_EQ(load_scene(source, {}).counts.used, 1u);
  EXPECT_THAT(refusal(folder.file("a.ply", "ply\n").string()),
              AllOf(HasSubstr("a.ply: "), HasSubstr("supported are .obj")));
}

TEST(LoadScene, WhatIsNoFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal(folder.path.string()), HasSubstr("is a folder"));
  const auto pipe = folder.path / "a.obj";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(refusal(pipe.string()), HasSubstr("not a regular file"));
}

TEST(LoadScene, FilesHaveNoParameters) {
  const TemporaryFolder folder;
  SceneSource source;
  source.name = folder.file("a.obj", "f 1 2 3\n").string();
  source.parameters = {{"seed", 1.0}};
  EXPECT_THAT(message_of([&] { load_scene(source, {}); }), HasSubstr("only built-in scenes"));
}

TEST(LoadScene, SkyFileReplacesTheSky) {
  const TemporaryFolder folder;
  SceneSource source;
  source.name = folder.file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").string();
  source.sky_file =
      folder.file("s.hdr", "#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x40\x20\x81")
          .string();
  const tracer::Scene scene = load_scene(source, {});
  EXPECT_EQ(scene.sky_image.name, "s.hdr");
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(LoadScene, AFileStandsUnderTheDaylightSky) {
  const TemporaryFolder folder;
  SceneSource source;
  source.name = folder.file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").string();
  EXPECT_EQ(load_scene(source, {}).sky_image.name, "sky.hdr");
}

TEST(LoadScene, ABrokenSkyIsAWarning) {
  const TemporaryFolder folder;
  SceneSource source;
  source.name = folder.file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").string();
  source.sky_file = (folder.path / "no.hdr").string();
  const tracer::Scene scene = load_scene(source, {});
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_THAT(scene.warnings[0], HasSubstr("no.hdr: the file does not exist"));
  EXPECT_EQ(scene.sky_image.name, "sky.hdr");
}

}  // namespace
