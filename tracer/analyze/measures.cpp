#include "tracer/analyze/measures.h"

#include <algorithm>

namespace tracer {
namespace {

uint32_t largest_mesh(const SceneBvh& bvh) {
  const auto largest =
      std::max_element(bvh.blases.begin(), bvh.blases.end(), [](const auto& a, const auto& b) {
        return a->tree.references.size() < b->tree.references.size();
      });
  return largest == bvh.blases.end() ? none : uint32_t(largest - bvh.blases.begin());
}

Measures known_before(const std::shared_ptr<const SceneBvh>& bvh, const Measures* before) {
  Measures measures;
  measures.bvh = bvh;
  if (before == nullptr || !before->bvh || before->bvh->blases != bvh->blases ||
      before->bvh->options.traversal_cost != bvh->options.traversal_cost ||
      before->bvh->options.intersection_cost != bvh->options.intersection_cost) {
    return measures;
  }
  measures.blas_epo = before->blas_epo;
  measures.blas_overlap = before->blas_overlap;
  measures.sah_test = before->sah_test;
  measures.sah_test_mesh = before->sah_test_mesh;
  return measures;
}

}  // namespace

Measures measure(const Scene& scene, const std::shared_ptr<const SceneBvh>& bvh,
                 const Measures* before, const Job& job,
                 const std::function<void(Measures)>& publish) {
  Measures measures = known_before(bvh, before);
  int parts_done = 0;
  // Runs one part unless it is known; what a stop has cut short is not.
  const auto part = [&](auto& target, std::string_view what, const auto& compute) {
    constexpr int parts = 6;
    job.progress(float(parts_done++) / parts, what);
    if (target || job.stopped()) return;
    auto value = compute();
    if (job.stopped()) return;
    target = std::move(value);
    if (publish) publish(measures);
  };
  const BuildOptions& options = bvh->options;
  part(measures.blas_overlap, "measuring overlap", [&] { return blas_overlap(*bvh); });
  part(measures.tlas_overlap, "measuring overlap", [&] { return overlap(bvh->tlas); });
  part(measures.blas_epo, "measuring EPO",
       [&] { return blas_epo(scene, *bvh, epo_limits, job.stop); });
  part(measures.tlas_epo, "measuring the EPO of instances",
       [&] { return tlas_epo(scene, *bvh, epo_limits, job.stop); });
  part(measures.instances, "measuring overlap of instances",
       [&] { return instance_overlap(*bvh, job.stop); });
  measures.sah_test_mesh = largest_mesh(*bvh);
  if (measures.sah_test_mesh != none) {
    part(measures.sah_test, "holding SAH against lines", [&] {
      return sah_test(bvh->blases[measures.sah_test_mesh]->tree, options.traversal_cost,
                      options.intersection_cost, sah_test_limits, job.stop);
    });
  }
  return measures;
}

}  // namespace tracer
