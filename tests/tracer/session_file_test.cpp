// Session files: there and back, and what is wrong in them.
#include "tracer/session_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "temporary_folder.h"
#include "tracer/file_io.h"

namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using tracer::read_session;
using tracer::SavedSession;
using tracer::Settings;
using tracer::vec3;
using tracer::ViewOptions;
using tracer::write_session;

struct SessionFile : testing::Test {
  TemporaryFolder folder;
  std::filesystem::path file = folder.path / "a.bvhscope";

  SavedSession read(const std::string& text) {
    return read_session(folder.file("a.bvhscope", text));
  }
  std::string refusal(const std::string& text) {
    return message_of([&] { read(text); });
  }
  SavedSession again(const Settings& settings, const ViewOptions& view = {}) {
    write_session(file, {settings, view});
    return read_session(file);
  }
};

Settings edited() {
  Settings settings;
  settings.source = {"terrain", {{"triangles", 1e6}, {"seed", 0.1}}, ""};
  settings.build.rebraid = true;
  settings.build.bins = 16;
  settings.build.max_leaf_size = 8;
  settings.build.max_depth = 20;
  settings.build.traversal_cost = 0.1f;
  settings.build.intersection_cost = 3.3f;
  settings.time = 2.25f;
  settings.deformer = {"bend", -1.5f, "z", 0.1f};
  settings.motion = {"spin", 0.3f};
  settings.update = {"growth", 17, 1.25f, 24.0f};
  settings.render = {640, 480, 3, 7, false, {"packet", "single", "stream", "automatic"}, true};
  tracer::Look& look = settings.look.emplace();
  look.materials.resize(2);
  look.materials[1] = {"glass", vec3(0.1f), 4, false, 0.25f, 0.5f, 1.33f, vec3(0.9f), vec3(7.0f)};
  look.lights = {{"lamp", vec3(3, 10, 2), vec3(150, 150, 120), 0.3f, false}};
  look.sky = {false, -30.0f, 0.7f, vec3(0.1f, 0.2f, 0.3f)};
  look.ambient = vec3(0.2f, 0.2f, 0.4f);
  look.camera = {vec3(1, 2, 3), vec3(4, 5, 6), vec3(0, 0, 1), 33.3f, true};
  return settings;
}

TEST_F(SessionFile, DefaultsComeBack) {
  const SavedSession session = again({});
  EXPECT_EQ(session.settings, Settings{});
  EXPECT_EQ(session.view, ViewOptions{});
  EXPECT_THAT(session.warnings, IsEmpty());
}

TEST_F(SessionFile, EverySettingComesBackButTextureIndices) {
  Settings expected = edited();
  const SavedSession session = again(expected);
  expected.look->materials[1].texture = tracer::none;
  EXPECT_EQ(session.settings, expected);
  EXPECT_THAT(session.warnings, IsEmpty());
}

TEST_F(SessionFile, EveryViewOptionComesBack) {
  ViewOptions view;
  view.view = "counter";
  view.counter = "triangles";
  view.ray_class = "shadow";
  view.colormap = "turbo";
  view.range = tracer::ValueRange{-0.1f, 1e20f};
  view.logarithmic = true;
  view.exposure = -1.7f;
  view.tone_map = "none";
  view.legend = false;
  view.boxes = {true, "subtree", "tlas", 3,     7,     "observed", "shadow",
                true, false,     true,   false, false, 2.5f};
  const SavedSession session = again({}, view);
  EXPECT_EQ(session.view, view);
  EXPECT_THAT(session.warnings, IsEmpty());
}

TEST_F(SessionFile, BoxesOfNoLevelAreMended) {
  const SavedSession session =
      read(R"({"schema": 1, "view": {"boxes": {"first_level": 5, "last_level": 3}}})");
  EXPECT_EQ(session.view.boxes.first_level, 3);
  EXPECT_EQ(session.view.boxes.last_level, 5);
  EXPECT_THAT(session.warnings, ElementsAre(HasSubstr("first_level")));
}

