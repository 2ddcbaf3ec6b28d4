// Every control of every panel is clicked or dragged, and changes what it says.
#include "ui/panels.h"

#include <set>

#include <gtest/gtest.h>

#include "driver.h"
#include "ui/actions.h"

namespace {

using ui::Driver;

enum class Act { click, drag, choose, type, shown };

struct Control {
  const char* label;  // within its panel
  Act act;
  const char* id = "";  // what is chosen or typed
};

struct Panel {
  const char* id;
  const char* view;  // that is shown meanwhile
  std::vector<Control> controls;
};

std::vector<Panel> all_panels() {
  return {
      {"scene",
       "shaded",
       {{"Scene", Act::choose, "needles"},
        {"Open scene...", Act::click},
        {"parameters/Teapot detail", Act::drag},
        {"parameters/Floor squares", Act::drag},
        {"parameters/Default parameters", Act::shown},
        {"Filter", Act::type, "x"},
        {"instances/1", Act::click}}},
      {"materials",
       "shaded",
       {{"Filter", Act::type, "x"},
        {"material 1/Select", Act::click},
        {"edit/Matte", Act::click},
        {"edit/Mirror", Act::click},
        {"edit/Glass", Act::click},
        {"edit/Albedo/numbers", Act::drag},
        {"edit/Albedo/swatch", Act::shown},
        {"edit/Mirror share", Act::drag},
        {"edit/Glass share", Act::drag},
        {"edit/Index", Act::drag},
        {"edit/Specular/numbers", Act::drag},
        {"edit/Specular/swatch", Act::shown},
        {"edit/Emission/numbers", Act::drag},
        {"edit/Emission/swatch", Act::shown},
        {"edit/As loaded", Act::shown}}},
      {"lights",
       "shaded",
       {{"light 1/On", Act::click},
        {"light 1/Select", Act::click},
        {"light 1/Position", Act::drag},
        {"light 1/Colour/numbers", Act::drag},
        {"light 1/Colour/swatch", Act::shown},
        {"light 1/Intensity", Act::drag},
        {"light 1/Remove", Act::click},
        {"Add a light", Act::click},
        {"Ambient/numbers", Act::drag},
        {"Ambient/swatch", Act::shown},
        {"Sky on", Act::click},
        {"Rotation", Act::drag},
        {"Strength", Act::drag},
        {"Image", Act::shown},
        {"Open sky...", Act::click}}},
      {"view",
       "shaded",
       {{"View", Act::choose, "normal"},
        {"Exposure", Act::drag},
        {"Tone map", Act::choose, "reinhard"},
        {"Reset exposure", Act::shown}}},
      {"view",
       "counter",
       {{"View", Act::choose, "depth"},
        {"Counter", Act::choose, "triangles"},
        {"Rays", Act::choose, "shadow"},
        {"Colour map", Act::choose, "turbo"},
        {"Legend", Act::click},
        {"Range", Act::drag},
        {"lower end", Act::drag},
        {"upper end", Act::shown},
        {"From", Act::drag},
        {"To", Act::drag},
        {"Fit", Act::click},
        {"Continuously", Act::click},
        {"Logarithmic", Act::click},
        {"Shown", Act::shown},
        {"Unit", Act::shown},
        {"Smallest", Act::shown},
        {"Mean", Act::shown},
        {"Largest", Act::shown},
        {"Pixels", Act::shown}}},
      {"render",
       "shaded",
       {{"Picture", Act::choose, "half"},
        {"Width", Act::drag},
        {"Height", Act::drag},
        {"Ray depth", Act::drag},
        {"Samples", Act::drag},
        {"Shadows", Act::click},
        {"Play", Act::click},
        {"Back to 0", Act::shown},
        {"Time", Act::drag},
        {"Speed", Act::drag},
        {"Passes", Act::shown},
        {"A pass", Act::shown},
        {"First picture", Act::shown}}},
      {"camera",
       "shaded",
       {{"Eye", Act::drag},
        {"Target", Act::drag},
        {"Field of view", Act::drag},
        {"Orthographic", Act::click},
        {"Up axis/X", Act::click},
        {"Up axis/Y", Act::shown},
        {"Up axis/Z", Act::click},
        {"Focus", Act::click},
        {"Reset", Act::shown},
        {"from/Front", Act::click},
        {"from/Back", Act::click},
        {"from/Left", Act::click},
        {"from/Right", Act::click},
        {"from/Top", Act::click},
        {"from/Bottom", Act::click},
        {"Fly speed", Act::drag},
        {"Name", Act::type, "x"},
        {"Remember this view", Act::click}}},
      {"build",
       "shaded",
       {{"Builder", Act::shown},
        {"Bins", Act::drag},
        {"Leaf size", Act::drag},
        {"Depth limit", Act::drag},
        {"Ct", Act::drag},
        {"Ci", Act::drag},
        {"Layout", Act::shown},
        {"Default options", Act::shown},
        {"BLAS/SAH", Act::shown},
        {"BLAS/Per triangle", Act::shown},
        {"TLAS/Per instance", Act::shown}}},
      {"statistics",
       "counter",
       {{"rays", Act::shown},
        {"values", Act::shown},
        {"leaf size", Act::shown},
        {"leaf depth", Act::shown}}},
      {"messages",
       "shaded",
       {{"Show", Act::choose, "errors"}, {"Copy", Act::click}, {"Clear", Act::click}}},
  };
}

// A fresh workspace for every control: one must not hide the next.
void prepare(Driver& driver, const Panel& panel) {
  driver.edited.view.view = panel.view;
  driver.trace();
  driver.state.edited_material = 0;
  driver.show(panel.id);
}

void act(Driver& driver, const std::string& label, const Control& control) {
  switch (control.act) {
    case Act::click:
      driver.click(label);
      break;
    case Act::drag: {
      // The lower end of a slider can only go up, the upper one only down.
      const bool down = std::string(control.label) == "To" || std::string(control.label) == "Range";
      const float width = driver.find(label).hi.x - driver.find(label).lo.x;
      const float reach = std::min(0.3f * width, 60.0f);
      // Of three numbers the middle one is hit.
      driver.drag(label, down ? -std::max(reach, 30.0f) : std::max(reach, 30.0f));
      break;
    }
    case Act::choose:
      driver.choose(label, control.id);
      break;
    case Act::type:
      driver.click(label);
      driver.type(control.id);
      break;
    case Act::shown:
      break;
  }
}

class Panels : public testing::TestWithParam<size_t> {};

TEST_P(Panels, EveryControlWorks) {
  const Panel panel = all_panels()[GetParam()];
  for (const Control& control : panel.controls) {
    SCOPED_TRACE(std::string(panel.id) + "/" + control.label);
    Driver driver;
    prepare(driver, panel);
    const std::string label = std::string(panel.id) + "/" + control.label;
    driver.find(label);
    const ui::Edited before = driver.edited;
    const std::string state = driver.digest();
    act(driver, label, control);
    if (control.act != Act::shown) {
      EXPECT_TRUE(driver.edited != before || driver.digest() != state) << "nothing has changed";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Panels, testing::Range<size_t>(0, 10));

// A control that is not in the table above would go untested.
TEST(PanelTable, ListsEveryControlOfTheDefaultWorkspace) {
  std::set<std::string> known;
  for (const Panel& panel : all_panels()) {
    for (const Control& control : panel.controls) {
      known.insert(std::string(panel.id) + "/" + control.label);
    }
  }
  const std::set<std::string> only_read = {
      "Meshes", "Instances", "Triangles", "Instanced",  "Materials", "Textures",     "Build time",
      "SAH",    "Nodes",     "Leaves",    "References", "Depth",     "Largest leaf", "Memory"};
  for (const Panel& panel : all_panels()) {
    Driver driver;
    prepare(driver, panel);
    for (const auto& [label, item] : driver.items.items) {
      if (!label.starts_with(std::string(panel.id) + "/") || label.ends_with("/tab")) continue;
      if (item.frame + 1 < ImGui::GetFrameCount()) continue;
      const std::string last = label.substr(label.rfind('/') + 1);
      const bool row = label.find("/instances/") != std::string::npos ||
                       label.find("/material ") != std::string::npos ||
                       label.find("/light ") != std::string::npos;
      if (only_read.contains(last) || row) continue;
      EXPECT_TRUE(known.contains(label)) << label << " is in no test";
    }
  }
}

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

TEST(RenderPanel, BackToZeroTime) {
  Driver driver;
  driver.edited.settings.time = 4.0f;
  driver.show("render");
  driver.click("render/Back to 0");
  EXPECT_EQ(driver.edited.settings.time, 0.0f);
}

TEST(RenderPanel, PlayBecomesPause) {
  Driver driver("teapots:detail=2");
  driver.show("render");
  driver.click("render/Play");
  EXPECT_TRUE(driver.state.playing);
  EXPECT_TRUE(driver.state.animating);
  driver.click("render/Pause");
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

TEST(Panels, AnEmptyWorkspaceSaysWhatToDoEverywhere) {
  Driver driver("");
  for (const ui::PanelRow& row : ui::panels()) {
    driver.show(row.id);
    driver.frame(2);
  }
  SUCCEED();
}

}  // namespace
