// The trees of a scene as tables.
#include "tracer/analyze/inspection.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "tracer/analyze/refit_growth.h"

namespace tracer {
namespace {

std::vector<std::vector<uint32_t>> lowest_entries(const Inspection& inspection) {
  const SceneBvh& bvh = *inspection.bvh;
  std::vector<std::vector<uint32_t>> entered(bvh.entries.empty() ? 0 : bvh.blases.size());
  for (size_t place = 0; place < bvh.entries.size(); ++place)
    entered[bvh.instances[bvh.tlas.references[place]].mesh].push_back(bvh.entries[place].node);
  for (size_t mesh = 0; mesh < entered.size(); ++mesh) {
    std::vector<uint32_t>& nodes = entered[mesh];
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::vector<bool> is_above(inspection.blases[mesh]->nodes.size());
    for (const uint32_t node : nodes) {
      uint32_t parent = inspection.blases[mesh]->nodes[node].parent;
      for (; parent != none; parent = inspection.blases[mesh]->nodes[parent].parent)
        is_above[parent] = true;
    }
    std::erase_if(nodes, [&](uint32_t node) { return is_above[node]; });
  }
  return entered;
}

}  // namespace

Inspection inspect(const std::shared_ptr<const SceneBvh>& bvh, const Inspection* before,
                   const Job& job) {
  Inspection result;
  result.bvh = bvh;
  const BuildOptions& options = bvh->options;
  const auto table = [&](const Bvh& tree, const WideTree& wide, bool tlas) {
    return std::make_shared<const TreeTable>(
        tree_table(tree, tlas, options.traversal_cost, options.intersection_cost, wide,
                   tlas ? bvh->entries : std::span<const EntryPoint>()));
  };
  job.progress(0.0f, "listing the nodes");
  result.tlas = table(bvh->tlas, bvh->wide_tlas, true);
  result.blases.resize(bvh->blases.size());
  tbb::parallel_for(size_t{0}, bvh->blases.size(), [&](size_t mesh) {
    if (job.stopped()) return;
    const bool known = before != nullptr && before->bvh && mesh < before->blases.size() &&
                       before->bvh->blases[mesh] == bvh->blases[mesh];
    const Blas& blas = *bvh->blases[mesh];
    result.blases[mesh] = known ? before->blases[mesh] : table(blas.tree, blas.wide, false);
  });
  if (job.stopped()) return {};
  result.entered = lowest_entries(result);
  return result;
}

double root_visits(const Inspection& inspection, uint32_t mesh, std::span<const uint32_t> visits) {
  const bool known = mesh < inspection.entered.size() && !inspection.entered[mesh].empty();
  if (!known) return double(visits[0]);
  double sum = 0.0, shares = 0.0;
  for (const uint32_t node : inspection.entered[mesh]) {
    sum += double(visits[node]);
    shares += area_share(*inspection.blases[mesh], node);
  }
  return shares > 0.0 ? sum / shares : 0.0;
}

const TreeTable* table_of(const Inspection& inspection, uint32_t mesh) {
  if (mesh == none) return inspection.tlas.get();
  return mesh < inspection.blases.size() ? inspection.blases[mesh].get() : nullptr;
}

NodeFigures::NodeFigures(std::shared_ptr<const Inspection> inspection, uint32_t mesh, int ray_class,
                         std::shared_ptr<const CountedVisits> visits,
                         std::shared_ptr<const Measures> measures)
    : inspection_(std::move(inspection)),
      counted_(std::move(visits)),
      measures_(std::move(measures)),
      mesh_(mesh),
      ray_class_(ray_class) {
  facts_.table = inspection_ ? table_of(*inspection_, mesh) : nullptr;
  if (facts_.table == nullptr) return;
  const SceneBvh& bvh = *inspection_->bvh;
  const auto same_tree = [&](const std::shared_ptr<const SceneBvh>& other) {
    if (other == nullptr) return false;
    if (mesh == none) return other == inspection_->bvh;
    return mesh < other->blases.size() && other->blases[mesh] == bvh.blases[mesh];
  };
  if (counted_ && counted_->visits && same_tree(counted_->bvh)) {
    visits_ = tree_visits(*counted_->visits, mesh, ray_class);
  }
  if (measures_ && same_tree(measures_->bvh)) {
    const std::optional<Epo>& epo = mesh == none ? measures_->tlas_epo : measures_->blas_epo;
    const size_t tree = mesh == none ? 0 : mesh;
    if (epo && tree < epo->node_shares.size()) facts_.epo = epo->node_shares[tree];
  }
  if (mesh != none && bvh.blases[mesh]->built_areas) growth_ = node_growth(*bvh.blases[mesh]);
  facts_.visits = visits_;
  if (!visits_.empty()) facts_.root_visits = root_visits(*inspection_, mesh, visits_);
  facts_.growth = growth_;
}

bool NodeFigures::is_of(const std::shared_ptr<const Inspection>& inspection, uint32_t mesh,
                        int ray_class, const std::shared_ptr<const CountedVisits>& visits,
                        const std::shared_ptr<const Measures>& measures) const {
  return inspection == inspection_ && mesh == mesh_ && ray_class == ray_class_ &&
         visits == counted_ && measures == measures_;
}

}  // namespace tracer
