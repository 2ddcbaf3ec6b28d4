// Steps against the trees they go through, and what is said of them.
#include "tracer/analyze/ray_words.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/analyze/ray_log_report.h"
#include "tracer/analyze/tree_table.h"

namespace tracer::test {
namespace {

using testing::HasSubstr;

// A bumpy sphere behind another one, in two instances each.
struct Spheres {
  Spheres() {
    scene = scene_of({sphere(24, 1.0f, vec3(0), 0.2f), sphere(12, 0.6f, vec3(0, 0, 2), 0.3f)});
    Instance again = scene.instances[0];
    again.transform[3] = vec4(0.4f, 0.2f, -1.5f, 1.0f);
    scene.instances.push_back(again);
    bvh = std::make_shared<const SceneBvh>(bvh_of(scene));
  }
  CastRay ray(int i, RayClass ray_class = RayClass::primary) const {
    CastRay cast;
    cast.ray_class = ray_class;
    cast.ray.origin = vec3(-1.5f + 0.07f * float(i), 0.3f, 6.0f);
    cast.ray.direction = vec3(1.2f, -0.2f, -6.0f) - 0.05f * float(i) * vec3(1, 0, 0);
    if (ray_class == RayClass::shadow) cast.ray.t_max = 1.0f;
    return cast;
  }

