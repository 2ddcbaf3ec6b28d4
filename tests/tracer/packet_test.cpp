// Packets and streams: what every ray hits, and what probes see of it, is what they would of the
// ray alone.
#include <gtest/gtest.h>

#include "rebraided.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/bvh/trace.h"
#include "tracer/scene/camera.h"
#include "tracer/scene/scene.h"

namespace tracer::test {
namespace {

// Blocks of 4 x 4 pixels, so that packets of 16 are close; a third ends on the way.
std::vector<Ray> rays_of_view(const Box& box, const vec3& from) {
  Camera camera;
  camera.eye = from;
  camera.target = center(box);
  const CameraFrame view = frame(camera, 96, 96);
  std::vector<Ray> rays;
  for (int block = 0; block < 24 * 24; ++block) {
    for (int pixel = 0; pixel < 16; ++pixel) {
      const vec2 at(block % 24 * 4 + pixel % 4, block / 24 * 4 + pixel / 4);
      rays.push_back(primary_ray(view, at + 0.5f));
      if (rays.size() % 5 == 0) rays.back().t_min = glm::length(extent(box)) * 0.3f;
      if (rays.size() % 3 == 0) rays.back().t_max = glm::length(extent(box)) * 0.4f;
      if (rays.size() % 64 == 0) rays.back().t_min = rays.back().t_max = -1.0f;
    }
  }
  return rays;
}

struct Case {
  std::string name;
  Scene scene;
  std::string builder = "binned";
  bool rebraid = false;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"teapots", load_scene(parse_scene_source("teapots"), {})});
  all.push_back({"soup", scene_of({soup(3000, 0.2f), sphere(12, 0.4f), grid(6)})});
  // Between the triangles whole groups of packets meet nothing.
  all.push_back({"dust", scene_of({soup(60, 0.02f)})});
  all.push_back({"two clouds of dust", scene_of({soup(30, 0.02f), soup(40, 0.01f)})});
  Scene clouds = scene_of({soup(50, 0.02f), soup(60, 0.01f), soup(40, 0.02f)});
  clouds.instances[0].transform =
      glm::rotate(mat4(1.0f), 2.1f, glm::normalize(vec3(-1.0f, 0.3f, 0.8f)));
  clouds.instances[1].transform =
      glm::scale(glm::translate(mat4(1.0f), vec3(0.2f, -0.4f, 0.1f)), vec3(-1.5f, 0.3f, 1.0f));
  all.push_back({"turned clouds of dust", clouds});
  all.push_back({"spatial splits", scene_of({soup(800, 0.5f)}), "sbvh"});
  Mesh copies = soup(40, 0.5f);
  const std::vector<uvec3> once = copies.triangles;
  copies.triangles.insert(copies.triangles.end(), once.begin(), once.end());
  copies.materials.resize(copies.triangles.size());
  all.push_back({"coincident", scene_of({copies, copies})});
  Scene turned = scene_of({sphere(10), grid(5), soup(300, 0.3f)});
  turned.instances[0].transform =
      glm::rotate(mat4(1.0f), 0.7f, glm::normalize(vec3(1.0f, 2.0f, 0.5f)));
  turned.instances[2].transform =
      glm::scale(glm::translate(mat4(1.0f), vec3(0.3f, 0.1f, 0.0f)), vec3(2.0f, 0.5f, 1.0f));
  all.push_back({"turned", turned});
  all.push_back({"re-braided", crowd(), "binned", true});
  return all;
}

// From outside, from inside, and from where the centre is seen along an axis.
std::vector<vec3> places(const Box& box) {
  const vec3 size = extent(box);
  return {center(box) + 1.3f * size, center(box) + vec3(0.1f, 0.07f, 0.13f) * size,
          center(box) + vec3(0.0f, 0.0f, 1.1f) * size};
}

// Says how many rays enter a node that is watched.
template <bool any_hit>
size_t expect_the_same_alone_and_together(const SceneBvh& bvh, const std::vector<Ray>& rays,
                                          const Watched& watched) {
  EXPECT_EQ(suitable_kernel(rays), "packet");
  std::vector<Counters> alone(rays.size()), together(rays.size());
  std::vector<CountProbe> counting;
  Visits visits_alone = no_visits(bvh), visits_together = no_visits(bvh);
  std::vector<VisitProbe> visiting(rays.size(), VisitProbe(visits_together));
  std::vector<WatchProbe> watching(rays.size(), WatchProbe(watched));
  counting.reserve(together.size());
  for (Counters& counters : together)
    counting.emplace_back(counters);
  std::vector<Hit> hits(rays.size());
  trace_all<any_hit>(bvh, rays, std::span(counting), hits);
  trace_all<any_hit>(bvh, rays, std::span(visiting), hits);
  trace_all<any_hit>(bvh, rays, std::span(watching), hits);
  size_t entered = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    CountProbe count(alone[i]);
    VisitProbe visit(visits_alone);
    WatchProbe watch(watched);
    EXPECT_EQ(hits[i], trace<any_hit>(bvh, rays[i], count)) << "ray " << i;
    trace<any_hit>(bvh, rays[i], visit);
    trace<any_hit>(bvh, rays[i], watch);
    EXPECT_EQ(together[i], alone[i]) << "ray " << i;
    EXPECT_EQ(watching[i].entered, watch.entered) << "ray " << i;
    entered += watch.entered ? 1 : 0;
  }
  EXPECT_EQ(visits_together.tlas, visits_alone.tlas);
  EXPECT_EQ(visits_together.blases, visits_alone.blases);
  return entered;
}

