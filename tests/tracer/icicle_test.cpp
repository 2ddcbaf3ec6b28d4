// Icicles: places, pyramids of maxima, and the cells of a part.
#include "tracer/analyze/icicle.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "make_scene.h"
#include "tracer/analyze/treemap.h"
#include "tracer/choice.h"

namespace tracer::test {
namespace {

std::shared_ptr<const Inspection> inspection_of(std::vector<Mesh> meshes,
                                                const BuildOptions& options = {}) {
  const auto bvh = std::make_shared<const SceneBvh>(bvh_of(scene_of(std::move(meshes)), options));
  return std::make_shared<const Inspection>(inspect(bvh, nullptr, {}));
}

Icicle icicle_of(const std::shared_ptr<const Inspection>& inspection, IcicleOptions options) {
  return make_icicle({std::move(options), inspection, nullptr, nullptr}, {});
}

// A tree by hand, which no mesh is behind.
struct ByHand {
  std::shared_ptr<Inspection> inspection = std::make_shared<Inspection>();
  std::vector<uint32_t> visits;

  ByHand() {
    inspection->blases = {
        std::make_shared<const TreeTable>(tree_table(three_leaves(), false, 2.0f, 5.0f))};
  }
  Icicle icicle(const IcicleOptions& options) const {
    const TreeFacts facts{inspection->blases[0].get(), visits, {}, {}};
    return make_icicle(inspection, facts, options, {});
  }
};

double begin(const Icicle& icicle, size_t level, size_t place) {
  return icicle.levels[level].begin[place] / icicle_width;
}
double end(const Icicle& icicle, size_t level, size_t place) {
  return icicle.levels[level].end[place] / icicle_width;
}

TEST(Icicle, ANodeIsAsWideAsItsTriangles) {
  const Icicle icicle = ByHand().icicle({});
  ASSERT_EQ(icicle.levels.size(), 3u);
  EXPECT_EQ(icicle.levels[1].nodes, (std::vector<uint32_t>{1, 2}));
  EXPECT_EQ(icicle.levels[2].nodes, (std::vector<uint32_t>{3, 4}));
  EXPECT_NEAR(end(icicle, 0, 0), 1.0, 1e-9);
  EXPECT_NEAR(end(icicle, 1, 0), 1.0 / 6.0, 1e-9);
  EXPECT_NEAR(begin(icicle, 2, 0), 1.0 / 6.0, 1e-9);
  EXPECT_NEAR(begin(icicle, 2, 1), 3.0 / 6.0, 1e-9);
  EXPECT_NEAR(end(icicle, 2, 1), 1.0, 1e-9);
}

TEST(Icicle, OrAsItsCostOfWhichAPartIsItsOwn) {
  const ByHand tree;
  IcicleOptions options;
  options.width = "sah";
  const Icicle icicle = tree.icicle(options);
  const TreeTable& table = *tree.inspection->blases[0];
  const double all = double(table.nodes[0].sah);
  EXPECT_NEAR(end(icicle, 1, 0), double(table.nodes[1].sah) / all, 1e-6);
  EXPECT_NEAR(end(icicle, 1, 1) - begin(icicle, 1, 1), double(table.nodes[2].sah) / all, 1e-6);
  EXPECT_NEAR(1.0 - end(icicle, 1, 1), own_sah(table, 0) / all, 1e-6) << "the root's own";
}

TEST(Icicle, OrAsTheVisitsOfItsSubtree) {
  ByHand tree;
  IcicleOptions options;
  options.width = "visits";
  EXPECT_FALSE(tree.icicle(options).has_width);
  EXPECT_NEAR(end(tree.icicle(options), 1, 0), 1.0 / 6.0, 1e-9) << "triangles meanwhile";
  tree.visits = {10, 0, 6, 1, 3};
  const Icicle icicle = tree.icicle(options);
  EXPECT_TRUE(icicle.has_width);
  EXPECT_EQ(icicle.levels[1].begin[0], icicle.levels[1].end[0]) << "nobody came";
  EXPECT_NEAR(end(icicle, 1, 1) - begin(icicle, 1, 1), 0.5, 1e-9) << "6 + 1 + 3 of 20";
}

TEST(Icicle, ChildrenLieInsideTheirParents) {
  const auto inspection = inspection_of({sphere(40), soup(2000, 0.1f)});
  for (const IcicleWidthRow& width : icicle_widths()) {
    IcicleOptions options;
    options.mesh = 1;
    options.width = width.id;
    const Icicle icicle = icicle_of(inspection, options);
    const TreeTable& table = *inspection->blases[1];
    size_t nodes = 0;
    for (size_t depth = 0; depth < icicle.levels.size(); ++depth) {
      const IcicleLevel& level = icicle.levels[depth];
      nodes += level.nodes.size();
      for (size_t i = 0; i < level.nodes.size(); ++i) {
        ASSERT_EQ(icicle_place(icicle, level.nodes[i]), uint32_t(i));
        ASSERT_GE(level.begin[i], i > 0 ? level.end[i - 1] : 0u) << width.id;
        if (depth == 0) continue;
        const uint32_t parent = table.nodes[level.nodes[i]].parent;
        const uint32_t place = *icicle_place(icicle, parent);
        ASSERT_GE(level.begin[i], icicle.levels[depth - 1].begin[place]);
        ASSERT_LE(level.end[i], icicle.levels[depth - 1].end[place]);
      }
    }
    EXPECT_EQ(nodes, table.nodes.size());
  }
}

TEST(Icicle, RangeBeginsAtZeroAndDivergingOnesHaveItInTheMiddle) {
  ByHand tree;
  IcicleOptions options;
  EXPECT_EQ(tree.icicle(options).range, (ValueRange{0.0f, 100.0f})) << "SAH shares";
  options.color = "observed";
  EXPECT_FALSE(tree.icicle(options).has_values);
  tree.visits = {90, 30, 35, 20, 50};
  const ValueRange range = tree.icicle(options).range;
  EXPECT_EQ(range.lo, -range.hi);
  EXPECT_GE(range.hi, 1.0f);
}

TEST(Icicle, UnknownIdsAndATreeThatIsNotThere) {
  IcicleOptions options;
  options.width = options.color = "no such";
  EXPECT_EQ(ByHand().icicle(options).levels.size(), 3u);
  options.mesh = 7;
  EXPECT_TRUE(icicle_of(inspection_of({sphere(5)}), options).levels.empty());
  EXPECT_FALSE(icicle_place(icicle_of(inspection_of({sphere(5)}), options), 0));
}

TEST(Icicle, StoppedItHasNoLevels) {
  std::stop_source stop;
  stop.request_stop();
  const auto inspection = inspection_of({sphere(5)});
  EXPECT_TRUE(
      make_icicle({{}, inspection, nullptr, nullptr}, {stop.get_token(), {}}).levels.empty());
}

// Every cell against a search through all nodes.
void check_cells(const Icicle& icicle, double from, double to, int pixels) {
  const bool diverging = icicle.measure->scale == MeasureScale::diverging;
  const auto size_of = [&](float value) {
    return std::isnan(value) ? -1.0f : diverging ? std::abs(value) : value;
  };
  const double scale = pixels / (to - from);
  for (size_t depth = 0; depth < icicle.levels.size(); ++depth) {
    const IcicleLevel& level = icicle.levels[depth];
    const std::vector<IcicleCell> cells = icicle_cells(icicle, depth, from, to, pixels);
    ASSERT_LE(cells.size(), size_t(2 * pixels + 2));
    size_t next = 0;
    while (next < level.nodes.size() && level.end[next] / icicle_width <= from)
      ++next;
    for (const IcicleCell& cell : cells) {
      float most = -1.0f;
      bool holds = false;
      for (size_t i = next; i < next + cell.count; ++i) {
        most = std::max(most, size_of(level.values[i]));
        holds |= i == cell.place;
      }
      ASSERT_TRUE(holds);
      ASSERT_EQ(size_of(level.values[cell.place]), most) << "level " << depth;
      ASSERT_GE(cell.x1 - cell.x0, 0.0f);
      ASSERT_GE(cell.x0, 0.0f);
      const double first = (level.begin[next] / icicle_width - from) * scale;
      ASSERT_NEAR(double(cell.x0), std::max(first, 0.0), 1.0 + 1e-3);
      ASSERT_TRUE(cell.count == 1 || cell.x1 - cell.x0 == 1.0f);
      next += cell.count;
    }
    ASSERT_TRUE(next == level.nodes.size() || level.begin[next] / icicle_width >= to)
        << "no node is left out";
  }
}

TEST(IcicleCells, ShowTheLargestOfWhatSharesAColumn) {
  const auto inspection = inspection_of({soup(20000, 0.05f)});
  const TreeTable& table = *inspection->blases[0];
  std::mt19937 random(3);
  std::vector<uint32_t> visits(table.nodes.size());
  for (uint32_t& count : visits)
    count = random() % 1000;
  for (const char* color : {"visits", "observed", "overlap"}) {
    IcicleOptions options;
    options.color = color;
    const Icicle icicle = make_icicle(inspection, {&table, visits, {}, {}}, options, {});
    check_cells(icicle, 0.0, 1.0, 300);
    check_cells(icicle, 0.31, 0.32, 300);
    check_cells(icicle, 0.5, 0.5004, 117);
    check_cells(icicle, 0.9, 1.0, 1);
  }
}

TEST(IcicleCells, OneHotLeafAmongMillionsIsSeen) {
  const auto inspection = inspection_of({soup(50000, 0.01f)});
  const TreeTable& table = *inspection->blases[0];
  std::vector<uint32_t> visits(table.nodes.size(), 1);
  uint32_t hot = 0;
  for (uint32_t i = 0; i < table.nodes.size(); ++i) {
    if (is_leaf(table.nodes[i])) hot = i;
  }
  visits[hot] = 1000000;
  IcicleOptions options;
  options.color = "visits";
  const Icicle icicle = make_icicle(inspection, {&table, visits, {}, {}}, options, {});
  const size_t depth = table.nodes[hot].depth;
  bool seen = false;
  for (const IcicleCell& cell : icicle_cells(icicle, depth, 0.0, 1.0, 200))
    seen |= icicle.levels[depth].nodes[cell.place] == hot;
  EXPECT_TRUE(seen);
}

float area(const TreemapTile& tile) {
  return (tile.hi.x - tile.lo.x) * (tile.hi.y - tile.lo.y);
}

TEST(Treemap, AreasAreTheWeights) {
  const Icicle icicle = ByHand().icicle({});
  EXPECT_EQ(treemap(icicle, 0, {120, 60}).size(), 1u);
  float sum = 0.0f;
  for (const TreemapTile& tile : treemap(icicle, 9, {120, 60})) {
    const float triangles = tile.node == 1 ? 1.0f : tile.node == 3 ? 2.0f : 3.0f;
    EXPECT_TRUE(tile.node == 1 || tile.node == 3 || tile.node == 4) << "leaves";
    EXPECT_NEAR(area(tile), 7200.0f * triangles / 6.0f, 1.0f);
    sum += area(tile);
  }
  EXPECT_NEAR(sum, 7200.0f, 1.0f);
  EXPECT_TRUE(treemap(icicle, 3, {0, 60}).empty());
}

TEST(Treemap, AViewShowsAPartOfTheSameMap) {
  const Icicle icicle = icicle_of(inspection_of({soup(50000, 0.01f)}), {});
  const ivec2 size(400, 300);
  const TreemapView view{{0.25, 0.5}, 0.5};
  size_t compared = 0;
  for (const TreemapTile& whole : treemap(icicle, 6, size)) {
    for (const TreemapTile& part : treemap(icicle, 6, size, view)) {
      if (part.node != whole.node) continue;
      for (int axis = 0; axis < 2; ++axis) {
        const float begin = float(view.lo[axis]) * float(size[axis]);
        const float lo = 2.0f * (whole.lo[axis] - begin), hi = 2.0f * (whole.hi[axis] - begin);
        EXPECT_NEAR(part.lo[axis], std::max(lo, 0.0f), 0.01f);
        EXPECT_NEAR(part.hi[axis], std::min(hi, float(size[axis])), 0.01f);
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, 10u);
  EXPECT_LT(compared, 64u) << "the others are outside";
}

TEST(Treemap, TheViewOfANodeIsFilledWithIt) {
  const Icicle icicle = icicle_of(inspection_of({soup(50000, 0.01f)}), {});
  const ivec2 size(400, 300);
  const uint32_t node = icicle.levels[9].nodes[100];
  const TreemapView view = treemap_view_of(icicle, node, size);
  EXPECT_LT(view.length, 0.2);
  const std::vector<TreemapTile> tiles = treemap(icicle, 9, size, view);
  const auto found = std::find_if(tiles.begin(), tiles.end(),
                                  [&](const TreemapTile& tile) { return tile.node == node; });
  ASSERT_NE(found, tiles.end());
  const vec2 shown = found->hi - found->lo;
  EXPECT_TRUE(shown.x > 399.0f || shown.y > 299.0f) << shown.x << " " << shown.y;
  EXPECT_EQ(treemap_view_of(icicle, 0, size), TreemapView{});
  EXPECT_EQ(treemap_view_of(icicle, none, size), TreemapView{});
}

TEST(Treemap, OfALargeTreeHasABoundedNumberOfTiles) {
  const auto inspection = inspection_of({soup(50000, 0.01f)});
  for (const IcicleWidthRow& width : icicle_widths()) {
    IcicleOptions options;
    options.width = width.id;
    const Icicle icicle = icicle_of(inspection, options);
    const std::vector<TreemapTile> tiles = treemap(icicle, 255, {100, 80});
    EXPECT_GT(tiles.size(), 300u);
    EXPECT_LT(tiles.size(), 8000u);
    for (const TreemapTile& tile : tiles) {
      EXPECT_GE(tile.lo.x, 0.0f);
      EXPECT_LE(tile.hi.x, 100.0f);
      EXPECT_LE(tile.hi.y, 80.0f);
    }
  }
}

TEST(Treemap, OfWhatIsTooSmallTheLargestValueIsShown) {
  const auto inspection = inspection_of({soup(50000, 0.01f)});
  const TreeTable& table = *inspection->blases[0];
  std::vector<uint32_t> visits(table.nodes.size(), 1);
  IcicleOptions options;
  options.color = "visits";
  uint32_t hot = 0;
  for (uint32_t i = 0; i < table.nodes.size(); ++i) {
    if (table.nodes[i].depth == 14) hot = i;
  }
  ASSERT_NE(hot, 0u);
  visits[hot] = 1000000;
  const Icicle icicle = make_icicle(inspection, {&table, visits, {}, {}}, options, {});
  float most = 0.0f;
  for (const TreemapTile& tile : treemap(icicle, 14, {40, 30}))
    most = std::max(most, tile.value);
  EXPECT_EQ(most, 1e6f);
}

}  // namespace
}  // namespace tracer::test
