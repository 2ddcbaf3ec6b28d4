// What the Tree panel and the Node panel remember.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ui/tree_rows.h"
#include "ui/workspace.h"

namespace ui {

// What the search field has found.
struct TreeSearch {
  std::string text;              // "n 12", "t 42", "i 7", or a number of `kind`
  std::string kind = "node";     // node, triangle or instance
  std::vector<uint32_t> leaves;  // that refer to what was looked for
  size_t at = 0;                 // the one that is shown
  std::string answer;            // in words
};

struct TreeState {
  uint32_t mesh = tracer::none;   // whose tree is shown; none: the TLAS
  uint64_t scene_generation = 0;  // for which a tree has been chosen
  std::string ray_class = "all";  // id of a RayClassRow: whose visits are shown
  std::vector<std::string> columns = {"sah", "visits", "references"};  // ids of measures
  std::string sort;        // id of the measure that siblings are ordered by; empty: as in the tree
  bool descending = true;  // the largest first
  TreeSearch search;
  std::shared_ptr<const tracer::TreeTable> table;  // that the rows are of
  TreeRows rows;
  tracer::NodeFigures figures;
  double top = 0.0;                  // the first row on the screen, and a part
  double page = 1.0;                 // rows on the screen
  Selection revealed;                // the selection that the list has been opened to
  bool picked = false;               // the selection was made here: the list stays where it is
  uint32_t menu_row = tracer::none;  // that the context menu is about, as in TreeRows
};

struct NodeState {
  std::string ray_class = "all";  // of the pixels
  bool show_pixels = false;
  tracer::NodeFigures figures;
  std::string lit_choice;  // id of the builder whose row is under the mouse
  // The pixels as blocks of the picture; made anew when they change.
  std::shared_ptr<const WatchedPixels> blocks_of;
  std::string blocks_class;
  std::vector<tracer::PixelBlock> blocks;
  uint64_t pixels = 0;
  // The leaves that the selected triangle or instance is in.
  Selection leaves_of;
  std::shared_ptr<const tracer::Inspection> leaves_in;
  std::vector<uint32_t> leaves;
};

}  // namespace ui
