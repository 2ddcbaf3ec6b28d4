// The Ray panel: which rays it asks for, how steps are gone through, and what follows them.
#include <gtest/gtest.h>

#include "driver.h"
#include "ui/pick.h"
#include "ui/ray_strip.h"
#include "ui/ray_view.h"

namespace {

using tracer::LoggedRay;
using tracer::RayLog;
using tracer::Step;
using tracer::StepKind;
using ui::Driver;
using ui::NodePlace;

// The Ray panel with the rays of a pixel in the middle of the showcase.
struct Followed : Driver {
  explicit Followed(std::string_view scene = "showcase") : Driver(scene, {1500, 1000}) {
    state.layout.bottom = 420.0f;
    show("ray");
    state.selection.pixel = pixel();
    frame(2);
    bring();
  }

  // Whose ray hits something, and casts others.
  tracer::ivec2 pixel() const {
    tracer::ivec2 best{0};
    uint32_t most = 0;
    for (int y = 0; y < snapshot->film.height; y += 4) {
      for (int x = 0; x < snapshot->film.width; x += 4) {
        const auto& counters = *tracer::pixel(snapshot->film, x, y).counters;
        const uint32_t rays = tracer::of_class(counters, tracer::ray_class_count).rays;
        if (rays > most) {
          most = rays;
          best = {x, y};
        }
      }
    }
    return best;
  }

  // What the frame loop does with the request.
  void bring() {
    requests.log_rays.reset();
    frame();
    if (!requests.log_rays) return;
    const ui::RayRequest of = *requests.log_rays;
    const tracer::World world{*snapshot->scene, *snapshot->bvh, *snapshot->settings.look,
                              snapshot->settings.render};
    const RayLog log =
        of.again ? tracer::log_again(*of.again, snapshot->bvh)
                 : tracer::log_pixel(world, snapshot->bvh, ui::film_frame(*snapshot), of.pixel);
    work.rays.result = std::make_shared<const ui::LoggedRays>(
        ui::LoggedRays{of, std::make_shared<const RayLog>(log)});
    frame(3);
  }

  const RayLog& log() const { return *work.rays.result->log; }
  const LoggedRay& ray() const { return log().rays[state.ray.ray]; }
  const Step& step() const { return ray().steps[state.ray.step]; }
  uint32_t last() const { return static_cast<uint32_t>(ray().steps.size()) - 1; }

