// What all instances can be made to do.
#include "tracer/scene/motion.h"

#include <gtest/gtest.h>

namespace tracer::test {
namespace {

const Box box{{-1, 0, -1}, {3, 2, 1}};

TEST(InstanceMotion, TheScenesOwnStays) {
  Motion own;
  own.spin = 3.0f;
  EXPECT_EQ(chosen({}, own, box, mat4(1.0f)), own);
  EXPECT_EQ(chosen({"unknown", 1.0f}, own, box, mat4(1.0f)), own);
  EXPECT_EQ(chosen({"none", 1.0f}, own, box, mat4(1.0f)), Motion());
}

TEST(InstanceMotion, SpinTurnsAboutTheMiddle) {
  const Motion motion = chosen({"spin", 0.25f}, {}, box, mat4(1.0f));
  const mat4 quarter = pose(mat4(1.0f), motion, 1.0f);
  EXPECT_LT(glm::distance(vec3(quarter * vec4(1, 5, 0, 1)), vec3(1, 5, 0)), 1e-5f);
  EXPECT_LT(glm::distance(vec3(quarter * vec4(2, 0, 0, 1)), vec3(1, 0, -1)), 1e-5f);
}

TEST(InstanceMotion, BounceHopsAQuarterOfTheHeight) {
  mat4 twice(2.0f);
  twice[3][3] = 1.0f;
  const Motion motion = chosen({"bounce", 1.0f}, {}, box, twice);
  EXPECT_EQ(pose(twice, motion, 0.0f)[3].y, 0.0f);
  EXPECT_NEAR(pose(twice, motion, 0.5f)[3].y, 1.0f, 1e-5f);
  EXPECT_NEAR(pose(twice, motion, 1.0f)[3].y, 0.0f, 1e-5f);
}

}  // namespace
}  // namespace tracer::test
