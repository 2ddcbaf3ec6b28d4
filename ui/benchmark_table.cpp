// The tables of the Benchmark panel.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include <fmt/format.h>
#include <imgui.h>

#include "ui/benchmark.h"
#include "ui/benchmark_way.h"
#include "ui/registry.h"
#include "ui/widgets.h"

namespace ui {
namespace {

using tracer::Benchmark;
using tracer::BuildTiming;
using tracer::RayTiming;
using tracer::Spread;

constexpr ImU32 peer_color = IM_COL32(232, 144, 48, 255);
constexpr float bar_width = 12.0f;  // em

// A row of either table, as text and as what its bar shows.
struct Line {
  size_t index;  // in the benchmark
  bool of_peer;
  std::string name;          // of a peer: its name and quality
  double value, peer;        // of the bar; peer 0: none
  std::vector<double> sort;  // by column; of texts the place in their order
};

bool is_shown(const BenchmarkState& state, int threads) {
  return state.shown_threads == "all" || (state.shown_threads == "one") == (threads == 1);
}

template <class Row>
std::string builder_of(const Row& row) {
  return row.who.empty() ? row.builder : row.who + " (" + row.layout + ")";
}

std::string class_text(const RayTiming& row) {
  return row.view.empty() ? row.ray_class : row.ray_class + ", " + row.view;
}

// The fastest peer beside the row: same rays, threads and kind of tests.
double fastest_peer(const Benchmark& benchmark, const RayTiming& of) {
  double best = 0.0;
  for (const RayTiming& row : benchmark.rays) {
    const bool beside = !row.who.empty() && row.builder == of.builder && row.view == of.view &&
                        row.ray_class == of.ray_class && row.threads == of.threads &&
                        row.robust == of.robust;
    if (beside) best = std::max(best, row.mrays_per_s.median);
  }
  return best;
}

void number(const std::string& text) {
  const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
  if (room > 0.0f) ImGui::SetCursorPosX(std::floor(ImGui::GetCursorPosX() + room));
  ImGui::TextUnformatted(text.c_str());
}

// Ours with the peer's below it, thinner; a peer's in its own colour.
void draw_bar(double value, double peer, double most, bool of_peer) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size = {bar_width * em(), ImGui::GetTextLineHeight()};
  ImGui::Dummy(size);
  const auto length = [&](double of) {
    return most > 0.0 ? size.x * static_cast<float>(std::min(of / most, 1.0)) : 0.0f;
  };
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float split = at.y + (peer > 0.0 && !of_peer ? 0.66f : 1.0f) * size.y;
  draw.AddRectFilled({at.x, at.y + 1.0f}, {at.x + length(value), split - 1.0f},
                     of_peer ? peer_color : ImGui::GetColorU32(ImGuiCol_PlotHistogram));
  if (of_peer || peer <= 0.0) return;
  const float end = at.x + length(peer);
  draw.AddRectFilled({at.x, split}, {end, at.y + size.y - 1.0f}, peer_color);
  draw.AddRectFilled({end - 2.0f, at.y}, {end, at.y + size.y}, peer_color);
}

std::string spread_text(const Spread& spread, const char* unit, int count) {
  return fmt::format("{:.3f} {}: the median of {}; half of them were between {:.3f} and {:.3f}",
                     spread.median, unit, count, spread.low, spread.high);
}

struct Column {
  std::string label, help;
  bool figure;
};

bool begin_table(const char* id, const std::vector<Column>& columns) {
  const ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV |
                                ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollX |
                                ImGuiTableFlags_ScrollY | ImGuiTableFlags_Sortable |
                                ImGuiTableFlags_SortTristate;
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, ImVec2(0.25f * em(), 0.1f * em()));
  const bool open = ImGui::BeginTable(id, static_cast<int>(columns.size()), flags,
                                      ImGui::GetContentRegionAvail());
  ImGui::PopStyleVar();
  if (!open) return false;
  ImGui::TableSetupScrollFreeze(1, 1);
  for (const Column& column : columns) {
    ImGui::TableSetupColumn(column.label.c_str(),
                            column.figure ? ImGuiTableColumnFlags_PreferSortDescending : 0);
  }
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  const Scope scope("header");
  for (const Column& column : columns) {
    ImGui::TableNextColumn();
    ImGui::TableHeader(column.label.c_str());
    mark(column.label);
    tooltip(column.help);
  }
  return true;
}

void sort(std::vector<Line>& lines) {
  const ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
  if (specs == nullptr || specs->SpecsCount == 0) return;
  const auto column = static_cast<size_t>(specs->Specs[0].ColumnIndex);
  const bool down = specs->Specs[0].SortDirection == ImGuiSortDirection_Descending;
  std::stable_sort(lines.begin(), lines.end(), [&](const Line& a, const Line& b) {
    return down ? b.sort[column] < a.sort[column] : a.sort[column] < b.sort[column];
  });
}

