// What single controls of the panels do to the settings.
#include <gtest/gtest.h>

#include "driver.h"
#include "ui/actions.h"
#include "ui/panels.h"

namespace {

using ui::Driver;

TEST(ScenePanel, ChoosingABuiltInSceneAsksForIt) {
  Driver driver;
  driver.choose("scene/Scene", "terrain");
  EXPECT_EQ(driver.requests.open, "terrain");
}

TEST(ScenePanel, AParameterMakesTheSceneAnewWhenTheHandLetsGoAndKeepsTheCamera) {
  Driver driver("needles:triangles=500");
  driver.edited.settings.look->camera.eye.x += 1.0f;
  const tracer::Camera camera = driver.edited.settings.look->camera;
  driver.drag("scene/parameters/Triangles", 40.0f);
  ASSERT_FALSE(driver.edited.settings.look.has_value());
  const double wanted = driver.edited.settings.source.parameters.at(0).value;
  EXPECT_NE(wanted, 500.0);
  driver.trace();
  ASSERT_TRUE(driver.edited.settings.look.has_value());
  EXPECT_EQ(driver.edited.settings.look->camera, camera);
}

TEST(ScenePanel, DefaultParametersComeBack) {
  Driver driver("needles:triangles=500");
  driver.click("scene/parameters/Default parameters");
  EXPECT_TRUE(driver.edited.settings.source.parameters.empty());
}

TEST(ScenePanel, AFilterKeepsTheInstancesWithThatName) {
  Driver driver("teapots:detail=2");
  driver.click("scene/Filter");
  driver.type("mirror");
  EXPECT_EQ(driver.state.instance_rows.rows.size(), 8u);
}

TEST(ScenePanel, AClickSelectsAnInstance) {
  Driver driver("teapots:detail=2");
  driver.click("scene/instances/3");
  EXPECT_EQ(driver.state.selection.instance, 3u);
}

TEST(LightsPanel, AddSelectsTheNewLightAndRemoveTakesItAway) {
  Driver driver;
  driver.show("lights");
  const size_t before = driver.edited.settings.look->lights.size();
  driver.click("lights/Add a light");
  ASSERT_EQ(driver.edited.settings.look->lights.size(), before + 1);
  EXPECT_EQ(driver.state.selection.light, before);
  const std::string added = "lights/light " + std::to_string(before + 1);
  driver.click(added + "/Remove");
  EXPECT_EQ(driver.edited.settings.look->lights.size(), before);
  EXPECT_EQ(driver.state.selection.light, tracer::none);
}

TEST(LightsPanel, ASelectedLightCanBeRenamed) {
  Driver driver;
  driver.show("lights");
  driver.click("lights/light 1/Select");
  driver.click("lights/light 1/Name");
  driver.type("!");
  EXPECT_NE(driver.edited.settings.look->lights[0].name.find('!'), std::string::npos);
}

TEST(LightsPanel, OffIsNotRemoved) {
  Driver driver;
  driver.show("lights");
  driver.click("lights/light 1/On");
  EXPECT_FALSE(driver.edited.settings.look->lights[0].on);
}

TEST(LightsPanel, TheOpenedSkyCanBeLeft) {
  Driver driver;
  driver.edited.settings.source.sky_file = "some.hdr";
  driver.show("lights");
  driver.click("lights/Scene's own sky");
  EXPECT_TRUE(driver.edited.settings.source.sky_file.empty());
}

TEST(MaterialsPanel, MirrorAndGlassShareTheLight) {
  Driver driver;
  driver.state.edited_material = 0;
  driver.show("materials");
  driver.click("materials/edit/Mirror");
  const tracer::Material& material = driver.edited.settings.look->materials[0];
  EXPECT_EQ(material.reflectivity, 1.0f);
  driver.drag("materials/edit/Glass share", 200.0f);
  EXPECT_EQ(material.transmission, 1.0f);
  EXPECT_EQ(material.reflectivity, 0.0f);
}

TEST(MaterialsPanel, AsLoadedTakesTheEditsBack) {
  Driver driver;
  driver.state.edited_material = 0;
  driver.show("materials");
  driver.click("materials/edit/Glass");
  ASSERT_NE(driver.edited.settings.look->materials[0], driver.snapshot->scene->materials[0]);
  driver.click("materials/edit/As loaded");
  EXPECT_EQ(driver.edited.settings.look->materials[0], driver.snapshot->scene->materials[0]);
}

TEST(MaterialsPanel, TheTextureIsSwitched) {
  Driver driver("teapots:detail=2");
  driver.state.edited_material = 0;
  driver.show("materials");
  driver.click("materials/edit/Texture");
  EXPECT_FALSE(driver.edited.settings.look->materials[0].use_texture);
}

TEST(MaterialsPanel, ThePickerEditsTheColour) {
  Driver driver;
  driver.state.edited_material = 0;
  driver.show("materials");
  const tracer::vec3 before = driver.edited.settings.look->materials[0].albedo;
  driver.click("materials/edit/Albedo/swatch");
  driver.click("materials/edit/Albedo/picker");
  EXPECT_NE(driver.edited.settings.look->materials[0].albedo, before);
}

TEST(RenderPanel, TheRayDepthGoesFromZeroToItsLimit) {
  Driver driver;
  driver.show("render");
  driver.drag("render/Ray depth", 400.0f);
  EXPECT_EQ(driver.edited.settings.render.ray_depth, tracer::max_ray_depth);
  driver.drag("render/Ray depth", -400.0f);
  EXPECT_EQ(driver.edited.settings.render.ray_depth, 0);
}

TEST(RenderPanel, OffersTheKernelsOfTheLayout) {
  Driver driver;
  driver.edited.settings.build.layout = "wide8";
  driver.show("render");
  auto& kernels = driver.edited.settings.render.kernels;
  driver.choose("render/Kernels/Shadow rays", "stream");
  EXPECT_EQ(kernels, (std::array<std::string, 4>{"automatic", "stream", "automatic", "automatic"}));
  driver.edited.settings.build.layout = "binary";  // has no streams
  driver.choose("render/Kernels/Primary rays", "packet");
  EXPECT_EQ(kernels, (std::array<std::string, 4>{"packet", "stream", "automatic", "automatic"}));
  driver.choose("render/Kernels/Primary rays", "automatic");
  EXPECT_EQ(kernels[0], "automatic");
}

TEST(RenderPanel, FastTestsAreATick) {
  Driver driver;
  driver.show("render");
  driver.click("render/Fast tests");
  EXPECT_TRUE(driver.edited.settings.render.fast);
}

TEST(TimelinePanel, BackToZeroTime) {
  Driver driver;
  driver.edited.settings.time = 4.0f;
  driver.show("timeline");
  driver.click("timeline/Back to 0");
  EXPECT_EQ(driver.edited.settings.time, 0.0f);
}

TEST(TimelinePanel, PlayBecomesPause) {
  Driver driver("teapots:detail=2");
  driver.show("timeline");
  driver.click("timeline/Play");
  EXPECT_TRUE(driver.state.playing);
  EXPECT_TRUE(driver.state.animating);
  driver.click("timeline/Pause");
  EXPECT_FALSE(driver.state.playing);
}

TEST(RenderPanel, HalfOfThePanel) {
  Driver driver;
  driver.show("render");
  driver.choose("render/Picture", "half");
  driver.frame(30);
  const ui::Item picture = driver.find("viewport/picture");
  EXPECT_EQ(driver.edited.settings.render.width, static_cast<int>(picture.hi.x - picture.lo.x) / 2);
}

TEST(CameraPanel, TheUpAxisIsChosen) {
  Driver driver;
  driver.show("camera");
  driver.click("camera/Up axis/Z");
  EXPECT_EQ(driver.edited.settings.look->camera.up, tracer::vec3(0, 0, 1));
}

TEST(CameraPanel, FromTheRightLooksAlongMinusX) {
  Driver driver;
  driver.show("camera");
  driver.click("camera/from/Right");
  const tracer::Camera& camera = driver.edited.settings.look->camera;
  const tracer::vec3 view = glm::normalize(camera.target - camera.eye);
  EXPECT_NEAR(view.x, -1.0f, 1e-4f);
}

TEST(CameraPanel, ResetIsTheScenesOwnCamera) {
  Driver driver;
  driver.edited.settings.look->camera.eye.x += 3.0f;
  driver.show("camera");
  driver.click("camera/Reset");
  EXPECT_EQ(driver.edited.settings.look->camera, driver.snapshot->scene->camera);
}

TEST(CameraPanel, BookmarksComeBackAndGo) {
  Driver driver;
  driver.show("camera");
  driver.click("camera/Name");
  driver.type("front door");
  driver.click("camera/Remember this view");
  ASSERT_EQ(driver.state.bookmarks.size(), 1u);
  EXPECT_EQ(driver.state.bookmarks[0].name, "front door");
  const tracer::Camera before = driver.edited.settings.look->camera;
  driver.click("camera/from/Top");
  driver.click("camera/bookmark 1/Go");
  EXPECT_EQ(driver.edited.settings.look->camera, before);
  driver.click("camera/bookmark 1/Remove");
  EXPECT_TRUE(driver.state.bookmarks.empty());
}

TEST(BuildPanel, DefaultOptionsComeBack) {
  Driver driver;
  driver.edited.settings.build.bins = 7;
  driver.edited.settings.build.max_leaf_size = 9;
  driver.show("build");
  driver.click("build/Default options");
  EXPECT_EQ(driver.edited.settings.build, tracer::BuildOptions());
}

TEST(BuildPanel, EachBuilderShowsTheOptionsThatItReads) {
  Driver driver;
  driver.show("build");
  EXPECT_FALSE(driver.is_there("build/Search radius"));
  EXPECT_FALSE(driver.is_there("build/Collapse leaves"));
  driver.choose("build/Builder", "ploc");
  driver.frame(2);
  EXPECT_FALSE(driver.is_there("build/Bins"));
  driver.drag("build/Search radius", 400.0f);
  EXPECT_EQ(driver.edited.settings.build.search_radius, tracer::max_search_radius);
  driver.click("build/Collapse leaves");
  EXPECT_FALSE(driver.edited.settings.build.collapse);
}

TEST(BuildPanel, SplittingShowsItsOptions) {
  Driver driver;
  driver.show("build");
  EXPECT_FALSE(driver.is_there("build/Split budget"));
  driver.click("build/Pre-split");
  driver.frame(2);
  EXPECT_TRUE(driver.edited.settings.build.presplit);
  driver.drag("build/Split budget", 400.0f);
  EXPECT_EQ(driver.edited.settings.build.split_budget, tracer::max_split_budget);
  EXPECT_FALSE(driver.is_there("build/Least overlap"));
  driver.choose("build/Builder", "sbvh");
  driver.frame(2);
  driver.drag("build/Least overlap", 400.0f);
  EXPECT_EQ(driver.edited.settings.build.min_overlap, 1.0f);
}

TEST(BuildPanel, RebraidingIsSwitchedOnAndOff) {
  Driver driver;
  driver.show("build");
  for (const bool on : {true, false}) {
    driver.click("build/Re-braid");
    EXPECT_EQ(driver.edited.settings.build.rebraid, on);
  }
}

TEST(BuildPanel, ReinsertionShowsItsOptions) {
  Driver driver;
  driver.show("build");
  EXPECT_FALSE(driver.is_there("build/Share"));
  driver.choose("build/Optimizer", "reinsertion");
  driver.frame(2);
  driver.drag("build/Share", 400.0f);
  EXPECT_EQ(driver.edited.settings.build.reinsertion_share, 1.0f);
  driver.drag("build/Rounds", 400.0f);
  EXPECT_EQ(driver.edited.settings.build.reinsertion_rounds, tracer::max_reinsertion_rounds);
  EXPECT_NO_THROW(tracer::check(driver.edited.settings.build));
}

TEST(BuildPanel, TheSlidersReachTheirEnds) {
  Driver driver;
  driver.show("build");
  driver.drag("build/Bins", 400.0f);
  EXPECT_EQ(driver.edited.settings.build.bins, 256u);
  driver.drag("build/Leaf size", -400.0f);
  EXPECT_EQ(driver.edited.settings.build.max_leaf_size, 1u);
  EXPECT_NO_THROW(tracer::check(driver.edited.settings.build));
}

TEST(ViewPanel, DraggingAnEndOfTheRangeHoldsIt) {
  Driver driver;
  driver.edited.view.view = "counter";
  driver.trace();
  driver.frame(3);
  const tracer::ValueRange fitted = driver.picture.range;
  driver.drag("view/upper end", -80.0f);
  ASSERT_TRUE(driver.edited.view.range.has_value());
  EXPECT_LT(driver.edited.view.range->hi, fitted.hi);
  EXPECT_EQ(driver.edited.view.range->lo, fitted.lo);
  driver.trace();
  driver.click("view/Continuously");
  EXPECT_FALSE(driver.edited.view.range.has_value());
}

TEST(ViewPanel, TheEndsOfTheRangeDoNotCross) {
  Driver driver;
  driver.edited.view.view = "counter";
  driver.trace();
  driver.frame(3);
  driver.drag("view/lower end", 1000.0f);
  ASSERT_TRUE(driver.edited.view.range.has_value());
  EXPECT_LE(driver.edited.view.range->lo, driver.edited.view.range->hi);
}

TEST(ViewPanel, ExposureGoesBack) {
  Driver driver;
  driver.show("view");
  driver.drag("view/Exposure", 50.0f);
  ASSERT_NE(driver.edited.view.exposure, 0.0f);
  driver.click("view/Reset exposure");
  EXPECT_EQ(driver.edited.view.exposure, 0.0f);
}

TEST(MessagesPanel, CopyTakesWhatIsListed) {
  Driver driver;
  ui::post(driver.state, ui::Severity::info, "fine");
  ui::post(driver.state, ui::Severity::error, "broken");
  driver.show("messages");
  driver.choose("messages/Show", "errors");
  driver.click("messages/Copy");
  EXPECT_STREQ(ImGui::GetClipboardText(), "error: broken\n");
}

TEST(StatusBar, CancelIsRequestedWhileSomethingRuns) {
  Driver driver;
  EXPECT_FALSE(driver.is_there("status/Cancel"));
  auto running = std::make_shared<tracer::Snapshot>(*driver.snapshot);
  running->stage = tracer::Stage::refine;
  running->progress = 0.4f;
  driver.snapshot = running;
  driver.frame(2);
  driver.click("status/Cancel");
  EXPECT_TRUE(driver.requests.cancel);
}
}  // namespace
