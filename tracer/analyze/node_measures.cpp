// The table of what can be said of a node.
#include "tracer/analyze/node_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tracer/analyze/overlap.h"
#include "tracer/choice.h"

namespace tracer {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

const TableNode& row_of(const TreeFacts& facts, uint32_t node) {
  return facts.table->nodes[node];
}

double share_of_sah(const TreeFacts& facts, double sah) {
  const double all = double(facts.table->nodes[0].sah);
  return all > 0.0 ? 100.0 * sah / all : unknown;
}

ChildFit fit_of(const TreeFacts& facts, uint32_t node) {
  std::vector<Box> boxes;
  for (const uint32_t child : children_of(*facts.table, node))
    boxes.push_back(row_of(facts, child).box);
  return child_fit(row_of(facts, node).box, boxes);
}

double depth(const TreeFacts& facts, uint32_t node) {
  return row_of(facts, node).depth;
}
double kind(const TreeFacts& facts, uint32_t node) {
  return is_leaf(row_of(facts, node)) ? 1.0 : 0.0;
}
double references(const TreeFacts& facts, uint32_t node) {
  return row_of(facts, node).references;
}
double area(const TreeFacts& facts, uint32_t node) {
  return 100.0 * area_share(*facts.table, node);
}
double sah_self(const TreeFacts& facts, uint32_t node) {
  return share_of_sah(facts, own_sah(*facts.table, node));
}
double sah(const TreeFacts& facts, uint32_t node) {
  return share_of_sah(facts, double(row_of(facts, node).sah));
}
double visits(const TreeFacts& facts, uint32_t node) {
  return facts.visits.empty() ? unknown : double(facts.visits[node]);
}
double observed(const TreeFacts& facts, uint32_t node) {
  if (facts.visits.empty()) return unknown;
  const double predicted =
      facts.root_visits.value_or(double(facts.visits[0])) * area_share(*facts.table, node);
  // Half a visit instead of none, so that nodes no ray entered have a finite place.
  return predicted > 0.0 ? std::log2(std::max(double(facts.visits[node]), 0.5) / predicted)
                         : unknown;
}
double epo(const TreeFacts& facts, uint32_t node) {
  return facts.epo.empty() ? unknown : double(facts.epo[node]);
}
double overlap(const TreeFacts& facts, uint32_t node) {
  return is_leaf(row_of(facts, node)) ? unknown : 100.0 * fit_of(facts, node).overlap;
}
double empty_space(const TreeFacts& facts, uint32_t node) {
  return is_leaf(row_of(facts, node)) ? unknown : 100.0 * fit_of(facts, node).empty_space;
}
double growth(const TreeFacts& facts, uint32_t node) {
  return facts.growth.empty() ? unknown : std::log2(double(facts.growth[node]));
}

constexpr NodeMeasureRow rows[] = {
    {"depth", "Depth", "Edges from the root", "", MeasureScale::sequential, depth, 0},
    {"kind", "Kind", "Inner node or leaf", "", MeasureScale::category, kind, 0},
    {"references", "Triangles",
     "References in the leaves below: triangles, or instances in the TLAS", "",
     MeasureScale::sequential, references, 0},
    {"area", "Area", "A(node) / A(root): how often a random line through the root meets the node",
     "%", MeasureScale::sequential, area, 3},
    {"sah_self", "SAH self",
     "What the node itself adds to the tree's SAH: A(node) / A(root) times Ct of an inner node, or "
     "count * Ci of a leaf; as a share of the whole",
     "%", MeasureScale::sequential, sah_self, 3},
    {"sah", "SAH", "What the node and everything below it add to the tree's SAH, as a share", "%",
     MeasureScale::sequential, sah, 2},
    {"visits", "Visits", "How often rays of the frame entered the node", "",
     MeasureScale::sequential, visits, 0, MeasureSource::visits},
    {"observed", "Observed / predicted",
     "log2 of measured visits over those that the node's area predicts: visits(root) * A(node) / "
     "A(root). 1: twice as many, -1: half; no visit counts as half of one",
     "log2", MeasureScale::diverging, observed, 2, MeasureSource::visits},
    {"epo", "EPO",
     "The node's share of end-point overlap: what rays pay at their ends for its box though the "
     "surface there is not in it; of the canonical binary tree; unit: the costs",
     "", MeasureScale::sequential, epo, 5, MeasureSource::epo},
    {"overlap", "Overlap",
     "Area that two of its children have in common / its own area, summed over all pairs of "
     "children",
     "%", MeasureScale::sequential, overlap, 2},
    {"empty_space", "Empty space", "The part of its volume that is in none of its children", "%",
     MeasureScale::sequential, empty_space, 1},
    {"growth", "Growth", "log2 of its area now over that when the tree was built", "log2",
     MeasureScale::diverging, growth, 2, MeasureSource::growth},
};

}  // namespace

std::span<const NodeMeasureRow> node_measures() {
  return rows;
}

bool is_from(MeasureSource source, std::string_view measure) {
  const NodeMeasureRow* row = find_row(node_measures(), measure);
  return row != nullptr && row->source == source;
}

bool is_known(const TreeFacts& facts, const NodeMeasureRow& measure) {
  for (uint32_t node = 0; node < facts.table->nodes.size(); ++node) {
    if (facts.table->nodes[node].in_layout && !std::isnan(measure.value(facts, node))) return true;
  }
  return false;
}

}  // namespace tracer
