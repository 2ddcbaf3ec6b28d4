// The treemap of the Icicle panel.
#include <algorithm>
#include <cmath>

#include "tracer/choice.h"
#include "ui/icicle.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::Icicle;
using tracer::TreemapTile;

constexpr ImU32 bright = IM_COL32(255, 200, 60, 255);
constexpr ImU32 pale = IM_COL32(255, 255, 255, 200);

void keep_tiles(IcicleState& state, const std::shared_ptr<const Icicle>& icicle,
                tracer::ivec2 size) {
  if (state.tiles_of == icicle && state.tiles_level == state.level && state.tiles_size == size) {
    return;
  }
  state.tiles_of = icicle;
  state.tiles_level = state.level;
  state.tiles_size = size;
  state.tiles = tracer::treemap(*icicle, static_cast<uint32_t>(std::max(state.level, 0)), size);
}

bool is_below(const tracer::TreeTable& table, uint32_t node, uint32_t other) {
  const tracer::TableNode &a = table.nodes[node], &b = table.nodes[other];
  return a.depth >= b.depth && a.order >= b.order &&
         a.order + a.references <= b.order + b.references;
}

// The rectangle of a node: of the tiles below it, or the tile that it is in.
std::optional<Item> rectangle(const std::vector<TreemapTile>& tiles, const tracer::TreeTable& table,
                              uint32_t node, ImVec2 at) {
  std::optional<Item> item;
  for (const TreemapTile& tile : tiles) {
    if (!is_below(table, tile.node, node) && !is_below(table, node, tile.node)) continue;
    if (!item) item = Item{{at.x + tile.lo.x, at.y + tile.lo.y}, {at.x, at.y}};
    item->lo = {std::min(item->lo.x, at.x + tile.lo.x), std::min(item->lo.y, at.y + tile.lo.y)};
    item->hi = {std::max(item->hi.x, at.x + tile.hi.x), std::max(item->hi.y, at.y + tile.hi.y)};
  }
  return item;
}

void outline(const IcicleState& state, const tracer::TreeTable& table, uint32_t node, ImVec2 at,
             ImU32 color, float width) {
  const std::optional<Item> item = rectangle(state.tiles, table, node, at);
  if (!item) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRect(item->lo, item->hi, IM_COL32(0, 0, 0, 200), 0.0f, 0, width + 2.0f);
  list.AddRect(item->lo, item->hi, color, 0.0f, 0, width);
}

void draw_tiles(const IcicleState& state, const Icicle& icicle, ImVec2 at, float alpha) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const tracer::MeasureColors colors(icicle.measure->scale, icicle.range, state.logarithmic,
                                     tracer::counts(*icicle.measure));
  const ImU32 mask = static_cast<ImU32>(alpha * 255.0f) << 24 | 0xffffffu;
  for (const TreemapTile& tile : state.tiles) {
    const float gap_x = tile.hi.x - tile.lo.x >= 4.0f ? 1.0f : 0.0f;
    const float gap_y = tile.hi.y - tile.lo.y >= 4.0f ? 1.0f : 0.0f;
    const ImVec2 lo = {at.x + std::floor(tile.lo.x), at.y + std::floor(tile.lo.y)};
    list.AddRectFilled(lo,
                       {std::max(at.x + std::floor(tile.hi.x) - gap_x, lo.x + 1.0f),
                        std::max(at.y + std::floor(tile.hi.y) - gap_y, lo.y + 1.0f)},
                       colors(tile.value) & mask);
  }
}

void use_mouse(Frame& frame, const Icicle& icicle, ImVec2 at) {
  if (!ImGui::IsItemHovered()) return;
  const ImVec2 mouse = {ImGui::GetIO().MousePos.x - at.x, ImGui::GetIO().MousePos.y - at.y};
  for (const TreemapTile& tile : frame.state.icicle.tiles) {
    if (mouse.x < tile.lo.x || mouse.x >= tile.hi.x || mouse.y < tile.lo.y ||
        mouse.y >= tile.hi.y) {
      continue;
    }
    const NodePlace place{icicle.options.mesh, tile.node};
    frame.state.hovered.node = place;
    if (ImGui::IsMouseClicked(0)) choose_node(frame, place);
    tooltip(node_text(icicle, place.node));
    return;
  }
  tooltip("The part of a node that is its own, and not of its children.");
}

}  // namespace

void draw_treemap(Frame& frame, const std::shared_ptr<const Icicle>& icicle, ImVec2 size,
                  bool stale) {
  IcicleState& state = frame.state.icicle;
  ImVec2 at = ImGui::GetCursorScreenPos();
  at = {std::floor(at.x), std::floor(at.y)};
  size = {std::max(std::floor(size.x), 1.0f), std::max(std::floor(size.y), 1.0f)};
  ImGui::InvisibleButton("tiles", size);
  mark("tiles");
  keep_tiles(state, icicle, {static_cast<int>(size.x), static_cast<int>(size.y)});
  if (!stale) use_mouse(frame, *icicle, at);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 hi = {at.x + size.x, at.y + size.y};
  list.AddRectFilled(at, hi, IM_COL32(14, 15, 17, 255));
  list.PushClipRect(at, hi, true);
  draw_tiles(state, *icicle, at, stale ? 0.4f : 1.0f);
  const tracer::TreeTable& table = *tracer::table_of(*icicle->inspection, icicle->options.mesh);
  const auto shown = [&](const std::optional<NodePlace>& place) {
    return !stale && place && place->mesh == icicle->options.mesh &&
           place->node < table.nodes.size();
  };
  if (shown(frame.state.selection.node)) {
    const uint32_t selected = frame.state.selection.node->node;
    for (const uint32_t node : tracer::path_to(table, selected)) {
      const bool itself = node == selected;
      outline(state, table, node, at, itself ? bright : pale, itself ? 2.0f : 1.0f);
    }
  }
  if (shown(frame.state.hovered.node)) {
    outline(state, table, frame.state.hovered.node->node, at, IM_COL32_WHITE, 1.0f);
  }
  list.PopClipRect();
}

}  // namespace ui