TEST_F(SessionFile, NumbersAreWrittenAsTheyAreRead) {
  Settings settings;
  settings.build.traversal_cost = 0.1f;
  write_session(file, {settings, {}});
  EXPECT_THAT(tracer::read_file(file, 100'000), HasSubstr("\"traversal_cost\": 0.1,"));
}

TEST_F(SessionFile, SceneFilesAreRelativeToTheSession) {
  Settings settings;
  settings.source.name = (folder.path / "scenes" / "car.obj").string();
  settings.source.sky_file = "/elsewhere/sky.hdr";
  write_session(file, {settings, {}});
  EXPECT_THAT(tracer::read_file(file, 100'000), AllOf(HasSubstr("\"name\": \"scenes/car.obj\""),
                                                      HasSubstr("\"/elsewhere/sky.hdr\"")));
  EXPECT_EQ(read_session(file).settings.source, settings.source);
}

TEST_F(SessionFile, IsKnownByItsEnding) {
  EXPECT_TRUE(tracer::is_session_file("a/b.bvhscope"));
  EXPECT_FALSE(tracer::is_session_file("b.obj"));
  EXPECT_FALSE(tracer::is_session_file("teapots"));
}

TEST_F(SessionFile, BuiltInScenesAreNoFiles) {
  Settings settings;
  settings.source.name = "massive";
  EXPECT_EQ(again(settings).settings.source.name, "massive");
}

TEST_F(SessionFile, NamesThatAreNotUtf8AreSavedAllTheSame) {
  Settings settings = edited();
  settings.look->materials[0].name = "\xff\xfe";
  EXPECT_NO_THROW(again(settings));
}

TEST_F(SessionFile, WhatIsMissingKeepsItsDefault) {
  EXPECT_EQ(read(R"({"schema": 1})").settings, Settings{});
  EXPECT_EQ(read(R"({"schema": 1, "settings": {"render": {"width": 5}}})").settings.render.width,
            5);
}

TEST_F(SessionFile, UnknownFieldsAreTold) {
  EXPECT_THAT(read(R"({"schema": 1, "new": 2, "settings": {"render": {"fog": 1}}})").warnings,
              ElementsAre("new: not known, ignored", "settings.render.fog: not known, ignored"));
}

TEST_F(SessionFile, UnknownIdsKeepTheDefault) {
  const SavedSession session = read(
      R"({"schema": 1, "settings": {"build": {"builder": "magic"}}, "view": {"ray_class": "x"}})");
  EXPECT_EQ(session.settings.build.builder, "binned");
  EXPECT_EQ(session.view.ray_class, "all");
  EXPECT_THAT(session.warnings,
              ElementsAre(HasSubstr("settings.build.builder: \"magic\" is not known, binned"),
                          HasSubstr("known are all, primary")));
}

TEST_F(SessionFile, ValuesAreBroughtIntoTheirRanges) {
  const SavedSession session = read(R"({"schema": 1, "settings": {"render": {"width": 1e300,
      "height": -5, "samples": 2.6}, "build": {"bins": 1}, "look": {"ambient": [-1, 0, 1e300]}}})");
  EXPECT_EQ(session.settings.render.width, 16384);
  EXPECT_EQ(session.settings.render.height, 1);
  EXPECT_EQ(session.settings.render.samples, 3);
  EXPECT_EQ(session.settings.build.bins, 2u);
  EXPECT_EQ(session.settings.look->ambient, vec3(0.0f, 0.0f, 1e30f));
  EXPECT_EQ(session.warnings.size(), 5u);
  EXPECT_THAT(session.warnings,
              testing::Contains("settings.render.height: -5 is outside 1..16384; 1 is used"));
}

TEST_F(SessionFile, AnUnknownKernelIsAutomatic) {
  const SavedSession session = read(R"({"schema": 1, "settings": {"render":
      {"kernels": {"primary": "x", "shadow": "packet", "random": "packet"}}}})");
  EXPECT_THAT(session.settings.render.kernels,
              ElementsAre("automatic", "packet", "automatic", "automatic"));
  EXPECT_THAT(session.warnings,
              ElementsAre(HasSubstr("settings.render.kernels.primary: \"x\" is not known"),
                          HasSubstr("settings.render.kernels.random: not known")));
}

TEST_F(SessionFile, SharesAboveOneAreMended) {
  const SavedSession session = read(R"({"schema": 1, "settings": {"look": {"materials":
      [{"name": "m", "reflectivity": 0.8, "transmission": 0.5}]}}})");
  EXPECT_EQ(session.settings.look->materials[0].reflectivity, 0.5f);
  EXPECT_EQ(session.warnings.size(), 1u);
}

TEST_F(SessionFile, ARangeTheWrongWayRoundIsTurned) {
  const SavedSession session = read(R"({"schema": 1, "view": {"range": {"lo": 5, "hi": 2}}})");
  EXPECT_EQ(session.view.range, (tracer::ValueRange{2.0f, 5.0f}));
}

TEST_F(SessionFile, ValuesOfAnotherKindAreRefused) {
  const char* const wrong[][2] = {
      {R"({"settings": 1})", "settings: an object is expected"},
      {R"({"settings": {"time": "x"}})", "settings.time: a number is expected"},
      {R"({"settings": {"render": {"shadows": 1}}})", "settings.render.shadows: true or false"},
      {R"({"view": {"view": 1}})", "view.view: a text is expected"},
      {R"({"settings": {"look": {"lights": {}}}})", "settings.look.lights: a list is expected"},
      {R"({"settings": {"look": {"lights": [1]}}})", "settings.look.lights[0]: an object"},
      {R"({"settings": {"look": {"ambient": [1, 2]}}})", "settings.look.ambient: a list of three"}};
  for (const auto& [text, message] : wrong) {
    const std::string with_schema = "{\"schema\": 1, " + std::string(text).substr(1);
    EXPECT_THAT(refusal(with_schema), AllOf(StartsWith(file.string()), HasSubstr(message)));
  }
}

TEST_F(SessionFile, WhatIsNoSessionIsRefused) {
  EXPECT_THAT(refusal(""), HasSubstr("this is not a saved session"));
  EXPECT_THAT(refusal("v 0 0 0"), HasSubstr("this is not a saved session"));
  EXPECT_THAT(refusal(R"({"schema": 1, "settings": {"time": 1e999}})"),
              HasSubstr("this is not a saved session"));
  EXPECT_THAT(refusal("[]"), HasSubstr("this is not a saved session"));
  EXPECT_THAT(refusal("{}"), HasSubstr("this is not a saved session"));
  EXPECT_THAT(refusal(R"({"schema": 2})"), HasSubstr("written by a later bvhscope"));
  EXPECT_NE(refusal(std::string(100'000, '[')), "");
}

TEST_F(SessionFile, EveryCutOffFileIsRefused) {
  write_session(file, {edited(), {}});
  const std::string text = tracer::read_file(file, 100'000);
  for (size_t length = 0; length + 2 < text.size(); length += 13) {
    EXPECT_NE(refusal(text.substr(0, length)), "") << length;
  }
}

TEST_F(SessionFile, AFolderAndAMissingFileAreRefused) {
  EXPECT_THAT(message_of([&] { read_session(folder.path); }), HasSubstr("is a folder"));
  EXPECT_THAT(message_of([&] { read_session(folder.path / "no"); }), HasSubstr("does not exist"));
}

}  // namespace
