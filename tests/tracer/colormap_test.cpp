#include "tracer/render/colormap.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tracer/choice.h"

namespace tracer {
namespace {

uint32_t at(std::string_view id, float t) {
  const vec3 color = find_row(colormaps(), id)->color(t) * 255.0f + 0.5f;
  return uint32_t(color.x) << 16 | uint32_t(color.y) << 8 | uint32_t(color.z);
}

TEST(Colormap, PublishedEndsAndMiddles) {
  EXPECT_EQ(at("viridis", 0.0f), 0x440154u);
  EXPECT_EQ(at("viridis", 0.5f), 0x21908cu);
  EXPECT_EQ(at("viridis", 1.0f), 0xfde725u);
  EXPECT_EQ(at("turbo", 0.0f), 0x30123bu);
  EXPECT_EQ(at("turbo", 1.0f), 0x7a0403u);
  EXPECT_EQ(at("inferno", 0.0f), 0x000004u);
  EXPECT_EQ(at("inferno", 1.0f), 0xfcffa4u);
  EXPECT_EQ(at("plasma", 0.0f), 0x0d0887u);
  EXPECT_EQ(at("plasma", 1.0f), 0xf0f921u);
  EXPECT_EQ(at("temperature", 0.0f), 0x3b4cc0u);
  EXPECT_EQ(at("temperature", 0.5f), 0xddddddu);
  EXPECT_EQ(at("temperature", 1.0f), 0xb40426u);
  EXPECT_EQ(at("grey", 0.5f), 0x808080u);
}

TEST(Colormap, ClampsAndSurvivesNan) {
  for (const ColormapRow& row : colormaps()) {
    EXPECT_EQ(row.color(-1.0f), row.color(0.0f)) << row.id;
    EXPECT_EQ(row.color(2.0f), row.color(1.0f)) << row.id;
    EXPECT_EQ(row.color(std::nanf("")), row.color(0.0f)) << row.id;
  }
}

TEST(Colormap, HasNoJumps) {
  for (const ColormapRow& row : colormaps()) {
    for (int i = 0; i < 1000; ++i) {
      const vec3 step = row.color(float(i + 1) / 1000.0f) - row.color(float(i) / 1000.0f);
      EXPECT_LT(glm::length(step), 0.02f) << row.id << " at " << i;
    }
  }
}

// Lightness that only grows is what makes these maps readable in print and without colour vision.
TEST(Colormap, SequentialMapsGetLighter) {
  for (const std::string_view id : {"viridis", "inferno", "plasma", "grey"}) {
    float before = -1.0f;
    for (int i = 0; i <= 64; ++i) {
      const vec3 color = find_row(colormaps(), id)->color(float(i) / 64.0f);
      const float luma = glm::dot(color, vec3(0.30f, 0.59f, 0.11f));
      EXPECT_GT(luma, before - 0.004f) << id << " at " << i;
      before = luma;
    }
  }
}

}  // namespace
}  // namespace tracer
