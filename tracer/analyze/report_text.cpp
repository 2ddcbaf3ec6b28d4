// The report as an aligned table for terminals, a column a build.
#include <fmt/format.h>

#include "tracer/analyze/report.h"

namespace tracer {
namespace {

using Cell = std::string (*)(const Json& value);

std::string whole(const Json& value) {
  const std::string digits = std::to_string(value.get<uint64_t>());
  std::string grouped;
  for (size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) grouped += ',';
    grouped += digits[i];
  }
  return grouped;
}
std::string two_decimals(const Json& value) {
  return fmt::format("{:.2f}", value.get<double>());
}
std::string three_decimals(const Json& value) {
  return fmt::format("{:.3f}", value.get<double>());
}
std::string percent(const Json& value) {
  return fmt::format("{:.1f}", 100.0 * value.get<double>());
}
std::string text(const Json& value) {
  return value.get<std::string>();
}
std::string kernel(const Json& value) {
  const std::string id = text(value);
  return id == automatic_kernel ? id : id + ", chosen";
}

struct Line {
  std::string_view label;
  std::string_view pointer;  // into an entry of "builds"
  Cell cell;
};

constexpr Line build_lines[] = {
    {"layout", "/layout", text},
    {"build, ms", "/build_ms", two_decimals},
    {"nodes", "/nodes", whole},
    {"leaves", "/leaves", whole},
    {"references", "/references", whole},
    {"deepest leaf, edges", "/max_depth", whole},
    {"mean leaf depth, edges", "/mean_leaf_depth", two_decimals},
    {"largest leaf, references", "/max_leaf_size", whole},
    {"bytes per triangle", "/bytes_per_triangle", two_decimals},
    {"SAH", "/sah", two_decimals},
    {"  cost of an inner node, Ct", "/sah_traversal_cost", two_decimals},
    {"  cost of a triangle, Ci", "/sah_intersection_cost", two_decimals},
    {"EPO, same costs", "/epo", two_decimals},
    {"  standard error", "/epo_standard_error", three_decimals},
    {"overlap of siblings, %", "/overlap", percent},
    {"empty space in inner nodes, %", "/empty_space", percent},
    {"top level: nodes", "/tlas_nodes", whole},
    {"top level: deepest leaf", "/tlas_max_depth", whole},
    {"top level: SAH", "/tlas_sah", two_decimals},
    {"top level: EPO", "/tlas_epo", two_decimals},
    {"top level: overlap, %", "/tlas_overlap", percent},
    {"  neighbours of an instance", "/tlas_overlapping_neighbours", two_decimals},
    {"  BLASes entered in vain, %", "/tlas_wasted_entries", percent},
};

constexpr Line update_lines[] = {
    {"update", "/strategy", text},
    {"  deform, ms", "/deform_ms", two_decimals},
    {"  refit, ms", "/refit_ms", two_decimals},
    {"  growth of nodes, mean", "/growth_mean", two_decimals},
    {"  growth of nodes, most", "/growth_max", two_decimals},
};

constexpr Line ray_lines[] = {
    {"  count", "/count", whole},
    {"  nodes per ray, mean", "/nodes/mean", two_decimals},
    {"  nodes per ray, median", "/nodes/p50", two_decimals},
    {"  nodes per ray, 95 %", "/nodes/p95", two_decimals},
    {"  nodes per ray, 99 %", "/nodes/p99", two_decimals},
    {"  nodes per ray, most", "/nodes/max", two_decimals},
    {"  triangle tests per ray, mean", "/triangles/mean", two_decimals},
    {"  triangle tests per ray, 99 %", "/triangles/p99", two_decimals},
    {"  Mrays/s, all threads", "/mrays_per_s", two_decimals},
    {"  kernel", "/kernel", kernel},
    {"  in packets, %", "/in_packets", percent},
    {"  in streams, %", "/in_streams", percent},
};

void add_line(std::string& out, const Json& builds, const Line& line, const std::string& prefix) {
  out += fmt::format("{:<32}", line.label);
  for (const Json& build : builds) {
    const Json::json_pointer pointer(prefix + std::string(line.pointer));
    out += fmt::format("{:>16}", line.cell(build.at(pointer)));
  }
  out += '\n';
}

// The fit over the builds, if there are several; predicted and measured cost below their columns.
void add_blend(std::string& out, const Json& report) {
  if (!report.contains("blend")) return;
  const Json& blend = report.at("blend");
  out += "\nSAH-EPO blend, fitted to the cost of primary rays\n";
  if (blend.is_null()) {
    out += "  needs at least three builds that differ\n";
    return;
  }
  out += fmt::format(
      "  cost = {:.3f} ({:.2f} SAH + {:.2f} EPO), mean error {:.1f} %, correlation {:.4f}\n",
      blend.at("scale").get<double>(), 1.0 - blend.at("alpha").get<double>(),
      blend.at("alpha").get<double>(), blend.at("mean_absolute_percentage_error").get<double>(),
      blend.at("correlation").get<double>());
  add_line(out, blend.at("builds"), {"  predicted cost of a ray", "/predicted", two_decimals}, "");
  add_line(out, blend.at("builds"), {"  measured cost of a ray", "/measured", two_decimals}, "");
}

}  // namespace

std::string report_text(const Json& report) {
  const Json& scene = report.at("scene");
  const Json& settings = report.at("settings");
  const Json& builds = report.at("builds");
  const Json& machine = report.at("machine");
  std::string out = fmt::format(
      "scene    {}: {} triangles in {} meshes, {} instances, {} triangles as placed\n"
      "picture  {} x {}, ray depth {}, {} tests\n"
      "machine  {}, {} threads, {}\n\n",
      text(scene.at("name")), whole(scene.at("triangles")), whole(scene.at("meshes")),
      whole(scene.at("instances")), whole(scene.at("instanced_triangles")),
      whole(settings.at("width")), whole(settings.at("height")), whole(settings.at("depth")),
      text(settings.at("tests")), text(machine.at("cpu")), whole(machine.at("threads")),
      text(machine.at("isa")));

  add_line(out, builds, {"builder", "/builder", text}, "");
  for (const Line& line : build_lines)
    add_line(out, builds, line, "");
  if (builds.at(0).at("update").at("deformed") == true) {
    for (const Line& line : update_lines)
      add_line(out, builds, line, "/update");
  }
  for (const auto& [ray_class, rays] : builds.at(0).at("rays").items()) {
    if (rays.at("count") == 0) continue;
    out += fmt::format("\n{} rays\n", ray_class);
    for (const Line& line : ray_lines)
      add_line(out, builds, line, "/rays/" + ray_class);
  }
  add_blend(out, report);
  return out;
}

}  // namespace tracer
