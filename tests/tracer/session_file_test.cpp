// Saved sessions: nothing is lost on the way out and in, and rubbish is refused in words.
#include "tracer/session_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tracer/temporary_folder.h"
#include "tracer/file_io.h"

namespace tracer {
namespace {

using testing::HasSubstr;

// Every field differs from its default.
SavedSession unusual() {
  SavedSession session;
  Settings& settings = session.settings;
  settings.source = {"terrain", {{"triangles", 5000}, {"seed", 3}}, ""};
  settings.build = {"binned", 16, 8, 40, 2.5f, 1.5f};
  settings.layout = "other";
  settings.time = 1.25f;
  settings.render = {640, 480, 3, 99, false};
  Look look;
  look.camera = {vec3(1, 2, 3), vec3(4, 5, 6), vec3(0, 0, 1), 33.5f, true};
  look.lights = {{"lamp", vec3(1, 2, 3), vec3(0.1f, 0.2f, 0.3f), 7.5f, false}, {}};
  look.ambient = vec3(0.3f, 0.2f, 0.1f);
  look.sky = {false, 45.0f, 2.0f, vec3(0.1f)};
  look.materials = {
      {"brass", vec3(0.9f, 0.7f, 0.1f), 2, false, 0.25f, 0.5f, 1.75f, vec3(0.5f), vec3(1, 0, 0)},
      {}};
  settings.look = look;
  session.view = {"counter", "leaves", "shadow", "turbo", ValueRange{1.5f, 80.0f},
                  true,      -1.5f,    "none",   false};
  return session;
}

TEST(SessionFile, KeepsEveryField) {
  EXPECT_EQ(parse_session(session_json(unusual()), "f"), unusual());
}

TEST(SessionFile, KeepsWhatIsNotThere) {
  EXPECT_EQ(parse_session(session_json({}), "f"), SavedSession());
  EXPECT_EQ(parse_session(R"({"schema":1})", "f"), SavedSession());
}

TEST(SessionFile, RefusesWhatIsNotASession) {
  for (const char* text : {"", "{", "[]", "{}", "\xff", "7"}) {
    EXPECT_THAT(message_of([&] { parse_session(text, "my.bvhscope"); }),
                HasSubstr("my.bvhscope: this is not a saved session"))
        << text;
  }
}

TEST(SessionFile, RefusesALaterSchema) {
  EXPECT_THAT(message_of([] { parse_session(R"({"schema":2})", "f"); }), HasSubstr("later"));
}

TEST(SessionFile, NamesTheEntryOfAWrongType) {
  const auto message = [](const char* text) {
    return message_of([text] { parse_session(text, "f"); });
  };
  EXPECT_EQ(message(R"({"schema":1,"settings":{"render":{"width":"wide"}}})"),
            "f: settings.render.width is not a whole number of that range");
  EXPECT_EQ(message(R"({"schema":1,"settings":{"render":{"width":99999999999}}})"),
            "f: settings.render.width is not a whole number of that range");
  EXPECT_EQ(message(R"({"schema":1,"settings":{"build":{"bins":-1}}})"),
            "f: settings.build.bins is not a whole number of that range");
  EXPECT_EQ(message(R"({"schema":1,"settings":{"look":{"lights":[{},{"position":[1,2]}]}}})"),
            "f: settings.look.lights[1].position is not three numbers");
  EXPECT_EQ(message(R"({"schema":1,"settings":{"time":1e300}})"),
            "f: settings.time is not a finite number");
  EXPECT_EQ(message(R"({"schema":1,"view":[]})"), "f: view is not an object");
  EXPECT_EQ(message(R"({"schema":1,"view":{"legend":1}})"), "f: view.legend is not true or false");
}

TEST(SessionFile, StoresTheSceneRelativeToItself) {
  const TemporaryFolder folder;
  SavedSession session;
  session.settings.source.name = (folder.path / "models/house.obj").string();
  session.settings.source.sky_file = "/elsewhere/sky.hdr";
  write_session(folder.path / "a.bvhscope", session);
  const std::string text = read_file(folder.path / "a.bvhscope", 100000);
  EXPECT_THAT(text, HasSubstr(R"("name": "models/house.obj")"));
  EXPECT_THAT(text, HasSubstr(R"("sky_file": "/elsewhere/sky.hdr")"));
  EXPECT_EQ(read_session(folder.path / "a.bvhscope"), session);
}

TEST(SessionFile, ABuiltinSceneHasNoFolder) {
  const TemporaryFolder folder;
  write_session(folder.path / "a.bvhscope", unusual());
  EXPECT_EQ(read_session(folder.path / "a.bvhscope"), unusual());
}

TEST(SessionFile, IsKnownByItsEnding) {
  EXPECT_TRUE(is_session_file("a/b.bvhscope"));
  EXPECT_FALSE(is_session_file("b.obj"));
  EXPECT_FALSE(is_session_file("teapots"));
}

}  // namespace
}  // namespace tracer
