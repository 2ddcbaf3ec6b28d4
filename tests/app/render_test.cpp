// The render command.
#include <cstdlib>
#include <filesystem>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.h"
#include "tests/tracer/temporary_folder.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/file_io.h"
#include "tracer/scene/load_image.h"
#include "tracer/session_file.h"

namespace app {
namespace {

using testing::HasSubstr;

TEST(Render, WritesAPngOfTheAskedSize) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.png";
  const Result result = run(small_render(file));
  EXPECT_EQ(result.status, exit_fine) << result.error;
  EXPECT_EQ(result.out + result.error, "");
  const tracer::Texture picture = tracer::load_texture(file);
  EXPECT_EQ(picture.width, 40u);
  EXPECT_EQ(picture.height, 30u);
}

TEST(Render, EveryViewAndCounterCanBeWritten) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.png";
  for (const std::string id :
       {"albedo", "uv", "uv_checker", "normal", "shading_normal", "facing", "depth", "barycentric",
        "triangle", "instance", "material", "wireframe", "counter", "cost", "ray_depth"}) {
    EXPECT_EQ(run(small_render(file) + std::vector<std::string>{"--view", id}).status, exit_fine)
        << id;
  }
}

TEST(Render, DrawsBoxes) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.png";
  using Words = std::vector<std::string>;
  ASSERT_EQ(run(small_render(file)).status, exit_fine);
  const std::string without = bytes_of(file);
  for (const Words& words :
       {Words{"--boxes", "1:3"}, Words{"--boxes", "2", "--box-fill", "--box-no-wire"},
        Words{"--boxes", "leaves", "--box-tree", "blas", "--box-color", "sah", "--box-log"},
        Words{"--boxes", "1:3", "--box-color", "observed", "--box-rays", "shadow"},
        Words{"--boxes", "children", "--box-node", "0:0"},
        Words{"--boxes", "node", "--box-node", "tlas:0", "--box-width", "2"}}) {
    const Result result = run(small_render(file) + words);
    EXPECT_EQ(result.status, exit_fine) << words[1] << result.error;
    EXPECT_NE(bytes_of(file), without) << words[1];
  }
  const Result none = run(small_render(file) + Words{"--boxes", "200"});
  EXPECT_EQ(none.status, exit_fine);
  EXPECT_THAT(none.error, HasSubstr("no such nodes"));
}

TEST(Render, SaysWhatIsWrongWithBoxes) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::vector<std::string>& words) {
    const Result result = run(small_render(folder.path / "a.png") + words);
    EXPECT_EQ(result.status, exit_usage) << words.back();
    return result.error;
  };
  EXPECT_THAT(error_of({"--boxes", "5:3"}), HasSubstr("3:5"));
  EXPECT_THAT(error_of({"--boxes", "twigs"}), HasSubstr("leaves"));
  EXPECT_THAT(error_of({"--boxes", "1:999"}), HasSubstr("255"));
  EXPECT_THAT(error_of({"--boxes", "children"}), HasSubstr("--box-node"));
  EXPECT_THAT(error_of({"--boxes", "node", "--box-node", "0"}), HasSubstr("MESH:NODE"));
  EXPECT_THAT(error_of({"--boxes", "1", "--box-no-wire"}), HasSubstr("--box-fill"));
  EXPECT_THAT(error_of({"--boxes", "1", "--box-color", "beauty"}), HasSubstr("sah"));
}

TEST(Render, MinusIsTheOutputStream) {
  const Result result = run(small_render("-"));
  EXPECT_EQ(result.status, exit_fine);
  EXPECT_EQ(result.out.substr(1, 3), "PNG");
}

TEST(Render, WritesLight) {
  const TemporaryFolder folder;
  EXPECT_EQ(run(small_render(folder.path / "a.exr")).status, exit_fine);
  EXPECT_EQ(bytes_of(folder.path / "a.exr").substr(0, 4), "\x76\x2f\x31\x01");
  EXPECT_EQ(run(small_render(folder.path / "a.HDR")).status, exit_fine);
  EXPECT_EQ(bytes_of(folder.path / "a.HDR").substr(0, 10), "#?RADIANCE");
}

TEST(Render, SameBytesForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  for (const char* ending : {".png", ".exr"}) {
    const std::string one = folder.path / (std::string("one") + ending);
    const std::string two = folder.path / (std::string("two") + ending);
    const std::vector<std::string> line = {"render", "showcase", "--size", "100x70", "--spp", "3"};
    ASSERT_EQ(run(line + std::vector<std::string>{"--threads", "1", "-o", one}).status, exit_fine);
    ASSERT_EQ(run(line + std::vector<std::string>{"--threads", "2", "-o", two}).status, exit_fine);
    EXPECT_EQ(bytes_of(one), bytes_of(two)) << ending;
  }
}