void expect_every_kernel_to_agree(const SceneBvh& bvh, const std::string& layout,
                                  const std::vector<Ray>& rays) {
  std::vector<Hit> alone;
  alone.reserve(rays.size());
  NoProbe none;
  for (const Ray& ray : rays)
    alone.push_back(trace<false>(bvh, ray, none));
  for (const IsaRow& isa : isas()) {
    for (const KernelRow& row : ray_kernels()) {
      if (!has_kernel(layout, row.id)) continue;
      const RayKernel kernel = ray_kernel(layout, row.id, isa.id);
      std::vector<Hit> hits(rays.size());
      std::vector<uint8_t> blocked(rays.size());
      kernel.intersect(bvh, rays, hits);
      kernel.occluded(bvh, rays, blocked);
      for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(hits[i], alone[i]) << isa.id << " " << row.id << " ray " << i;
        ASSERT_EQ(blocked[i] != 0, is_hit(alone[i])) << isa.id << " " << row.id << " ray " << i;
      }
    }
  }
}

class EveryLayout : public testing::TestWithParam<std::string> {
 protected:
  SceneBvh bvh_for(const Case& one) const {
    BuildOptions options;
    options.builder = one.builder;
    options.layout = GetParam();
    options.rebraid = one.rebraid;
    SceneBvh bvh = bvh_of(one.scene, options);
    EXPECT_EQ(!bvh.entries.empty(), one.rebraid);
    return bvh;
  }
};
INSTANTIATE_TEST_SUITE_P(Packets, EveryLayout,
                         testing::Values("binary", "wide4", "wide8", "quantised8"),
                         [](const auto& layout) { return layout.param; });

// The first node below the root at which the mesh's BLAS is entered.
uint32_t node_entered(const SceneBvh& bvh, uint32_t mesh) {
  for (size_t place = 0; place < bvh.entries.size(); ++place) {
    const bool here = bvh.instances[bvh.tlas.references[place]].mesh == mesh;
    if (here && bvh.entries[place].node != 0) return bvh.entries[place].node;
  }
  return none;
}

// Under the root; where it is a leaf, the root.
uint32_t first_child(const Bvh& tree, const WideTree& wide) {
  const std::vector<WideSlot> of_wide = slots(wide);
  if (!of_wide.empty()) return of_wide[0].node;
  return tree.nodes[0].count > 0 ? 0 : tree.nodes[0].first;
}

TEST_P(EveryLayout, CountsInPacketsWhatEveryRayCountsAlone) {
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    const SceneBvh bvh = bvh_for(one);
    const uint32_t child = first_child(bvh.blases[0]->tree, bvh.blases[0]->wide);
    const uint32_t node = one.rebraid ? node_entered(bvh, 0) : child;
    for (const Watched& watched :
         {Watched{}, Watched{none, first_child(bvh.tlas, bvh.wide_tlas), none},
          Watched{0, node, none}, Watched{0, node, bvh.tlas.references[0]}}) {
      size_t entered = 0;
      for (const IsaRow& isa : isas()) {
        // They differ in how many rays a packet has: one scene for all of them.
        if (&isa != isas().data() && one.name != "turned") continue;
        prefer_isa(isa.id);
        for (const vec3& from : places(bounds(bvh))) {
          const std::vector<Ray> rays = rays_of_view(bounds(bvh), from);
          entered += expect_the_same_alone_and_together<false>(bvh, rays, watched);
          entered += expect_the_same_alone_and_together<true>(bvh, rays, watched);
        }
      }
      prefer_isa("");
      if (watched.instance == none) {
        EXPECT_GT(entered, size_t{0});
      }
    }
  }
}

TEST_P(EveryLayout, HitsTogetherWhatEveryRayHitsAloneOnEveryInstructionSet) {
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    const SceneBvh bvh = bvh_for(one);
    for (const vec3& from : places(bounds(bvh))) {
      std::vector<Ray> rays = rays_of_view(bounds(bvh), from);
      for (size_t i = 7; i < rays.size(); i += 50)
        rays[i].direction[i % 3] = i % 2 == 0 ? 0.0f : -0.0f;
      // Not valid:
      rays[5].direction = vec3(0.0f);
      for (size_t i = 100; i < rays.size(); i += 1000)
        rays[i].origin.x = infinity;
      for (size_t i = 600; i < rays.size(); i += 1000)
        rays[i].direction.y = std::numeric_limits<float>::quiet_NaN();
      rays.resize(rays.size() - 7);  // the last packet is not full
      expect_every_kernel_to_agree(bvh, GetParam(), rays);
    }
  }
}

// Where boxes of triangles are touched, and the inverse of the direction is not finite.
TEST_P(EveryLayout, HitsWhatRaysAlongAnAxisHitAtCorners) {
  const Case one{"corners", scene_of({grid(6), sphere(12)})};
  const SceneBvh bvh = bvh_for(one);
  std::vector<Ray> rays;
  for (const Mesh& mesh : one.scene.meshes) {
    for (const vec3& corner : mesh.positions) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const float sign : {-1.0f, 1.0f}) {
          vec3 way(0.0f);
          way[axis] = sign;
          rays.push_back({corner - 2.0f * way, 0.0f, way});
        }
      }
    }
  }
  expect_every_kernel_to_agree(bvh, GetParam(), rays);
}

}  // namespace
}  // namespace tracer::test
