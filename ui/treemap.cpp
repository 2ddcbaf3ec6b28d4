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

constexpr double least_length = 1e-6;  // of the view: what can be zoomed to

// Twice as large in both directions shows two levels more.
uint32_t shown_level(const IcicleState& state) {
  const double deeper = -2.0 * std::log2(state.view.length);
  return static_cast<uint32_t>(std::max(state.level, 0) + std::lround(deeper));
}

void keep_tiles(IcicleState& state, const std::shared_ptr<const Icicle>& icicle,
                tracer::ivec2 size) {
  if (state.tiles_of == icicle && state.tiles_level == state.level && state.tiles_size == size &&
      state.tiles_view == state.view) {
    return;
  }
  state.tiles_of = icicle;
  state.tiles_level = state.level;
  state.tiles_size = size;
  state.tiles_view = state.view;
  state.tiles = tracer::treemap(*icicle, shown_level(state), size, state.view);
}

// Part of the view, 0..1, that the mouse is at.
glm::dvec2 mouse_in(ImVec2 at, ImVec2 size) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  return {double((mouse.x - at.x) / size.x), double((mouse.y - at.y) / size.y)};
}

void show(IcicleState& state, glm::dvec2 lo, double length) {
  state.view.length = std::clamp(length, least_length, 1.0);
  state.view.lo = glm::clamp(lo, glm::dvec2(0.0), glm::dvec2(1.0 - state.view.length));
}

void zoom(IcicleState& state, glm::dvec2 part, float steps) {
  const glm::dvec2 fixed = state.view.lo + part * state.view.length;
  const double next =
      std::clamp(state.view.length * std::pow(0.8, double(steps)), least_length, 1.0);
  show(state, fixed - part * next, next);
}

void pan(IcicleState& state, ImVec2 size) {
  const ImVec2 all = ImGui::GetMouseDragDelta(0, 3.0f);
  if (all.x == 0.0f && all.y == 0.0f) return;
  state.dragged = true;
  const ImVec2 moved = ImGui::GetIO().MouseDelta;
  show(state, state.view.lo - glm::dvec2(moved.x / size.x, moved.y / size.y) * state.view.length,
       state.view.length);
}

// Fills the picture with the node; with the whole map if that is how it is already.
void zoom_to(IcicleState& state, const Icicle& icicle, uint32_t node) {
  const tracer::TreemapView view = tracer::treemap_view_of(icicle, node, state.tiles_size);
  state.view = view == state.view ? tracer::TreemapView{} : view;
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
  const std::optional<Item> item = rectangle(state.tiles, table, holder(table, node), at);
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

std::optional<uint32_t> under_mouse(const IcicleState& state, ImVec2 at) {
  const ImVec2 mouse = {ImGui::GetIO().MousePos.x - at.x, ImGui::GetIO().MousePos.y - at.y};
  for (const TreemapTile& tile : state.tiles) {
    if (mouse.x >= tile.lo.x && mouse.x < tile.hi.x && mouse.y >= tile.lo.y &&
        mouse.y < tile.hi.y) {
      return tile.node;
    }
  }
  return {};
}

void use_mouse(Frame& frame, const Icicle& icicle, ImVec2 at, ImVec2 size) {
  IcicleState& state = frame.state.icicle;
  if (ImGui::IsItemActivated()) state.dragged = false;
  if (ImGui::IsItemActive()) pan(state, size);
  const bool released = ImGui::IsItemDeactivated() && !state.dragged;
  if (!ImGui::IsItemHovered()) return;
  if (ImGui::GetIO().MouseWheel != 0.0f) {
    zoom(state, mouse_in(at, size), ImGui::GetIO().MouseWheel);
  }
  if (state.dragged) return;
  const std::optional<uint32_t> node = under_mouse(state, at);
  if (ImGui::IsMouseDoubleClicked(0)) {
    zoom_to(state, icicle, node.value_or(0));
    state.dragged = true;  // its release selects nothing new
    return;
  }
  if (!node) {
    tooltip("The part of a node that is its own, and not of its children.");
    return;
  }
  const NodePlace place{icicle.options.mesh, *node};
  frame.state.hovered.node = place;
  if (released) choose_node(frame, place);
  tooltip(node_text(icicle, *node));
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
  const tracer::ivec2 pixels(static_cast<int>(size.x), static_cast<int>(size.y));
  keep_tiles(state, icicle, pixels);
  if (!stale) use_mouse(frame, *icicle, at, size);
  keep_tiles(state, icicle, pixels);
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