// Replaces a column's texts by their places among all.
void rank(std::vector<Line>& lines, size_t column, const std::vector<std::string>& texts) {
  const std::set<std::string> order(texts.begin(), texts.end());
  for (size_t i = 0; i < lines.size(); ++i) {
    const auto place = order.find(texts[i]);
    lines[i].sort[column] = static_cast<double>(std::distance(order.begin(), place));
  }
}

// The first cell, which makes the whole row clickable.
void draw_name(Frame& frame, const Line& line, const BenchmarkWay& way) {
  tracer::Settings& settings = frame.edited.settings;
  const Presence present = line.of_peer ? Presence::other : presence(way, settings);
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  if (line.of_peer) ImGui::PushStyleColor(ImGuiCol_Text, peer_color);
  const bool clicked = ImGui::Selectable(
      fmt::format("{}##row", line.name).c_str(), present != Presence::other,
      ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowItemOverlap);
  if (line.of_peer) ImGui::PopStyleColor();
  mark("row");
  if (ImGui::TableGetColumnFlags() & ImGuiTableColumnFlags_IsHovered) {
    tooltip(line.of_peer ? "Measured beside our rows; (low, medium, high): its build quality"
                         : click_help(way, present));
  }
  if (clicked && !line.of_peer) choose(way, settings);
}

void cell(const std::string& text, const std::string& help) {
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(text.c_str());
  tooltip(help);
}
void figure(const std::string& text, const std::string& help) {
  ImGui::TableNextColumn();
  number(text);
  if (!text.empty()) tooltip(help);
}

double ratio_of(const RayTiming& row, int width) {
  for (const RayTiming::Ratio& ratio : row.ratios)
    if (ratio.width == width) return ratio.value;
  return 0.0;
}

std::vector<int> peer_widths(const Benchmark& benchmark) {
  std::set<int> widths;
  for (const RayTiming& row : benchmark.rays)
    if (!row.who.empty()) widths.insert(row.width);
  return {widths.begin(), widths.end()};
}

std::vector<Column> ray_columns(const std::vector<int>& widths) {
  std::vector<Column> columns = {
      {"Builder", "Builder of the tree; a peer by its name and build quality", false},
      {"Layout", "How the traversal stores the tree", false},
      {"Kernel", "How rays share the work", false},
      {"Rays", "Class of the rays, and the view that they begin with", false},
      {"Threads", "One: by the thread's processor time. Several: by the clock on the wall", true},
      {"Mrays/s", "Million rays a second, the median of the turns", true},
      {"Speed", "The same as a bar. Orange, below: the fastest kernel of the peer with these rays",
       true}};
  for (const int width : widths) {
    columns.push_back({fmt::format("x{}", width),
                       fmt::format("Our speed over that of the peer's fastest kernel of {} ray{}; "
                                   "above 1 ours is faster",
                                   width, width == 1 ? "" : "s at once"),
                       true});
  }
  columns.push_back({"Hits", "Rays that hit something: all rows must agree", true});
  columns.push_back({"Sum of t",
                     "Distances of the nearest hits, added up, in units of the rays' directions",
                     true});
  columns.push_back({"Differ",
                     "Rays that the first row of the group answers otherwise: of ours "
                     "none may, of a peer's and by fast tests a few at edges",
                     true});
  return columns;
}

std::vector<Line> ray_lines(const BenchmarkState& state, const Benchmark& benchmark,
                            const std::vector<int>& widths) {
  std::vector<Line> lines;
  std::vector<std::string> texts[4];
  for (size_t i = 0; i < benchmark.rays.size(); ++i) {
    const RayTiming& row = benchmark.rays[i];
    const bool wanted = state.shown_class == "all" || state.shown_class == row.ray_class;
    if (!wanted || !is_shown(state, row.threads)) continue;
    const double speed = row.mrays_per_s.median;
    Line line{i, !row.who.empty(), builder_of(row), speed, fastest_peer(benchmark, row), {}};
    line.sort = {0, 0, 0, 0, double(row.threads), speed, speed};
    for (const int width : widths)
      line.sort.push_back(ratio_of(row, width));
    line.sort.insert(line.sort.end(), {double(row.hits), row.sum_t, double(row.differ)});
    lines.push_back(std::move(line));
    const std::string names[] = {builder_of(row), row.layout, kernel_text(row), class_text(row)};
    for (size_t k = 0; k < 4; ++k)
      texts[k].push_back(names[k]);
  }
  for (size_t k = 0; k < 4; ++k)
    rank(lines, k, texts[k]);
  return lines;
}

