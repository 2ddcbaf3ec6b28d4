// Every control of every panel is clicked or dragged, and changes what it says.
#include "ui/panels.h"

#include <algorithm>
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
  const char* layout = "binary";  // of the trees
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
        {"Kernels/Primary rays", Act::choose, "packet"},
        {"Kernels/Shadow rays", Act::choose, "single"},
        {"Kernels/Reflection rays", Act::choose, "packet"},
        {"Kernels/Refraction rays", Act::choose, "single"},
        {"Fast tests", Act::click},
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
        {"Optimizer", Act::choose, "rotations"},
        {"Bins", Act::drag},
        {"Leaf size", Act::drag},
        {"Depth limit", Act::drag},
        {"Ct", Act::drag},
        {"Ci", Act::drag},
        {"Layout", Act::choose, "quantised8"},
        {"Pre-split", Act::click},
        {"Re-braid", Act::click},
        {"Default options", Act::shown},
        {"BLAS/SAH", Act::shown},
        {"BLAS/Per triangle", Act::shown},
        {"TLAS/Per instance", Act::shown}}},
      {"build",
       "shaded",
       {{"Widening", Act::choose, "greedy"}, {"Shadow order", Act::choose, "area"}},
       "wide8"},
      {"statistics",
       "counter",
       {{"rays", Act::shown},
        {"values", Act::shown},
        {"leaf size", Act::shown},
        {"leaf depth", Act::shown}}},
      {"builders", "shaded", {{"Measure", Act::click}, {"Choose...", Act::shown}}},
      {"findings", "shaded", {{"Check the trees", Act::click}}},
      {"timeline",
       "shaded",
       {{"Play", Act::click},
        {"Back to 0", Act::shown},
        {"<", Act::shown},
        {">", Act::click},
        {"Scrub", Act::drag},
        {"Deformer", Act::choose, "twist"},
        {"Strategy", Act::choose, "growth"},
        {"N", Act::drag},
        {"F", Act::drag},
        {"Frames", Act::drag},
        {"Picture width", Act::drag},
        {"Motion", Act::choose, "spin"},
        {"Speed", Act::drag},
        {"Loop", Act::click},
        {"From", Act::drag},
        {"To", Act::drag},
        {"Frame rate", Act::drag}}},
      {"tree",
       "shaded",
       {{"Tree", Act::choose, "mesh 0"},
        {"Find", Act::type, "n 1\n"},
        {"Kind", Act::choose, "triangle"},
        {"Columns...", Act::shown},
        {"Open all", Act::shown},
        {"Close all", Act::shown},
        {"column/sah", Act::click},
        {"column/visits", Act::click},
        {"node 0/row", Act::click},
        {"node 0/arrow", Act::click},
        {"Rows", Act::shown}}},
      {"node", "shaded", {}},
      {"boxes",
       "shaded",
       {{"Show boxes", Act::click},
        {"What", Act::choose, "leaves"},
        {"Trees", Act::choose, "tlas"},
        {"Levels", Act::click},
        {"Up", Act::shown},
        {"Down", Act::click},
        {"All", Act::click},
        {"Colour", Act::choose, "sah"},
        {"Logarithmic", Act::click},
        {"Lines", Act::click},
        {"Translucent", Act::click},
        {"Fade hidden", Act::click},
        {"Line width", Act::drag},
        {"Sibling overlap", Act::click}}},
      {"icicle",
       "shaded",
       {{"Drawing", Act::choose, "treemap"},
        {"Tree", Act::shown},
        {"Width", Act::choose, "sah"},
        {"Colour", Act::choose, "depth"},
        {"Logarithmic", Act::click},
        {"Show all", Act::shown}}},
      {"hot", "shaded", {{"Rays", Act::choose, "shadow"}, {"With a cause", Act::click}}},
      {"replay", "shaded", {{"Tree", Act::choose, "tlas"}}},
      {"messages",
       "shaded",
       {{"Show", Act::choose, "errors"}, {"Copy", Act::click}, {"Clear", Act::click}}},
  };
}

// A fresh workspace for every control: one must not hide the next.
void prepare(Driver& driver, const Panel& panel) {
  driver.edited.view.view = panel.view;
  driver.edited.settings.build.layout = panel.layout;
  driver.trace();
  driver.state.edited_material = 0;
  driver.work.inspection.result = std::make_shared<const tracer::Inspection>(
      tracer::inspect(driver.snapshot->bvh, nullptr, {}));
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

INSTANTIATE_TEST_SUITE_P(All, Panels, testing::Range<size_t>(0, all_panels().size()));

// A control that is not in the table above would go untested.
TEST(PanelTable, ListsEveryControlOfTheDefaultWorkspace) {
  std::set<std::string> known;
  for (const Panel& panel : all_panels()) {
    for (const Control& control : panel.controls) {
      known.insert(std::string(panel.id) + "/" + control.label);
    }
  }
  const std::set<std::string> only_read = {
      "Meshes",       "Instances", "Triangles",    "Instanced",  "Materials",    "Textures",
      "Build time",   "SAH",       "Nodes",        "Leaves",     "References",   "Depth",
      "Largest leaf", "Memory",    "Duplication",  "EPO",        "SAH by lines", "Overlap",
      "Empty space",  "In vain",   "Shared boxes", "Neighbours", "status"};
  for (const Panel& panel : all_panels()) {
    Driver driver;
    prepare(driver, panel);
    for (const auto& [label, item] : driver.items.items) {
      if (!label.starts_with(std::string(panel.id) + "/") || label.ends_with("/tab")) continue;
      if (item.frame + 1 < ImGui::GetFrameCount()) continue;
      const std::string last = label.substr(label.rfind('/') + 1);
      const bool row = label.find("/instances/") != std::string::npos ||
                       label.find("/material ") != std::string::npos ||
                       label.find("/level ") != std::string::npos ||
                       label.find("/light ") != std::string::npos ||
                       label.find("tree/node ") != std::string::npos ||
                       label.find("tree/column/") != std::string::npos ||
                       label.find("/column ") != std::string::npos;
      if (only_read.contains(last) || row) continue;
      EXPECT_TRUE(known.contains(label)) << label << " is in no test";
    }
  }
}

TEST(Panels, WithoutASceneEachPanelComesToTheFrontAndNothingIsEdited) {
  Driver driver("");
  const ui::Edited before = driver.edited;
  for (const ui::PanelRow& row : ui::panels()) {
    driver.show(row.id);
    driver.frame(2);
    const auto& front = driver.state.layout.front;
    EXPECT_NE(std::find(front.begin(), front.end(), row.id), front.end()) << row.id;
    EXPECT_TRUE(driver.is_there(std::string(row.id) + "/tab")) << row.id;
  }
  EXPECT_TRUE(driver.edited == before);
}

}  // namespace
