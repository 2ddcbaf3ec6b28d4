// Levels, places and pyramids of an icicle, and the cells that a part of it shows.
#include "tracer/analyze/icicle.h"

#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "tracer/choice.h"

namespace tracer {
namespace {

constexpr size_t arity = 4;        // of the pyramids
constexpr size_t grain = 1 << 14;  // nodes that a task takes

double own_references(const TreeFacts& facts, uint32_t node) {
  const TableNode& row = facts.table->nodes[node];
  return is_leaf(row) ? double(row.references) : 0.0;
}
double own_cost(const TreeFacts& facts, uint32_t node) {
  return own_sah(*facts.table, node);
}
double own_visits(const TreeFacts& facts, uint32_t node) {
  return facts.visits.empty() ? 0.0 : double(facts.visits[node]);
}

constexpr IcicleWidthRow widths[] = {
    {"references", "Triangles",
     "A node is as wide as the triangles below it, in the TLAS the instances", own_references},
    {"sah", "SAH cost", "A node is as wide as what it and its subtree add to SAH", own_cost},
    {"visits", "Visits",
     "A node is as wide as the visits of it and of all nodes below it: the work that rays of the "
     "frame had there",
     own_visits},
};

template <class Function>
void for_each(size_t count, const Function& function) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, grain), [&](const auto& range) {
    for (size_t i = range.begin(); i != range.end(); ++i)
      function(i);
  });
}

// By node: where it begins, and its weight with that of its subtree.
struct Places {
  std::vector<double> begin, weight;
};

Places places(const TreeFacts& facts, const IcicleWidthRow& width) {
  const std::vector<TableNode>& nodes = facts.table->nodes;
  Places at;
  at.begin.resize(nodes.size());
  at.weight.resize(nodes.size());
  for_each(nodes.size(), [&](size_t i) { at.weight[i] = width.own(facts, uint32_t(i)); });
  for (size_t i = nodes.size(); i-- > 1;)
    at.weight[nodes[i].parent] += at.weight[i];
  for (size_t i = 0; i < nodes.size(); ++i) {
    double begin = at.begin[i];
    for (const uint32_t child : children_of(*facts.table, uint32_t(i))) {
      at.begin[child] = begin;
      begin += at.weight[child];
    }
  }
  return at;
}

// Every level's nodes from left to right.
std::vector<IcicleLevel> levels_of(const TreeTable& table) {
  std::vector<uint32_t> counts(256, 0);
  for (const TableNode& node : table.nodes)
    counts[node.depth] += node.in_layout ? 1 : 0;
  std::vector<IcicleLevel> levels(1);
  levels[0].nodes = {0};
  while (counts[levels.size()] > 0) {
    IcicleLevel next;
    next.nodes.reserve(counts[levels.size()]);
    for (const uint32_t node : levels.back().nodes) {
      const std::span<const uint32_t> children = children_of(table, node);
      next.nodes.insert(next.nodes.end(), children.begin(), children.end());
    }
    levels.push_back(std::move(next));
    if (levels.size() == counts.size()) break;
  }
  return levels;
}

bool farther(float value, float than, bool diverging) {
  if (std::isnan(value)) return false;
  if (std::isnan(than)) return true;
  return diverging ? std::abs(value) > std::abs(than) : value > than;
}

void build_pyramid(IcicleLevel& level, bool diverging) {
  size_t below = level.values.size();
  while (below > arity) {
    const std::vector<uint32_t>* under = level.pyramid.empty() ? nullptr : &level.pyramid.back();
    std::vector<uint32_t> layer((below + arity - 1) / arity);
    for_each(layer.size(), [&](size_t i) {
      const size_t last = std::min((i + 1) * arity, below);
      uint32_t best = under != nullptr ? (*under)[i * arity] : uint32_t(i * arity);
      for (size_t j = i * arity + 1; j < last; ++j) {
        const uint32_t other = under != nullptr ? (*under)[j] : uint32_t(j);
        if (farther(level.values[other], level.values[best], diverging)) best = other;
      }
      layer[i] = best;
    });
    below = layer.size();
    level.pyramid.push_back(std::move(layer));
  }
}