void draw_ray_row(Frame& frame, const Benchmark& benchmark, const Line& line, double most,
                  const std::vector<int>& widths) {
  const RayTiming& row = benchmark.rays[line.index];
  const Scope scope("timing", line.index);
  draw_name(frame, line, way_of(row));
  cell(line.of_peer ? "" : row.layout, "");
  cell(kernel_text(row), row.isa.empty() ? "" : "Vector instructions: " + row.isa);
  cell(class_text(row), fmt::format("{} rays", grouped(row.rays)));
  figure(fmt::format("{}", row.threads), "");
  const std::string speed = spread_text(row.mrays_per_s, "Mrays/s", row.turns);
  figure(fmt::format("{:.2f}", row.mrays_per_s.median), speed);
  ImGui::TableNextColumn();
  draw_bar(line.value, line.peer, most, line.of_peer);
  mark("bar");
  tooltip(line.of_peer || line.peer <= 0.0
              ? speed
              : fmt::format("{}. The peer's fastest: {:.3f} Mrays/s", speed, line.peer));
  for (const int width : widths) {
    const double ratio = ratio_of(row, width);
    figure(
        ratio > 0.0 ? fmt::format("{:.2f}", ratio) : "",
        fmt::format("{:.4f} times as fast as the peer's fastest kernel of width {}", ratio, width));
  }
  figure(grouped(row.hits), fmt::format("{} of {} rays", grouped(row.hits), grouped(row.rays)));
  figure(row.any_hit ? "" : short_number(row.sum_t), fmt::format("{:.17g}", row.sum_t));
  figure(row.differ == 0 ? "" : grouped(row.differ),
         row.agrees ? "Few enough to be rounding" : "More than rounding explains");
}

std::vector<Line> build_lines(const BenchmarkState& state, const Benchmark& benchmark) {
  std::vector<Line> lines;
  std::vector<std::string> names, layouts;
  for (size_t i = 0; i < benchmark.builds.size(); ++i) {
    const BuildTiming& row = benchmark.builds[i];
    if (!is_shown(state, row.threads)) continue;
    const double peer = row.ratio > 0.0 ? row.mtris_per_s / row.ratio : 0.0;
    lines.push_back({i,
                     !row.who.empty(),
                     builder_of(row),
                     row.mtris_per_s,
                     peer,
                     {0, 0, double(row.threads), row.ms.median, row.mtris_per_s, row.mtris_per_s,
                      row.ratio, row.sah, row.bytes_per_triangle}});
    names.push_back(builder_of(row));
    layouts.push_back(row.layout);
  }
  rank(lines, 0, names);
  rank(lines, 1, layouts);
  return lines;
}

std::vector<Column> build_columns() {
  return {
      {"Builder", "Builder of the trees; a peer by its name and build quality", false},
      {"Layout", "How the traversal stores the tree", false},
      {"Threads", "One: by the thread's processor time. Several: by the clock on the wall", true},
      {"Build ms", "Of the trees of all meshes, ready to trace: the median", true},
      {"Mtri/s", "Million triangles built a second", true},
      {"Speed", "The same as a bar. Orange, below: the peer's build that does the same", true},
      {"Ratio", "The peer's time over ours; above 1 ours is faster", true},
      {"SAH", "Surface area heuristic of the trees, in units of its costs", true},
      {"B/tri",
       "Bytes a triangle of what is traced, nodes and triangles; of a peer what it "
       "allocates, with its copy of the mesh",
       true}};
}

void draw_build_row(Frame& frame, const Benchmark& benchmark, const Line& line, double most) {
  const BuildTiming& row = benchmark.builds[line.index];
  const Scope scope("timing", line.index);
  draw_name(frame, line, way_of(row));
  cell(line.of_peer ? "" : row.layout, "");
  figure(fmt::format("{}", row.threads), "");
  figure(fmt::format("{:.2f}", row.ms.median), spread_text(row.ms, "ms", row.builds));
  figure(fmt::format("{:.2f}", row.mtris_per_s), fmt::format("{} Mtri/s", row.mtris_per_s));
  ImGui::TableNextColumn();
  draw_bar(line.value, line.peer, most, line.of_peer);
  mark("bar");
  tooltip(fmt::format("{:.3f} Mtri/s", row.mtris_per_s));
  figure(row.ratio > 0.0 ? fmt::format("{:.2f}", row.ratio) : "", fmt::format("{}", row.ratio));
  figure(row.sah > 0.0 ? fmt::format("{:.2f}", row.sah) : "", fmt::format("{}", row.sah));
  figure(fmt::format("{:.1f}", row.bytes_per_triangle),
         fmt::format("{} bytes a triangle", row.bytes_per_triangle));
}

double largest(const std::vector<Line>& lines) {
  double most = 0.0;
  for (const Line& line : lines)
    most = std::max({most, line.value, line.peer});
  return most;
}

}  // namespace

void draw_ray_timings(Frame& frame, const Benchmark& benchmark) {
  const std::vector<int> widths = peer_widths(benchmark);
  std::vector<Line> lines = ray_lines(frame.state.benchmark, benchmark, widths);
  if (!begin_table("rays", ray_columns(widths))) return;
  sort(lines);
  const double most = largest(lines);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(lines.size()));
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      draw_ray_row(frame, benchmark, lines[static_cast<size_t>(i)], most, widths);
  }
  ImGui::EndTable();
}

void draw_build_timings(Frame& frame, const Benchmark& benchmark) {
  std::vector<Line> lines = build_lines(frame.state.benchmark, benchmark);
  if (!begin_table("builds", build_columns())) return;
  sort(lines);
  const double most = largest(lines);
  for (const Line& line : lines)
    draw_build_row(frame, benchmark, line, most);
  ImGui::EndTable();
}

}  // namespace ui
