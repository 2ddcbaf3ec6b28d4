// What the mouse and the held keys do in the picture.
#include "ui/viewport.h"

#include <cmath>

#include <gtest/gtest.h>

#include "driver.h"
#include "ui/camera_control.h"
#include "ui/pick.h"

namespace {

using tracer::Camera;
using tracer::ivec2;
using tracer::vec3;
using ui::Driver;

Camera& camera(Driver& driver) {
  return driver.edited.settings.look->camera;
}

// Two triangles that fill the picture and one light: what is where is known.
class Viewport : public testing::Test {
 protected:
  Viewport() : driver_("teapots:detail=2") { middle_ = driver_.middle("viewport/picture"); }

  // A place on the screen where the picture shows a surface, or the sky.
  ImVec2 place(bool surface) {
    for (int y = 5; y < driver_.snapshot->film.height; y += 3) {
      for (int x = 5; x < driver_.snapshot->film.width; x += 3) {
        if (ui::pick(*driver_.snapshot, {x, y}).has_value() == surface) return screen({x, y});
      }
    }
    ADD_FAILURE() << "no such place";
    return {};
  }
  ImVec2 screen(ivec2 pixel) {
    const ui::ViewportState& viewport = driver_.state.viewport;
    const float scale = (viewport.hi.x - viewport.lo.x) / 160.0f;
    return {viewport.lo.x + (static_cast<float>(pixel.x) + 0.5f) * scale,
            viewport.lo.y + (static_cast<float>(pixel.y) + 0.5f) * scale};
  }
  ivec2 pixel(ImVec2 at) {
    const ui::ViewportState& viewport = driver_.state.viewport;
    const float scale = 160.0f / (viewport.hi.x - viewport.lo.x);
    return {static_cast<int>((at.x - viewport.lo.x) * scale),
            static_cast<int>((at.y - viewport.lo.y) * scale)};
  }