TEST(Render, SameBytesForAnyInstructionSetKernelAndOrderOfShadowRays) {
  const TemporaryFolder folder;
  const std::vector<std::string> line = {"render", "teapots",  "--size",
                                         "60x45",  "--layout", "wide8"};
  const std::string plain = folder.path / "plain.png";
  const std::string other = folder.path / "other.png";
  ASSERT_EQ(run(line + std::vector<std::string>{"-o", plain}).status, exit_fine);
  const std::string isa(tracer::isas().back().id);
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--isa", isa},
                                               {"--kernel", "primary=single"},
                                               {"--kernel", "shadow=stream"},
                                               {"--occlusion-order", "area"},
                                               {"--occlusion-order", "cost"}}) {
    ASSERT_EQ(run(line + more + std::vector<std::string>{"-o", other}).status, exit_fine);
    EXPECT_EQ(bytes_of(plain), bytes_of(other)) << more[1];
  }
  EXPECT_EQ(run(line + std::vector<std::string>{"-o", other, "--occlusion-order", "x"}).status,
            exit_usage);
}

TEST(Render, OptionsChangeThePicture) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.png";
  const std::vector<std::string> line = {"render", "showcase", "--size", "60x45", "-o", file};
  ASSERT_EQ(run(line).status, exit_fine);
  const std::string plain = bytes_of(file);
  const std::vector<std::vector<std::string>> changes = {
      {"--eye", "-3,4,5"},    {"--target", "1,0,0"},  {"--fov", "70"},      {"--orthographic"},
      {"--no-shadows"},       {"--depth", "0"},       {"--spp", "2"},       {"--exposure", "-1"},
      {"--tone-map", "none"}, {"--counter", "nodes"}, {"--rays", "shadow"}, {"--view", "depth"},
      {"--set", "detail=3"}};
  for (const std::vector<std::string>& change : changes) {
    EXPECT_EQ(run(line + change).status, exit_fine) << change[0];
    EXPECT_NE(bytes_of(file), plain) << change[0];
  }
}

TEST(Render, HeatMapOptionsChangeThePicture) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.png";
  const std::vector<std::string> line = {"render",  "needles", "--set", "triangles=50", "--size",
                                         "500x300", "-o",      file,    "--view",       "cost"};
  ASSERT_EQ(run(line).status, exit_fine);
  const std::string plain = bytes_of(file);
  const std::vector<std::vector<std::string>> changes = {
      {"--colormap", "turbo"}, {"--range", "0:7.5"}, {"--log"},
      {"--no-legend"},         {"--leaf-size", "1"}, {"--bins", "2"},
      {"--tree-depth", "2"},   {"--ct", "9"},        {"--ci", "9"}};
  for (const std::vector<std::string>& change : changes) {
    EXPECT_EQ(run(line + change).status, exit_fine) << change[0];
    EXPECT_NE(bytes_of(file), plain) << change[0];
  }
}

TEST(Render, TimeMovesTheTeapots) {
  const TemporaryFolder folder;
  const std::string file = folder.path / "a.png";
  const std::vector<std::string> line = {"render", "teapots", "--set", "detail=2", "--size",
                                         "80x45",  "--spp",   "1",     "-o",       file};
  ASSERT_EQ(run(line).status, exit_fine);
  const std::string plain = bytes_of(file);
  ASSERT_EQ(run(line + std::vector<std::string>{"--time", "1.5"}).status, exit_fine);
  EXPECT_NE(bytes_of(file), plain);
}

TEST(Render, ADeformerAndAMotionChangeThePicture) {
  const TemporaryFolder folder;
  const std::string still = folder.path / "still.png";
  run(small_render(still));
  const std::vector<std::vector<std::string>> changes = {
      {"--deform", "twist", "--amount", "1", "--axis", "y", "--speed", "0"},
      {"--deform", "explode", "--time", "2"},
      {"--motion", "spin", "--time", "0.5"}};
  for (const std::vector<std::string>& change : changes) {
    const std::string file = folder.path / "moved.png";
    EXPECT_EQ(run(small_render(file) + change).status, exit_fine);
    EXPECT_NE(bytes_of(file), bytes_of(still)) << change[1];
  }
}

TEST(Render, NoAmountIsNoDeformer) {
  const TemporaryFolder folder;
  const std::string still = folder.path / "still.png";
  const std::string nothing = folder.path / "nothing.png";
  run(small_render(still));
  run(small_render(nothing) + std::vector<std::string>{"--deform", "twist", "--amount", "0"});
  EXPECT_EQ(bytes_of(nothing), bytes_of(still));
}

TEST(Render, ASessionBringsItsSettingsAndTheLineChangesThem) {
  const TemporaryFolder folder;
  tracer::SavedSession session;
  session.settings.source = tracer::parse_scene_source("needles:triangles=50");
  session.settings.render.width = 33;
  session.settings.render.height = 22;
  session.settings.render.samples = 1;
  session.view.view = "normal";
  tracer::write_session(folder.path / "a.bvhscope", session);
  const std::string file = folder.path / "a.png";
  ASSERT_EQ(run({"render", folder.path / "a.bvhscope", "-o", file}).status, exit_fine);
  const tracer::Texture saved = tracer::load_texture(file);
  EXPECT_EQ(saved.width, 33u);
  ASSERT_EQ(
      run({"render", folder.path / "a.bvhscope", "-o", file, "--size", "44x22", "--view", "depth"})
          .status,
      exit_fine);
  EXPECT_EQ(tracer::load_texture(file).width, 44u);
}

}  // namespace
}  // namespace app