// The place of the largest value in [from, to).
uint32_t largest(const IcicleLevel& level, size_t from, size_t to, bool diverging) {
  uint32_t best = uint32_t(from);
  while (from < to) {
    size_t size = 1, layer = 0;
    while (layer < level.pyramid.size() && from % (size * arity) == 0 &&
           from + size * arity <= to) {
      size *= arity;
      ++layer;
    }
    const uint32_t other = layer == 0 ? uint32_t(from) : level.pyramid[layer - 1][from / size];
    if (farther(level.values[other], level.values[best], diverging)) best = other;
    from += size;
  }
  return best;
}

// From 0 to the largest; of a diverging measure as far to both sides as 99 % of the nodes go, and
// at least to twice and half.
ValueRange fitted(const Icicle& icicle) {
  std::vector<float> some;
  float most = 0.0f;
  for (const IcicleLevel& level : icicle.levels) {
    const size_t step = level.values.size() / 20000 + 1;
    for (size_t i = 0; i < level.values.size(); i += step) {
      if (std::isfinite(level.values[i])) some.push_back(std::abs(level.values[i]));
    }
    const float peak = level.values[largest(level, 0, level.values.size(), false)];
    if (std::isfinite(peak)) most = std::max(most, peak);
  }
  if (icicle.measure->scale != MeasureScale::diverging) return {0.0f, most};
  if (some.empty()) return {-1.0f, 1.0f};
  const auto high = some.begin() + ptrdiff_t(0.99 * double(some.size() - 1));
  std::nth_element(some.begin(), high, some.end());
  const float reach = std::max(*high, 1.0f);
  return {-reach, reach};
}

void fill_level(IcicleLevel& level, const TreeFacts& facts, const Places& at,
                const NodeMeasureRow& measure) {
  const size_t count = level.nodes.size();
  level.begin.resize(count);
  level.end.resize(count);
  level.values.resize(count);
  const double scale = at.weight[0] > 0.0 ? icicle_width / at.weight[0] : 0.0;
  const auto unit = [&](double place) {
    return uint32_t(std::clamp(place * scale, 0.0, icicle_width - 1.0));
  };
  for_each(count, [&](size_t i) {
    const uint32_t node = level.nodes[i];
    level.begin[i] = unit(at.begin[node]);
    level.end[i] = unit(at.begin[node] + at.weight[node]);
    level.values[i] = float(measure.value(facts, node));
  });
  build_pyramid(level, measure.scale == MeasureScale::diverging);
}

// The first place from `i` on whose node begins at or after `limit`.
size_t first_from(const IcicleLevel& level, size_t i, double limit) {
  size_t step = 1;
  while (i + step < level.begin.size() && double(level.begin[i + step]) < limit)
    step *= 2;
  const auto from = level.begin.begin() + ptrdiff_t(i + step / 2);
  const auto to = level.begin.begin() + ptrdiff_t(std::min(i + step + 1, level.begin.size()));
  return size_t(std::partition_point(from, to, [&](uint32_t x) { return double(x) < limit; }) -
                level.begin.begin());
}

}  // namespace

std::span<const IcicleWidthRow> icicle_widths() {
  return widths;
}

bool needs_visits(const IcicleOptions& options) {
  return options.width == "visits" || is_from(MeasureSource::visits, options.color);
}

IcicleSources icicle_sources(const IcicleOptions& options,
                             std::shared_ptr<const Inspection> inspection,
                             std::shared_ptr<const CountedVisits> visits,
                             std::shared_ptr<const Measures> measures) {
  if (!needs_visits(options)) visits.reset();
  if (!is_from(MeasureSource::epo, options.color)) measures.reset();
  return {options, std::move(inspection), std::move(visits), std::move(measures)};
}

Icicle make_icicle(const IcicleSources& sources, const Job& job) {
  const NodeFigures figures(sources.inspection, sources.options.mesh, sources.options.ray_class,
                            sources.visits, sources.measures);
  return make_icicle(sources.inspection, figures.facts(), sources.options, job);
}

