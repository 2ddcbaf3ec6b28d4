// What takes longer to know of a BVH than a picture of it: EPO, overlaps, and SAH held against
// lines. The report computes all of it; the window does so beside the session.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "tracer/analyze/epo.h"
#include "tracer/analyze/overlap.h"
#include "tracer/analyze/sah_test.h"
#include "tracer/progress.h"

namespace tracer {

struct Measures {
  std::shared_ptr<const SceneBvh> bvh;  // that they are of
  // Nothing: not yet measured.
  std::optional<Epo> blas_epo, tlas_epo;
  std::optional<Overlap> blas_overlap, tlas_overlap;
  std::optional<InstanceOverlap> instances;
  std::optional<SahTest> sah_test;  // of the mesh with the most triangles
  uint32_t sah_test_mesh = none;
};

// Publishes what is known after each part. What `before` says of the same BLASes is taken over:
// instances that move change the TLAS alone. Stopped: the rest stays unknown.
Measures measure(const Scene& scene, const std::shared_ptr<const SceneBvh>& bvh,
                 const Measures* before, const Job& job,
                 const std::function<void(Measures)>& publish = nullptr);

}  // namespace tracer
