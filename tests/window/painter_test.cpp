// The painter thread: the newest request wins, and its pictures are what paint() gives.
#include "app/window/painter.h"

#include <gtest/gtest.h>

#include "tests/window/wait.h"

namespace app {
namespace {

using tracer::Snapshot;
using tracer::ViewOptions;

std::shared_ptr<const Snapshot> traced(int width = 80, int height = 60) {
  tracer::Settings settings;
  settings.render.width = width;
  settings.render.height = height;
  settings.render.samples = 1;
  tracer::Pipeline pipeline;
  pipeline.run(settings, {}, {});
  return pipeline.snapshot();
}

ViewOptions heat_map() {
  ViewOptions view;
  view.view = "counter";
  return view;
}

void wake_nobody() {}

TEST(Painter, PaintsWhatPaintPaints) {
  const auto snapshot = traced();
  Painter painter(wake_nobody);
  painter.submit(snapshot, heat_map());
  ASSERT_TRUE(becomes_true([&] { return !painter.busy(); }));
  const auto painting = painter.painting();
  ASSERT_TRUE(painting->picture);
  EXPECT_EQ(painting->snapshot, snapshot);
  EXPECT_EQ(painting->picture->image.width, 80);
  EXPECT_EQ(painting->picture->image.pixels, paint(snapshot, heat_map()).picture->image.pixels);
  EXPECT_GT(painting->milliseconds, 0.0);
}

TEST(Painter, TheNewestRequestWins) {
  const auto snapshot = traced();
  Painter painter(wake_nobody);
  ViewOptions view;
  for (int i = 0; i <= 100; ++i) {
    view.exposure = float(i) * 0.01f;
    painter.submit(snapshot, view);
  }
  ASSERT_TRUE(becomes_true([&] { return !painter.busy(); }));
  EXPECT_EQ(painter.painting()->view, view);
}

TEST(Painter, DrawsTheLegendOnlyWhenAsked) {
  const auto snapshot = traced(320, 240);
  ViewOptions without = heat_map();
  without.legend = false;
  EXPECT_NE(paint(snapshot, heat_map()).picture->image.pixels,
            paint(snapshot, without).picture->image.pixels);
}

TEST(Painter, DrawsBoxesOfWhatIsSelected) {
  const auto snapshot = traced();
  ViewOptions view;
  view.boxes.show = true;
  view.boxes.what = "node";
  const auto pixels = [&](const tracer::BoxSources& boxes) {
    return paint(snapshot, view, boxes).picture->image.pixels;
  };
  tracer::BoxSources selected;
  selected.selected = tracer::NodePlace{tracer::none, 0};
  EXPECT_EQ(pixels({}), paint(snapshot, {}).picture->image.pixels);
  EXPECT_NE(pixels(selected), pixels({}));

  Painter painter(wake_nobody);
  for (const tracer::BoxSources& boxes : {selected, tracer::BoxSources(), selected}) {
    painter.submit(snapshot, view, boxes);
    ASSERT_TRUE(becomes_true([&] { return !painter.busy(); }));
    EXPECT_EQ(painter.painting()->picture->image.pixels, pixels(boxes));
    EXPECT_EQ(painter.painting()->boxes, boxes);
  }
}

TEST(Painter, AnUnknownViewIsAnErrorInWords) {
  ViewOptions view;
  view.view = "no-such-view";
  const Painting painting = paint(traced(), view);
  EXPECT_FALSE(painting.picture);
  EXPECT_NE(painting.error.find("no-such-view"), std::string::npos) << painting.error;
}

TEST(Painter, ThereIsNoPictureBeforeThereAreFacts) {
  const Painting painting = paint(std::make_shared<Snapshot>(), ViewOptions());
  EXPECT_FALSE(painting.picture);
}

TEST(Painter, CanBeDestroyedWhilePainting) {
  const auto snapshot = traced(640, 360);
  for (int i = 0; i < 10; ++i) {
    Painter painter(wake_nobody);
    painter.submit(snapshot, heat_map());
    std::this_thread::sleep_for(std::chrono::milliseconds(i));
  }
}

}  // namespace
}  // namespace app