  Driver driver_;
  ImVec2 middle_;
};

TEST_F(Viewport, ThePictureKeepsItsShape) {
  const ui::ViewportState& viewport = driver_.state.viewport;
  const float shape = (viewport.hi.x - viewport.lo.x) / (viewport.hi.y - viewport.lo.y);
  EXPECT_NEAR(shape, 160.0f / 120.0f, 0.01f);
}

TEST_F(Viewport, LeftDragTurnsAboutTheTarget) {
  const Camera before = camera(driver_);
  driver_.drag(middle_, {middle_.x + 100.0f, middle_.y + 40.0f});
  const Camera& after = camera(driver_);
  EXPECT_EQ(after.target, before.target);
  EXPECT_NEAR(glm::length(after.eye - after.target), glm::length(before.eye - before.target),
              1e-3f);
  EXPECT_GT(after.eye.y, before.eye.y);  // down raises the eye
  const vec3 expected = ui::orbit(before, 0.6f, -0.24f).eye;
  EXPECT_NEAR(glm::length(after.eye - expected), 0.0f, 0.01f);
}

TEST_F(Viewport, ADragIsOneStepToUndo) {
  const Camera before = camera(driver_);
  driver_.drag(middle_, {middle_.x + 100.0f, middle_.y});
  driver_.press('Z', true);
  EXPECT_EQ(camera(driver_), before);
}

TEST_F(Viewport, MiddleDragAndShiftDragPan) {
  const Camera before = camera(driver_);
  driver_.drag(middle_, {middle_.x + 50.0f, middle_.y}, 2);
  const vec3 moved = camera(driver_).target - before.target;
  EXPECT_GT(glm::length(moved), 0.01f);
  EXPECT_NEAR(glm::length(camera(driver_).eye - before.eye - moved), 0.0f, 1e-4f);
  camera(driver_) = before;
  driver_.shift = true;
  driver_.drag(middle_, {middle_.x + 50.0f, middle_.y});
  driver_.shift = false;
  EXPECT_NEAR(glm::length(camera(driver_).target - before.target - moved), 0.0f, 1e-3f);
}

TEST_F(Viewport, RightDragLooksAround) {
  const Camera before = camera(driver_);
  driver_.drag(middle_, {middle_.x + 50.0f, middle_.y}, 1);
  EXPECT_EQ(camera(driver_).eye, before.eye);
  EXPECT_NE(camera(driver_).target, before.target);
}

TEST_F(Viewport, TheWheelZoomsAtTheCursor) {
  const ImVec2 at = place(true);
  const vec3 point = ui::pick(*driver_.snapshot, pixel(at))->surface.position;
  const Camera before = camera(driver_);
  driver_.move_to(at);
  driver_.wheel(3.0f);
  EXPECT_LT(glm::length(camera(driver_).eye - point), glm::length(before.eye - point) * 0.7f);
  const auto was = tracer::project(tracer::frame(before, 160, 120), point);
  const auto is = tracer::project(tracer::frame(camera(driver_), 160, 120), point);
  ASSERT_TRUE(was && is);
  EXPECT_NEAR(glm::length(was->pixel - is->pixel), 0.0f, 0.05f);
}

TEST_F(Viewport, TheWheelZoomsInTheSkyToo) {
  const Camera before = camera(driver_);
  driver_.move_to(place(false));
  driver_.wheel(-2.0f);
  EXPECT_GT(glm::length(camera(driver_).eye), glm::length(before.eye));
}

TEST_F(Viewport, TheWheelElsewhereDoesNotZoom) {
  const Camera before = camera(driver_);
  driver_.hover("scene/tab");
  driver_.wheel(2.0f);
  EXPECT_EQ(camera(driver_), before);
}

TEST_F(Viewport, AClickSelectsTriangleInstanceAndMaterial) {
  const ImVec2 at = place(true);
  const ui::Picked picked = *ui::pick(*driver_.snapshot, pixel(at));
  const Camera before = camera(driver_);
  driver_.click_at(at);
  EXPECT_EQ(driver_.state.selection.instance, picked.hit.instance);
  EXPECT_EQ(driver_.state.selection.triangle, picked.hit.triangle);
  EXPECT_EQ(driver_.state.selection.material, picked.surface.material);
  EXPECT_EQ(driver_.state.edited_material, picked.surface.material);
  EXPECT_EQ(camera(driver_), before);
}

TEST_F(Viewport, AClickIntoTheSkySelectsThePixelAlone) {
  driver_.state.selection.instance = 2;
  const ImVec2 at = place(false);
  driver_.click_at(at);
  ui::Selection expected;
  expected.pixel = pixel(at);
  EXPECT_EQ(driver_.state.selection, expected);
}

TEST_F(Viewport, ADoubleClickTurnsToWhatIsThere) {
  const ImVec2 at = place(true);
  const vec3 point = ui::pick(*driver_.snapshot, pixel(at))->surface.position;
  driver_.click_at(at);
  driver_.click_at(at);
  EXPECT_EQ(camera(driver_).target, point);
}

TEST_F(Viewport, TheTextNamesWhatIsUnderTheCursor) {
  const ImVec2 at = place(true);
  driver_.move_to(at);
  driver_.frame(2);
  EXPECT_TRUE(driver_.is_there("viewport/values"));
  const ui::Picked picked = *ui::pick(*driver_.snapshot, pixel(at));
  std::string text;
  for (const std::string& line : ui::describe(*driver_.snapshot, driver_.edited.view, pixel(at))) {
    text += line + "\n";
  }
  EXPECT_NE(text.find("instance " + std::to_string(picked.hit.instance)), std::string::npos)
      << text;
  EXPECT_NE(text.find("triangle " + std::to_string(picked.hit.triangle)), std::string::npos)
      << text;
  EXPECT_NE(text.find("normal"), std::string::npos) << text;
  EXPECT_NE(text.find("uv"), std::string::npos) << text;
  EXPECT_NE(text.find("primary:  nodes"), std::string::npos) << text;
}

TEST_F(Viewport, TheTextShowsTheValueOfTheView) {
  const ImVec2 at = place(true);
  tracer::ViewOptions view;
  view.view = "counter";
  const ivec2 here = pixel(at);
  const float value = tracer::value_at(*driver_.snapshot, view, here.x, here.y);
  const std::string text = ui::describe(*driver_.snapshot, view, here)[0];
  EXPECT_NE(text.find("value " + std::to_string(static_cast<int>(value))), std::string::npos)
      << text;
}

TEST_F(Viewport, TheTextOverTheSkySaysSo) {
  const auto lines = ui::describe(*driver_.snapshot, {}, pixel(place(false)));
  EXPECT_NE(std::find(lines.begin(), lines.end(), "nothing hit"), lines.end());
}

TEST_F(Viewport, OutsideThePictureIsNoPixel) {
  EXPECT_FALSE(ui::pick(*driver_.snapshot, {-1, 0}).has_value());
  EXPECT_FALSE(ui::pick(*driver_.snapshot, {160, 0}).has_value());
}

TEST_F(Viewport, ALightFollowsTheMouse) {
  tracer::Light& light = driver_.edited.settings.look->lights[0];
  light.position = camera(driver_).target;
  driver_.frame(2);
  const ImVec2 from = driver_.middle("viewport/light handle 1");
  const Camera before = camera(driver_);
  driver_.drag(from, {from.x + 60.0f, from.y - 30.0f});
  EXPECT_EQ(camera(driver_), before);
  EXPECT_EQ(driver_.state.selection.light, 0u);
  const ImVec2 to = driver_.middle("viewport/light handle 1");
  EXPECT_NEAR(to.x, from.x + 60.0f, 1.5f);
  EXPECT_NEAR(to.y, from.y - 30.0f, 1.5f);
}

TEST_F(Viewport, ALightMovesUpWithShift) {
  tracer::Light& light = driver_.edited.settings.look->lights[0];
  light.position = camera(driver_).target;
  const vec3 before = light.position;
  driver_.frame(2);
  const ImVec2 from = driver_.middle("viewport/light handle 1");
  driver_.shift = true;
  driver_.drag(from, {from.x + 10.0f, from.y - 40.0f});
  driver_.shift = false;
  EXPECT_EQ(light.position.x, before.x);
  EXPECT_EQ(light.position.z, before.z);
  EXPECT_GT(light.position.y, before.y + 0.1f);
}

TEST_F(Viewport, AnAxisOfTheGizmoIsAView) {
  driver_.click("viewport/axis +X");
  const vec3 view = glm::normalize(camera(driver_).target - camera(driver_).eye);
  EXPECT_NEAR(view.x, -1.0f, 1e-4f);
  driver_.click("viewport/axis -Z");
  EXPECT_NEAR(glm::normalize(camera(driver_).target - camera(driver_).eye).z, 1.0f, 1e-4f);
}

TEST_F(Viewport, TheMenuOfAPlaceAddsALight) {
  const size_t before = driver_.edited.settings.look->lights.size();
  driver_.click_at(place(true), 1);
  driver_.click("viewport/menu/Add a light here");
  EXPECT_EQ(driver_.edited.settings.look->lights.size(), before + 1);
}

TEST_F(Viewport, TheMenuSelectsTurnsAndCopies) {
  const ImVec2 at = place(true);
  const vec3 point = ui::pick(*driver_.snapshot, pixel(at))->surface.position;
  driver_.click_at(at, 1);
  driver_.click("viewport/menu/Select");
  EXPECT_NE(driver_.state.selection.triangle, tracer::none);
  driver_.click_at(at, 1);
  driver_.click("viewport/menu/Turn about this point");
  EXPECT_EQ(camera(driver_).target, point);
  driver_.click_at(at, 1);
  driver_.click("viewport/menu/Copy the values");
  EXPECT_NE(std::string(ImGui::GetClipboardText()).find("instance"), std::string::npos);
  driver_.click_at(at, 1);
  driver_.click("viewport/menu/Edit its material");
  EXPECT_EQ(driver_.state.layout.front[0], "materials");
  driver_.click_at(at, 1);
  driver_.click("viewport/menu/Reset the camera");
  EXPECT_EQ(camera(driver_), driver_.snapshot->scene->camera);
  driver_.click_at(at, 1);
  driver_.click("viewport/menu/Focus");
  EXPECT_NE(camera(driver_), driver_.snapshot->scene->camera);
  driver_.click_at(at, 1);
  driver_.click("viewport/menu/Save picture...");
  EXPECT_TRUE(driver_.state.browser.visible);
}

TEST_F(Viewport, HeldKeysFly) {
  const Camera before = camera(driver_);
  driver_.hold('W', true);
  driver_.frame(10);
  EXPECT_TRUE(driver_.state.animating);
  driver_.hold('W', false);
  driver_.frame(3);
  const vec3 moved = camera(driver_).eye - before.eye;
  EXPECT_GT(glm::dot(moved, glm::normalize(before.target - before.eye)), 0.0f);
  EXPECT_NEAR(glm::length(camera(driver_).target - before.target - moved), 0.0f, 1e-3f);
  const Camera stopped = camera(driver_);
  driver_.frame(5);
  EXPECT_EQ(camera(driver_), stopped);
}

TEST_F(Viewport, ShiftIsFastAndControlIsSlow) {
  const auto flown = [&] {
    const vec3 before = camera(driver_).eye;
    driver_.frame(10);
    return glm::length(camera(driver_).eye - before);
  };
  driver_.hold('E', true);
  driver_.frame(2);
  const float normal = flown();
  driver_.shift = true;
  const float fast = flown();
  driver_.shift = false;
  driver_.control = true;
  const float slow = flown();
  EXPECT_NEAR(fast / normal, 4.0f, 0.5f);
  EXPECT_NEAR(slow / normal, 0.25f, 0.05f);
}

TEST_F(Viewport, SavingTheSessionDoesNotFly) {
  const Camera before = camera(driver_);
  driver_.control = true;
  driver_.hold('S', true);
  driver_.frame(5);
  EXPECT_EQ(camera(driver_), before);
  EXPECT_TRUE(driver_.state.browser.visible);
}

TEST_F(Viewport, TypingDoesNotFly) {
  driver_.show("materials");
  driver_.click("materials/Filter");
  const Camera before = camera(driver_);
  driver_.hold('W', true);
  driver_.frame(5);
  EXPECT_EQ(camera(driver_), before);
}

TEST_F(Viewport, TheSizeFollowsThePanelWhenItHasSettled) {
  driver_.state.picture_size = ui::PictureSize::panel;
  driver_.frame(30);
  const int before = driver_.edited.settings.render.width;
  driver_.state.layout.left += 100.0f;
  driver_.frame(3);
  EXPECT_EQ(driver_.edited.settings.render.width, before);
  EXPECT_TRUE(driver_.state.animating);
  driver_.frame(30);
  EXPECT_EQ(driver_.edited.settings.render.width, before - 100);
}

TEST_F(Viewport, AnErrorIsShownUntilItIsDismissed) {
  ui::post(driver_.state, ui::Severity::error, "something is wrong");
  driver_.frame(2);
  driver_.click("viewport/Dismiss");
  EXPECT_TRUE(driver_.state.banner.empty());
  EXPECT_EQ(driver_.state.messages.back().text, "something is wrong");
}

TEST_F(Viewport, ASelectionOfAnotherSceneIsHarmless) {
  driver_.state.selection.instance = 4000000;
  driver_.state.selection.triangle = 4000000;
  driver_.state.selection.light = 99;
  driver_.state.selection.material = 99;
  driver_.state.edited_material = 99;
  driver_.frame(3);
  driver_.press('F');
  driver_.press(ui::key_delete);
  SUCCEED();
}

TEST_F(Viewport, FarAwayAndBehindTheCameraNothingBreaks) {
  driver_.state.selection.instance = 0;
  driver_.state.selection.triangle = 0;
  camera(driver_).eye = vec3(0.0f, 1.0f, 0.0f);
  camera(driver_).target = vec3(0.0f, 1.0f, -1e-3f);
  driver_.trace();
  driver_.frame(3);
  camera(driver_).eye = vec3(1e7f);
  driver_.trace();
  driver_.frame(3);
  SUCCEED();
}

TEST(MovedLight, FollowsInAnOrthographicPicture) {
  Camera flat;
  flat.orthographic = true;
  const tracer::CameraFrame frame = tracer::frame(flat, 400, 200);
  const vec3 moved = ui::moved_light(frame, vec3(0.0f), flat.up, {10.0f, 0.0f}, false);
  const auto was = tracer::project(frame, vec3(0.0f));
  const auto is = tracer::project(frame, moved);
  EXPECT_NEAR(is->pixel.x - was->pixel.x, 10.0f, 0.01f);
}

}  // namespace
