// bvhscope list: the tables that the user can choose from.
#include <fmt/format.h>

#include "app/commands/command.h"
#include "tracer/analyze/box_set.h"
#include "tracer/analyze/ray_sets.h"
#include "tracer/bvh/counters.h"
#include "tracer/bvh/ray_kernels.h"
#include "tracer/bvh/scene_bvh.h"
#include "tracer/bvh/update.h"
#include "tracer/choice.h"
#include "tracer/render/colormap.h"
#include "tracer/render/tone_map.h"
#include "tracer/render/views.h"
#include "tracer/scene/builtin.h"
#include "tracer/scene/deform.h"
#include "tracer/scene/motion.h"

namespace app {
namespace {

template <class Row>
void write_rows(std::ostream& out, std::span<const Row> rows) {
  for (const Row& row : rows)
    out << fmt::format("{:<16}{:<22}{}\n", row.id, row.label, row.help);
}

void write_scenes(std::ostream& out) {
  for (const tracer::BuiltinSceneRow& scene : tracer::builtin_scenes()) {
    out << fmt::format("{:<16}{:<22}{}\n", scene.id, scene.label, scene.help);
    for (const tracer::SceneParameterRow& parameter : scene.parameters) {
      out << fmt::format("  {:<14}{:<22}{} ({} to {}, default {})\n", parameter.id, parameter.label,
                         parameter.help, parameter.min, parameter.max, parameter.default_value);
    }
  }
}

void write_deformers(std::ostream& out) {
  for (const tracer::DeformerRow& row : tracer::deformers()) {
    out << fmt::format("{:<16}{:<22}{}\n", row.id, row.label, row.help);
    if (row.deform != nullptr) out << fmt::format("{:<38}amount: {}\n", "", row.amount);
  }
}

struct ListRow {
  std::string_view id;
  void (*write)(std::ostream& out);
};

constexpr ListRow lists[] = {
    {"scenes", write_scenes},
    {"builders", [](std::ostream& out) { write_rows(out, tracer::builders()); }},
    {"optimizers", [](std::ostream& out) { write_rows(out, tracer::optimizers()); }},
    {"deformers", write_deformers},
    {"motions", [](std::ostream& out) { write_rows(out, tracer::motions()); }},
    {"updates", [](std::ostream& out) { write_rows(out, tracer::updates()); }},
    {"layouts", [](std::ostream& out) { write_rows(out, tracer::layouts()); }},
    {"widenings", [](std::ostream& out) { write_rows(out, tracer::widenings()); }},
    {"occlusion-orders", [](std::ostream& out) { write_rows(out, tracer::occlusion_orders()); }},
    {"kernels", [](std::ostream& out) { write_rows(out, tracer::ray_kernels()); }},
    {"isas", [](std::ostream& out) { write_rows(out, tracer::isas()); }},
    {"bench-classes", [](std::ostream& out) { write_rows(out, tracer::ray_set_rows()); }},
    {"views", [](std::ostream& out) { write_rows(out, tracer::views()); }},
    {"counters", [](std::ostream& out) { write_rows(out, tracer::counters()); }},
    {"ray-classes",
     [](std::ostream& out) {
       out << fmt::format("{:<16}{:<22}{}\n", "all", "All rays", "The four classes together");
       write_rows(out, tracer::ray_classes());
     }},
    {"colormaps", [](std::ostream& out) { write_rows(out, tracer::colormaps()); }},
    {"box-sets", [](std::ostream& out) { write_rows(out, tracer::box_sets()); }},
    {"box-trees", [](std::ostream& out) { write_rows(out, tracer::box_trees()); }},
    {"node-measures", [](std::ostream& out) { write_rows(out, tracer::node_measures()); }},
    {"tone-maps", [](std::ostream& out) { write_rows(out, tracer::tone_maps()); }},
};

}  // namespace

void add_list(CLI::App& command, CommandContext& context) {
  const std::string known = tracer::known_ids(std::span<const ListRow>(lists));
  auto what = std::make_shared<std::string>();
  command.add_option("what", *what, "One of: " + known);
  command.callback([what, known, &context] {
    if (what->empty()) throw UsageError("list what? One of: " + known);
    const ListRow* list = tracer::find_row(std::span<const ListRow>(lists), *what);
    if (list == nullptr) throw UsageError("unknown list '" + *what + "'; known: " + known);
    list->write(context.out);
  });
}

}  // namespace app