Icicle make_icicle(const std::shared_ptr<const Inspection>& inspection, const TreeFacts& facts,
                   const IcicleOptions& options, const Job& job) {
  Icicle icicle;
  icicle.inspection = inspection;
  icicle.options = options;
  icicle.measure = find_row(node_measures(), options.color);
  if (icicle.measure == nullptr) icicle.measure = &node_measures()[0];
  if (facts.table == nullptr || facts.table->nodes.empty()) return icicle;

  job.progress(0.0f, "placing the nodes");
  const IcicleWidthRow* width = find_row(icicle_widths(), options.width);
  Places at = places(facts, width != nullptr ? *width : widths[0]);
  icicle.has_width = at.weight[0] > 0.0;
  if (!icicle.has_width) at = places(facts, widths[0]);
  icicle.levels = levels_of(*facts.table);
  size_t done = 0;
  for (IcicleLevel& level : icicle.levels) {
    if (job.stopped()) {
      icicle.levels.clear();
      return icicle;
    }
    job.progress(float(done) / float(facts.table->nodes.size()), "reading the nodes' values");
    fill_level(level, facts, at, *icicle.measure);
    done += level.nodes.size();
  }
  icicle.range = fitted(icicle);
  icicle.has_values =
      std::any_of(icicle.levels.begin(), icicle.levels.end(), [&](const IcicleLevel& level) {
        return !std::isnan(level.values[largest(level, 0, level.values.size(), false)]);
      });
  return icicle;
}

std::vector<IcicleCell> icicle_cells(const Icicle& icicle, size_t index, double from, double to,
                                     int pixels) {
  std::vector<IcicleCell> cells;
  const IcicleLevel& level = icicle.levels[index];
  const double scale = double(pixels) / ((to - from) * icicle_width);  // pixels a unit
  const double first = from * icicle_width, last = to * icicle_width;
  const bool diverging = icicle.measure->scale == MeasureScale::diverging;
  const auto column = [&](double place) { return (place - first) * scale; };
  const size_t count = level.nodes.size();
  size_t i = size_t(std::partition_point(level.end.begin(), level.end.end(),
                                         [&](uint32_t end) { return double(end) <= first; }) -
                    level.end.begin());
  while (i < count && double(level.begin[i]) < last) {
    const auto wide = [&](size_t place) {
      return double(level.end[place] - level.begin[place]) * scale >= 1.0;
    };
    IcicleCell cell;
    if (wide(i)) {
      cell.x0 = float(std::max(column(level.begin[i]), 0.0));
      cell.x1 = float(std::min(column(level.end[i]), double(pixels)));
      cell.place = uint32_t(i);
      cells.push_back(cell);
      ++i;
      continue;
    }
    const double left = std::max(std::floor(column(level.begin[i])), 0.0);
    size_t next = std::max(first_from(level, i, first + (left + 1.0) / scale), i + 1);
    if (next > i + 1 && wide(next - 1)) --next;
    cell.x0 = float(left);
    cell.x1 = float(left + 1.0);
    cell.count = uint32_t(next - i);
    cell.place = largest(level, i, next, diverging);
    cells.push_back(cell);
    i = next;
  }
  return cells;
}

std::optional<uint32_t> icicle_largest(const Icicle& icicle, size_t index, uint32_t begin,
                                       uint32_t end) {
  const IcicleLevel& level = icicle.levels[index];
  const auto from = std::lower_bound(level.begin.begin(), level.begin.end(), begin);
  const auto to = std::lower_bound(from, level.begin.end(), end);
  if (from == to) return {};
  return largest(level, size_t(from - level.begin.begin()), size_t(to - level.begin.begin()),
                 icicle.measure->scale == MeasureScale::diverging);
}

std::optional<uint32_t> icicle_place(const Icicle& icicle, uint32_t node) {
  if (!icicle.inspection) return {};
  const TreeTable* table = table_of(*icicle.inspection, icicle.options.mesh);
  if (table == nullptr || node >= table->nodes.size()) return {};
  node = holder(*table, node);
  const TableNode& row = table->nodes[node];
  if (row.depth >= icicle.levels.size()) return {};
  const std::vector<uint32_t>& nodes = icicle.levels[row.depth].nodes;
  const auto found = std::partition_point(nodes.begin(), nodes.end(), [&](uint32_t other) {
    return table->nodes[other].order < row.order;
  });
  if (found == nodes.end() || *found != node) return {};
  return uint32_t(found - nodes.begin());
}

}  // namespace tracer
