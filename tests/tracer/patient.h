// A scene, and a BVH that can be damaged, for tests of what a validation finds.
#pragma once

#include <set>
#include <string>

#include "make_scene.h"
#include "tracer/analyze/validate.h"

namespace tracer::test {

struct Patient {
  Scene scene;
  SceneBvh bvh;

  explicit Patient(Scene of = scene_of({soup(200, 0.2f), sphere(6)}), BuildOptions options = {})
      : scene(std::move(of)), bvh(bvh_of(scene, options)) {}
  Blas& blas(size_t mesh = 0) {
    auto copy = std::make_shared<Blas>(*bvh.blases[mesh]);
    bvh.blases[mesh] = copy;
    return *copy;
  }
  Validation validated(uint64_t rays = 200) const { return validate(scene, bvh, rays, {}); }
  std::set<std::string> broken() const {
    std::set<std::string> rules;
    for (const Finding& finding : validated().findings)
      rules.emplace(finding.rule);
    return rules;
  }
};

}  // namespace tracer::test
