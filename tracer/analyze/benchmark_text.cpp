// A benchmark as tables for a terminal.
#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "tracer/analyze/benchmark_report.h"
#include "tracer/machine.h"

namespace tracer {
namespace {

// Half the distance of the quartiles, in percent of the median.
double spread_percent(const Spread& spread) {
  return spread.median > 0.0 ? 50.0 * (spread.high - spread.low) / spread.median : 0.0;
}

std::string ratio_cell(double ratio) {
  return ratio > 0.0 ? fmt::format("{:>8.2f}", ratio) : fmt::format("{:>8}", "");
}

std::string threads_text(int threads) {
  return fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
}

// Only the largest of the peer's scenes and the rows that a reader compares stand out by their
// name.
std::string who_text(const std::string& who, const std::string& layout) {
  return who.empty() ? layout : who + " " + layout;
}

std::string builds_text(const Benchmark& benchmark, bool with_peers) {
  std::string text =
      fmt::format("{:<14}{:<16}{:>8}{:>11}{:>6}{:>9}{:>8}{:>8}{}\n", "builder", "layout", "threads",
                  "build, ms", "±%", "Mtri/s", "SAH", "B/tri", with_peers ? "  /peer" : "");
  for (const BuildTiming& row : benchmark.builds) {
    text += fmt::format("{:<14}{:<16}{:>8}{:>11.2f}{:>6.1f}{:>9.2f}{:>8}{:>8.1f}{}\n", row.builder,
                        who_text(row.who, row.layout), row.threads, row.ms.median,
                        spread_percent(row.ms), row.mtris_per_s,
                        row.sah > 0.0 ? fmt::format("{:.2f}", row.sah) : "", row.bytes_per_triangle,
                        row.ratio > 0.0 ? fmt::format("{:>7.2f}", row.ratio) : "");
  }
  return text;
}

// Rows that were measured in turns.
bool is_same_group(const RayTiming& a, const RayTiming& b) {
  return a.builder == b.builder && a.ray_class == b.ray_class && a.view == b.view &&
         a.threads == b.threads;
}

std::string group_title(const RayTiming& first) {
  std::string text = fmt::format("\n{}, {} rays", first.builder, first.ray_class);
  if (!first.view.empty()) text += fmt::format(", {} view", first.view);
  text +=
      fmt::format(", {}: {} rays, {} hits", threads_text(first.threads), first.rays, first.hits);
  if (!first.any_hit) text += fmt::format(", sum of t {:.9g}", first.sum_t);
  return text + '\n';
}

std::string row_text(const RayTiming& row, const std::set<int>& widths) {
  std::string text = fmt::format("  {:<16}{:<24}{:<9}{:>9.2f}{:>6.1f}",
                                 who_text(row.who, row.layout), kernel_text(row), row.isa,
                                 row.mrays_per_s.median, spread_percent(row.mrays_per_s));
  for (const int width : widths) {
    const auto found = std::find_if(row.ratios.begin(), row.ratios.end(),
                                    [&](const auto& ratio) { return ratio.width == width; });
    text += ratio_cell(found == row.ratios.end() ? 0.0 : found->value);
  }
  if (row.differ > 0)
    text += fmt::format("   {} rays differ{}", row.differ, row.agrees ? "" : ": TOO MANY");
  while (text.back() == ' ')
    text.pop_back();
  return text + '\n';
}

std::string rays_text(const Benchmark& benchmark) {
  std::set<int> widths;
  for (const RayTiming& row : benchmark.rays) {
    if (!row.who.empty()) widths.insert(row.width);
  }
  std::string header =
      fmt::format("  {:<16}{:<24}{:<9}{:>9}{:>6}", "layout", "kernel", "isa", "Mrays/s", "±%");
  for (const int width : widths)
    header += fmt::format("{:>8}", fmt::format("/{}", width));
  std::string text;
  for (size_t i = 0; i < benchmark.rays.size(); ++i) {
    const RayTiming& row = benchmark.rays[i];
    if (i == 0 || !is_same_group(row, benchmark.rays[i - 1]))
      text += group_title(row) + header + '\n';
    text += row_text(row, widths);
  }
  return text;
}

std::string legend(const BenchmarkFacts& facts) {
  std::string text =
      "\n±%: half the distance of the quartiles, of the median. One thread: its processor time; "
      "several: the clock.\n";
  for (const PeerRow& peer : facts.peers) {
    text += fmt::format(
        "{} {}, robust{} (a high-quality build of its own is not). /1, /8, /16: ours over its "
        "fastest "
        "kernel of that many rays;\n/peer: its build time over ours. Above 1 ours is faster. B/tri "
        "of {}: what it allocates, with its copy of the mesh.\n",
        peer.label, peer.version, facts.options.fast ? " unless fast" : "", peer.label);
  }
  if (facts.options.fast) {
    text += fmt::format(
        "fast: tests that rays may slip through at edges (ours: Möller and Trumbore, boxes without "
        "margin); up to {} % of\ntheir answers may differ. Their ratios are to fast kernels.\n",
        100.0 * tolerated_share_of_fast);
  }
  if (!facts.missing_peers.empty()) text += fmt::format("{}\n", facts.missing_peers);
  return text;
}

}  // namespace

std::string benchmark_text(const BenchmarkFacts& facts, const Benchmark& benchmark) {
  uint64_t triangles = 0;
  for (const Mesh& mesh : facts.scene.meshes)
    triangles += mesh.triangles.size();
  std::string text = fmt::format(
      "scene    {}: {} triangles in {} meshes, {} instances\n"
      "machine  {}, {} threads, {}\n"
      "median of {} turns\n\n",
      facts.scene.name, triangles, facts.scene.meshes.size(), facts.scene.instances.size(),
      cpu_name(), thread_count(), isa_name(), facts.options.turns);
  text += builds_text(benchmark, !facts.peers.empty());
  text += rays_text(benchmark);
  text += legend(facts);
  for (const std::string& fault : benchmark.faults)
    text += fmt::format("DIFFERENT: {}\n", fault);
  if (!benchmark.complete) text += "Stopped; this is what was measured until then.\n";
  return text;
}

}  // namespace tracer