  Scene scene;
  std::shared_ptr<const SceneBvh> bvh;
};
constexpr int ray_count = 40;

const Bvh& tree_of(const SceneBvh& bvh, const Step& step) {
  return step.instance == none ? bvh.tlas : bvh.blases[bvh.instances[step.instance].mesh]->tree;
}

bool is_box(const Step& step) {
  return step.kind == StepKind::node || step.kind == StepKind::leaf;
}

TEST(Steps, KnowTheirDepth) {
  const Spheres spheres;
  const TreeTable tables[] = {tree_table(spheres.bvh->blases[0]->tree, false, 1, 1),
                              tree_table(spheres.bvh->blases[1]->tree, false, 1, 1),
                              tree_table(spheres.bvh->tlas, true, 1, 1)};
  std::set<uint32_t> depths;
  for (int i = 0; i < ray_count; ++i) {
    uint32_t leaf_depth[2] = {};  // of the leaf entered last, of the TLAS and of a BLAS
    for (const Step& step : log_ray(*spheres.bvh, spheres.ray(i)).steps) {
      const TreeTable& table =
          step.instance == none ? tables[2] : tables[spheres.bvh->instances[step.instance].mesh];
      if (is_box(step)) {
        ASSERT_EQ(step.depth, table.nodes[step.id].depth);
        const bool leaf = step.kind == StepKind::leaf && step.result == StepResult::entered;
        if (leaf) leaf_depth[step.instance != none] = step.depth;
        depths.insert(step.depth);
      } else {
        EXPECT_EQ(step.depth, leaf_depth[step.instance != none]);
      }
    }
  }
  EXPECT_GT(depths.size(), 6u);
}

TEST(Steps, AreInTheirBoxesAndBeforeTheNearestHit) {
  const Spheres spheres;
  int behind = 0, missed = 0;
  for (int i = 0; i < ray_count; ++i) {
    const LoggedRay ray = log_ray(*spheres.bvh, spheres.ray(i));
    float best = infinity;
    for (const Step& step : ray.steps) {
      if (step.result == StepResult::hit) best = step.t_entry;
      ASSERT_EQ(step.t_best, best);
      if (!is_box(step)) continue;
      ASSERT_EQ(step.result == StepResult::missed, step.t_entry > step.t_exit);
      if (step.result == StepResult::behind) {
        ASSERT_GT(step.t_entry, best);
      }
      behind += step.result == StepResult::behind;
      missed += step.result == StepResult::missed;
    }
    EXPECT_EQ(best, ray.cast.hit.t);
  }
  EXPECT_GT(behind, 10);
  EXPECT_GT(missed, 100);
}

TEST(Steps, EachChildOfAnEnteredNodeIsAccountedFor) {
  const Spheres spheres;
  int waited = 0, never = 0;
  for (const RayClass ray_class : {RayClass::primary, RayClass::shadow}) {
    for (int i = 0; i < ray_count; ++i) {
      const LoggedRay ray = log_ray(*spheres.bvh, spheres.ray(i, ray_class));
      for (size_t at = 0; at < ray.steps.size(); ++at) {
        const Step& step = ray.steps[at];
        const std::vector<TestedChild> children = tested_children(ray, at);
        if (step.kind != StepKind::node || step.result != StepResult::entered) {
          ASSERT_TRUE(children.empty());
          continue;
        }
        const uint32_t first = tree_of(*spheres.bvh, step).nodes[step.id].first;
        ASSERT_EQ(children.size(), 2u);
        ASSERT_EQ(children[0].node, first);
        ASSERT_EQ(children[1].node, first + 1);
        int firsts = 0;
        for (size_t side = 0; side < 2; ++side) {
          const TestedChild& child = children[side];
          const TestedChild& other = children[1 - side];
          firsts += child.order == ChildOrder::first;
          if (child.order == ChildOrder::waits) {
            ++waited;
            ASSERT_EQ(other.order, ChildOrder::first);
            if (child.step == none) {
              ++never;
              ASSERT_EQ(ray_class, RayClass::shadow);
              ASSERT_TRUE(is_hit(ray.cast.hit));
            } else {
              ASSERT_GE(ray.steps[child.step].t_entry, ray.steps[other.step].t_entry);
            }
          } else {
            ASSERT_LE(child.step, at + 2);
          }
        }
        ASSERT_LE(firsts, 1);
      }
    }
  }
  EXPECT_GT(waited, 100);
  EXPECT_GT(never, 3);
}

TEST(Explain, SaysWhatHappenedAndWhy) {
  const Spheres spheres;
  std::set<std::string> reasons;
  std::string all;
  for (const RayClass ray_class : {RayClass::primary, RayClass::shadow}) {
    for (int i = 0; i < ray_count; ++i) {
      const LoggedRay ray = log_ray(*spheres.bvh, spheres.ray(i, ray_class));
      for (size_t at = 0; at < ray.steps.size(); ++at) {
        reasons.insert(why(ray, at));
        all += explain(*spheres.bvh, ray, at) + "\n";
      }
    }
  }
  EXPECT_THAT(reasons, testing::IsSupersetOf({"", "from the stack", "the ray passes its box by",
                                              "not hit", "the nearest so far", "any hit is enough",
                                              "something nearer was hit while it waited",
                                              "it begins behind the nearest hit",
                                              "the ray goes on in its own space"}));
  EXPECT_THAT(all, HasSubstr("comes first, at t "));
  EXPECT_THAT(all, HasSubstr("waits until the ray has ended"));
  EXPECT_THAT(all, HasSubstr("The next one comes from the stack."));
  EXPECT_THAT(all, HasSubstr("Nothing waits in this tree."));
  EXPECT_THAT(all, HasSubstr("Waiting, the next one first: "));
  EXPECT_THAT(all, HasSubstr("nothing has been hit yet before the ray's end at t 1."));
}

TEST(Explain, BehindTheEndOfTheRayIsNotBehindAHit) {
  const Spheres spheres;
  CastRay cast = spheres.ray(20, RayClass::shadow);
  cast.ray.t_max = 0.5f;  // ends before the spheres
  const LoggedRay ray = log_ray(*spheres.bvh, cast);
  ASSERT_FALSE(ray.steps.empty());
  EXPECT_EQ(why(ray, 0), "it begins behind the ray's end");
  EXPECT_THAT(explain(*spheres.bvh, ray, 0), HasSubstr("behind its own end at t 0.5"));
}

RayLog log_of(const Spheres& spheres) {
  RayLog log{spheres.bvh, ivec2(3, 4), {}};
  for (int i = 0; i < 6; ++i) {
    log.rays.push_back(
        log_ray(*spheres.bvh, spheres.ray(15 + i, i == 2 ? RayClass::shadow : RayClass::primary)));
  }
  // 0 casts 1 and 2, 1 casts 3 and 5, 2 casts 4.
  const uint32_t parents[] = {none, 0, 0, 1, 2, 1};
  for (size_t i = 0; i < 6; ++i)
    log.rays[i].cast.parent = parents[i];
  return log;
}

TEST(RayTree, ChildrenFollowTheirParent) {
  std::vector<uint32_t> order, levels;
  for (const RayPlace& place : ray_tree(log_of(Spheres()))) {
    order.push_back(place.ray);
    levels.push_back(place.level);
  }
  EXPECT_EQ(order, (std::vector<uint32_t>{0, 1, 3, 5, 2, 4}));
  EXPECT_EQ(levels, (std::vector<uint32_t>{0, 1, 2, 2, 1, 2}));
  EXPECT_TRUE(ray_tree({}).empty());
}

TEST(LogAgain, TheSameRaysInAnotherTree) {
  const Spheres spheres;
  BuildOptions options;
  options.builder = "median";
  const auto other = std::make_shared<const SceneBvh>(bvh_of(spheres.scene, options));
  const RayLog before = log_of(spheres);
  const RayLog now = log_again(before, other);
  EXPECT_EQ(now.bvh, other);
  EXPECT_EQ(now.pixel, before.pixel);
  ASSERT_EQ(now.rays.size(), before.rays.size());
  for (size_t i = 0; i < now.rays.size(); ++i) {
    EXPECT_EQ(now.rays[i].cast.parent, before.rays[i].cast.parent);
    if (i != 2) {
      EXPECT_EQ(now.rays[i].cast.hit, before.rays[i].cast.hit);
    }
    EXPECT_EQ(now.rays[i].counters, counted(now.rays[i].steps));
  }
  EXPECT_NE(counted(now), counted(before));
  EXPECT_EQ(counted(before).rays, 6u);
}

TEST(RayLogJson, StepsAddUpToTheCounters) {
  const Spheres spheres;
  const RayLog log = log_of(spheres);
  Snapshot snapshot;
  snapshot.scene = std::make_shared<const Scene>(spheres.scene);
  const Json json = Json::parse(ray_log_json(snapshot, log).dump());
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["pixel"], Json::array({3, 4}));
  EXPECT_EQ(json["scene"]["instances"], 3);
  EXPECT_TRUE(json["machine"].contains("cpu"));
  ASSERT_EQ(json["rays"].size(), log.rays.size());
  for (size_t i = 0; i < log.rays.size(); ++i) {
    const Json& ray = json["rays"][i];
    std::map<std::string, uint32_t> sums;
    for (const Json& step : ray["steps"]) {
      const std::string kind = step["kind"];
      if (kind == "triangle" || step["result"] == "entered") ++sums[kind];
      EXPECT_EQ(step["level"] == "tlas", step["instance"].is_null());
    }
    EXPECT_EQ(ray["counters"]["nodes"], sums["node"]);
    EXPECT_EQ(ray["counters"]["leaves"], sums["leaf"]);
    EXPECT_EQ(ray["counters"]["triangles"], sums["triangle"]);
    EXPECT_EQ(ray["counters"]["instances"], sums["instance"]);
    EXPECT_EQ(ray["steps"].size(), log.rays[i].steps.size());
  }
  EXPECT_EQ(json["rays"][0]["class"], "primary");
  EXPECT_TRUE(json["rays"][0]["t_max"].is_null()) << "infinite";
  EXPECT_EQ(json["rays"][2]["t_max"], 1.0);
  EXPECT_EQ(json["rays"][5]["parent"], 1);
  EXPECT_EQ(json["rays"][0]["hit"]["triangle"], log.rays[0].cast.hit.triangle);
}

TEST(RayLogText, HasTheRaysAndTheAskedSteps) {
  const Spheres spheres;
  const RayLog log = log_of(spheres);
  Snapshot snapshot;
  snapshot.scene = std::make_shared<const Scene>(spheres.scene);
  const size_t second = 1;
  const std::string text = ray_log_text(snapshot, log, std::span(&second, 1));
  EXPECT_THAT(text, HasSubstr("pixel 3, 4"));
  EXPECT_THAT(text, HasSubstr("Steps of ray 1 (primary)"));
  EXPECT_THAT(text, testing::Not(HasSubstr("Steps of ray 0")));
  EXPECT_THAT(text, HasSubstr("entered: the ray goes on in its own space"));
  const size_t lines = size_t(std::count(text.begin(), text.end(), '\n'));
  EXPECT_EQ(lines, 2 + 1 + 6 + 1 + 3 + log.rays[1].steps.size());
}

}  // namespace
}  // namespace tracer::test