  // Builds with another builder, as the pipeline does.
  void rebuild() {
    edited.settings.build.builder = "median";
    trace();
    frame(2);
  }
  // A place on a strip.
  ImVec2 on_strip(const std::string& label, float part) {
    const ui::Item item = find(label);
    return {item.lo.x + part * (item.hi.x - item.lo.x), 0.5f * (item.lo.y + item.hi.y)};
  }
};

TEST(RayPanel, WithoutAPixelItAsksForNothing) {
  Driver driver;
  driver.show("ray");
  driver.frame(3);
  EXPECT_FALSE(driver.requests.log_rays);
  EXPECT_FALSE(driver.is_there("ray/Play"));
}

TEST(RayPanel, AClickInThePictureAsksForItsRays) {
  Driver driver;
  driver.show("ray");
  driver.click("viewport/picture");
  ASSERT_TRUE(driver.requests.log_rays);
  EXPECT_EQ(driver.requests.log_rays->pixel, *driver.state.ray.pixel);
  EXPECT_FALSE(driver.requests.log_rays->again);
}

TEST(RayPanel, AClickIntoTheSkyFollowsARayThatMisses) {
  Driver driver("teapots:detail=2");
  driver.show("ray");
  const ui::ViewportState& viewport = driver.state.viewport;
  driver.click_at({viewport.lo.x + 3.0f, viewport.lo.y + 3.0f});
  ASSERT_FALSE(ui::pick(*driver.snapshot, {0, 0}));
  ASSERT_TRUE(driver.requests.log_rays);
  EXPECT_EQ(driver.requests.log_rays->pixel, *driver.state.selection.pixel);
}

TEST(RayPanel, AsksForNothingWhileItIsNotOnShow) {
  Followed driver;
  driver.show("messages");
  driver.requests.log_rays.reset();
  driver.frame(3);
  EXPECT_FALSE(driver.requests.log_rays);
  EXPECT_FALSE(ui::is_ray_shown(driver.state));
  EXPECT_FALSE(driver.is_there("viewport/ray legend"));
  const uint32_t step = driver.state.ray.step;
  driver.press(ui::key_right);
  EXPECT_EQ(driver.state.ray.step, step);
}

TEST(RayPanel, ShowsAllRaysAndALegend) {
  Followed driver;
  ASSERT_GT(driver.log().rays.size(), 2u);
  EXPECT_TRUE(driver.is_there("ray/ray 1/row"));
  EXPECT_TRUE(driver.is_there("ray/ray 2/row"));
  EXPECT_TRUE(driver.is_there("ray/sum"));
  EXPECT_TRUE(driver.is_there("ray/words"));
  EXPECT_TRUE(driver.is_there("ray/legend/Behind"));
  EXPECT_TRUE(driver.is_there("viewport/ray legend"));
  driver.click("ray/Rays");
  driver.click("ray/Rays/none");
  driver.frame(2);
  EXPECT_FALSE(driver.is_there("viewport/ray legend"));
}

TEST(RayPanel, StepsForwardAndBackAndSelectsTheNode) {
  Followed driver;
  EXPECT_FALSE(driver.state.selection.node);
  driver.click("ray/>");
  driver.click("ray/>");
  EXPECT_EQ(driver.state.ray.step, 2u);
  EXPECT_EQ(driver.state.selection.node, ui::node_of(driver.log(), driver.ray(), 2));
  ASSERT_TRUE(driver.state.selection.pixel) << "the pixel stays selected";
  driver.click("ray/<");
  EXPECT_EQ(driver.state.ray.step, 1u);
  driver.click("ray/>|");
  EXPECT_EQ(driver.state.ray.step, driver.last());
  driver.click("ray/|<");
  EXPECT_EQ(driver.state.ray.step, 0u);
}

TEST(RayPanel, KeysStep) {
  Followed driver;
  driver.press(ui::key_right);
  driver.press('.');
  driver.press(ui::key_right);
  EXPECT_EQ(driver.state.ray.step, 3u);
  driver.press(ui::key_left);
  driver.press(',');
  EXPECT_EQ(driver.state.ray.step, 1u);
  driver.press(ui::key_end);
  EXPECT_EQ(driver.state.ray.step, driver.last());
  driver.press(ui::key_right);
  EXPECT_EQ(driver.state.ray.step, driver.last());
  driver.press(ui::key_home);
  driver.press(ui::key_left);
  EXPECT_EQ(driver.state.ray.step, 0u);
}

TEST(RayPanel, AHeldKeyGoesOnStepping) {
  Followed driver;
  driver.hold(ui::key_right, true);
  driver.frame(2);
  EXPECT_EQ(driver.state.ray.step, 1u);
  driver.frame(60);
  EXPECT_GT(driver.state.ray.step, 10u);
  EXPECT_TRUE(driver.state.animating);
  driver.hold(ui::key_right, false);
  driver.frame(2);
  const uint32_t there = driver.state.ray.step;
  driver.frame(60);
  EXPECT_EQ(driver.state.ray.step, there);
}

TEST(RayPanel, EveryStepSelectsItsOwnThing) {
  Followed driver;
  std::set<StepKind> kinds;
  for (uint32_t i = 0; i < driver.last(); ++i) {
    driver.press(ui::key_right);
    const Step& step = driver.step();
    const ui::Selection& selection = driver.state.selection;
    kinds.insert(step.kind);
    const uint32_t mesh = step.instance == tracer::none
                              ? tracer::none
                              : driver.snapshot->bvh->instances[step.instance].mesh;
    switch (step.kind) {
      case StepKind::instance:
        EXPECT_EQ(selection.instance, step.id);
        break;
      case StepKind::triangle:
        EXPECT_EQ(selection.triangle, step.id);
        EXPECT_EQ(selection.instance, step.instance);
        ASSERT_TRUE(selection.node);
        EXPECT_TRUE(
            tracer::is_leaf(driver.snapshot->bvh->blases[mesh]->tree.nodes[selection.node->node]));
        break;
      default:
        EXPECT_EQ(selection.node, (NodePlace{mesh, step.id}));
        EXPECT_EQ(selection.instance, step.instance);
    }
  }
  EXPECT_EQ(kinds.size(), 4u);
}

TEST(RayPanel, TheStripTellsAndGoesThere) {
  Followed driver;
  driver.move_to(driver.on_strip("ray/strip", 0.8f));
  driver.frame(2);
  EXPECT_NE(driver.state.ray.hovered_step, tracer::none);
  EXPECT_EQ(driver.state.ray.step, 0u) << "hovering goes nowhere";
  EXPECT_EQ(driver.state.hovered.node,
            ui::node_of(driver.log(), driver.ray(), driver.state.ray.hovered_step));
  driver.click_at(driver.on_strip("ray/strip", 0.8f));
  const uint32_t there = driver.state.ray.step;
  EXPECT_GT(there, driver.last() / 2);
  driver.drag(driver.on_strip("ray/strip", 0.8f), driver.on_strip("ray/strip", 0.3f));
  EXPECT_LT(driver.state.ray.step, there);
  driver.move_to({5, 5});
  driver.frame(2);
  EXPECT_EQ(driver.state.ray.hovered_step, tracer::none);
}

TEST(RayPanel, ScrubbingGoesThroughTheSteps) {
  Followed driver;
  driver.click("ray/Scrub");
  EXPECT_GT(driver.state.ray.step, 0u);
  EXPECT_TRUE(driver.state.selection.node || driver.state.selection.instance != tracer::none);
}

TEST(RayPanel, PlaysToTheEnd) {
  Followed driver;
  driver.state.ray.speed = 30.0f;
  driver.click("ray/Play");
  EXPECT_TRUE(driver.state.animating);
  driver.frame(10);
  EXPECT_GT(driver.state.ray.step, 2u);
  EXPECT_TRUE(driver.is_there("ray/Pause"));
  for (int i = 0; i < 200 && driver.state.ray.playing; ++i)
    driver.frame(60);
  EXPECT_EQ(driver.state.ray.step, driver.last());
  EXPECT_FALSE(driver.state.ray.playing);
}

TEST(RayPanel, AClickOnARowFollowsThatRayOrStep) {
  Followed driver;
  driver.click("ray/step 3/row");
  EXPECT_EQ(driver.state.ray.step, 2u);
  const LoggedRay& first = driver.ray();
  driver.click("ray/ray 2/row");
  EXPECT_EQ(driver.state.ray.ray, 1u);
  EXPECT_EQ(driver.state.ray.step, 0u);
  EXPECT_NE(&driver.ray(), &first);
}

TEST(RayPanel, AnotherPixelBeginsAgainAndTheOldRaysStayUntilItsAreThere) {
  Followed driver;
  driver.press(ui::key_end);
  driver.click("ray/ray 2/row");
  tracer::ivec2 other = *driver.state.ray.pixel;
  other.x += 8;
  driver.state.selection.pixel = other;
  driver.frame(2);
  EXPECT_EQ(driver.state.ray.ray, 0u);
  EXPECT_EQ(driver.state.ray.step, 0u);
  EXPECT_TRUE(driver.is_there("ray/strip"));
  ASSERT_TRUE(driver.requests.log_rays);
  EXPECT_EQ(driver.requests.log_rays->pixel, other);
}

TEST(RayPanel, TheRaysStayWhenSomethingElseIsSelected) {
  Followed driver;
  const auto pixel = driver.state.ray.pixel;
  driver.state.selection = {};
  driver.state.selection.instance = 0;
  driver.frame(2);
  EXPECT_EQ(driver.state.ray.pixel, pixel);
  EXPECT_TRUE(driver.is_there("ray/strip"));
}

TEST(RayPanel, ALockedRayStaysWhenTheCameraMoves) {
  Followed driver;
  driver.click("ray/Lock");
  const auto locked = driver.state.ray.locked;
  ASSERT_TRUE(locked);
  driver.edited.settings.look->camera.eye.x += 1.0f;
  driver.trace();
  driver.requests.log_rays.reset();
  driver.frame(2);
  EXPECT_FALSE(driver.requests.log_rays);
  driver.state.selection.pixel = tracer::ivec2(1, 1);
  driver.frame(2);
  EXPECT_FALSE(driver.requests.log_rays);
  EXPECT_EQ(driver.state.ray.locked, locked);
  EXPECT_TRUE(driver.is_there("ray/locked"));
  driver.click("ray/Lock");
  driver.frame(2);
  EXPECT_FALSE(driver.state.ray.locked);
  ASSERT_TRUE(driver.requests.log_rays);
  EXPECT_EQ(driver.requests.log_rays->pixel, tracer::ivec2(1, 1));
}

TEST(RayPanel, ALockedRayIsFollowedThroughAnotherTreeToo) {
  Followed driver;
  driver.click("ray/Lock");
  const auto locked = driver.state.ray.locked;
  driver.rebuild();
  EXPECT_EQ(driver.requests.log_rays->again, locked);
  EXPECT_FALSE(driver.is_there("ray/strip before")) << "not yet";
  driver.bring();
  EXPECT_TRUE(driver.is_there("ray/strip before"));
  EXPECT_TRUE(driver.is_there("ray/strip"));
  EXPECT_TRUE(driver.is_there("ray/difference"));
  const NodePlace node{0, 0};
  driver.state.selection.node = node;
  driver.click_at(driver.on_strip("ray/strip before", 0.7f));
  EXPECT_TRUE(driver.state.ray.before);
  EXPECT_GT(driver.state.ray.step, 0u);
  EXPECT_EQ(driver.state.selection.node, node) << "its nodes are of a tree that is gone";
  driver.click_at(driver.on_strip("ray/strip", 0.7f));
  EXPECT_FALSE(driver.state.ray.before);
  EXPECT_EQ(driver.state.selection.node,
            ui::node_of(driver.log(), driver.ray(), driver.state.ray.step));
}

TEST(RayPanel, AnotherSceneForgetsTheRays) {
  Followed driver;
  driver.click("ray/Lock");
  driver.edited.settings.source = tracer::parse_scene_source("needles:triangles=50");
  driver.edited.settings.look.reset();
  driver.trace();
  driver.frame(3);
  EXPECT_FALSE(driver.state.ray.locked);
  EXPECT_FALSE(driver.state.ray.pixel);
  EXPECT_FALSE(driver.is_there("ray/strip"));
}

TEST(RayPanel, APixelOutsideTheSmallerPictureIsNotAskedFor) {
  Followed driver;
  driver.state.selection.pixel = tracer::ivec2(150, 110);
  driver.frame(2);
  driver.edited.settings.render.width = 100;
  driver.trace();
  driver.requests.log_rays.reset();
  driver.frame(2);
  EXPECT_FALSE(driver.requests.log_rays);
  EXPECT_FALSE(driver.is_there("ray/strip"));
}

TEST(RayPanel, OfAVeryLongRayOnlyTheRowsInSightAreDrawn) {
  Followed driver;
  auto log = std::make_shared<RayLog>(driver.log());
  std::vector<Step>& steps = log->rays[0].steps;
  while (steps.size() < 200000)
    steps.insert(steps.end(), steps.begin(), steps.begin() + steps.size());
  driver.work.rays.result =
      std::make_shared<const ui::LoggedRays>(ui::LoggedRays{driver.work.rays.result->of, log});
  driver.items.items.clear();
  driver.press(ui::key_end);
  driver.frame(3);
  const size_t last = steps.size();
  EXPECT_TRUE(driver.is_there("ray/step " + std::to_string(last) + "/row"));
  size_t rows = 0;
  for (const auto& [label, item] : driver.items.items)
    rows += label.starts_with("ray/step ") && item.frame + 1 >= ImGui::GetFrameCount();
  EXPECT_LT(rows, 60u);
}

TEST(RayPanel, InANarrowRegionEverythingIsThere) {
  Followed driver;
  ui::move_panel(driver.state.layout, "ray", ui::Region::left);
  driver.frame(5);
  for (const char* label : {"Play", "Scrub", "Lock", "strip", "words", "ray 1/row", "step 1/row"})
    driver.find(std::string("ray/") + label);
}

TEST(RayStrip, DepthsGoOnFromTheTlasToTheTriangles) {
  const Followed driver;
  const std::vector<uint32_t> rows = ui::strip_depths(driver.ray());
  ASSERT_EQ(rows.size(), driver.ray().steps.size());
  EXPECT_EQ(rows[0], 0u);
  for (size_t i = 1; i < rows.size(); ++i) {
    const Step& before = driver.ray().steps[i - 1];
    const Step& step = driver.ray().steps[i];
    if (before.kind == StepKind::instance) {
      EXPECT_EQ(rows[i], rows[i - 1] + 1);
    }
    if (step.kind == StepKind::triangle && before.kind == StepKind::leaf) {
      EXPECT_EQ(rows[i], rows[i - 1] + 1);
    }
  }
}

}  // namespace
