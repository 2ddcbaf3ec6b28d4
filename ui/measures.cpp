#include "ui/measures.h"

#include <fmt/format.h>

#include "tracer/analyze/quality.h"
#include "ui/registry.h"
#include "ui/widgets.h"
#include "ui/workspace_state.h"

namespace ui {
namespace {

using tracer::Measures;

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100.0 * share);
}

// What stands in the place of a figure that is not known.
std::string missing(const Frame& frame) {
  const Background<Measures>& work = frame.work.measures;
  if (!work.error.empty()) return work.error;
  if (work.running) return "measuring ...";
  return "after the first picture";
}

template <class Value, class Text>
void row(const Frame& frame, const char* label, const std::optional<Value>& value,
         const std::string& help, const Text& text) {
  text_row(label, value ? text(*value) : missing(frame), help.c_str());
}

std::string epo_text(const tracer::Epo& epo) {
  return fmt::format("{:.3f} ± {:.3f}", epo.value, epo.standard_error);
}

void draw_overlap(const Frame& frame, const std::optional<tracer::Overlap>& overlap) {
  row(frame, "Overlap", overlap,
      "How often a random line through an inner node n meets what both children l and r claim: sum "
      "of A(l and r in common) / sum of A(n). A is the surface area of the box.",
      [](const tracer::Overlap& of) { return percent(of.siblings); });
  row(frame, "Empty space", overlap,
      "The part of an inner node that is in neither child, weighted by how often random lines come "
      "by: sum of A(n) (1 - V(l or r) / V(n)) / sum of A(n). V is the volume of the box.",
      [](const tracer::Overlap& of) { return percent(of.empty_space); });
}

void select_instance(Frame& frame, uint32_t instance) {
  frame.state.selection = {};
  frame.state.selection.instance = instance;
}

std::string instance_name(const Frame& frame, uint32_t instance) {
  const auto& instances = frame.snapshot.scene->instances;
  const std::string& name = instances[instance].name;
  return name.empty() ? fmt::format("instance {}", instance) : name;
}

void draw_pair(Frame& frame, const tracer::InstancePair& pair) {
  ImGui::TableNextRow();
  for (const uint32_t instance : {pair.a, pair.b}) {
    ImGui::TableNextColumn();
    const std::string id = std::to_string(instance);
    const Scope scope(id);
    if (ImGui::Selectable(instance_name(frame, instance).c_str(),
                          frame.state.selection.instance == instance)) {
      select_instance(frame, instance);
    }
    mark("Select");
    tooltip(fmt::format("Select instance {}", instance));
  }
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(percent(pair.overlap).c_str());
  tooltip("A(boxes in common) / the smaller A of the two boxes");
}

void draw_pairs(Frame& frame, const tracer::InstanceOverlap& instances) {
  if (instances.worst.empty()) return;
  hint("The pairs that overlap most; a click selects");
  const size_t count = frame.snapshot.scene->instances.size();
  if (!ImGui::BeginTable("pairs", 3, ImGuiTableFlags_RowBg)) return;
  ImGui::TableSetupColumn("a", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("b", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("overlap", ImGuiTableColumnFlags_WidthFixed);
  for (size_t i = 0; i < instances.worst.size(); ++i) {
    const tracer::InstancePair& pair = instances.worst[i];
    if (pair.a >= count || pair.b >= count) continue;
    const Scope scope("pair", i);
    draw_pair(frame, pair);
  }
  ImGui::EndTable();
}

std::string costs(float ct, float ci) {
  return fmt::format(
      "Here Ct is {:.2f} (an inner node: two box tests) and Ci {:.2f} (a triangle "
      "test).",
      ct, ci);
}

}  // namespace

const Measures* blas_measures(const Frame& frame) {
  const auto& result = frame.work.measures.result;
  const auto& bvh = frame.snapshot.bvh;
  if (!result || !result->bvh || !bvh) return nullptr;
  const bool same = result->bvh->blases == bvh->blases &&
                    result->bvh->options.traversal_cost == bvh->options.traversal_cost &&
                    result->bvh->options.intersection_cost == bvh->options.intersection_cost;
  return same ? result.get() : nullptr;
}

const Measures* tlas_measures(const Frame& frame) {
  const auto& result = frame.work.measures.result;
  return result && result->bvh && result->bvh == frame.snapshot.bvh ? result.get() : nullptr;
}

std::string sah_help(float traversal_cost, float intersection_cost) {
  return "Surface area heuristic: the expected cost of a random ray that does not stop. Sum over "
         "inner nodes of A(node) / A(root) Ct, and over leaves of A(node) / A(root) count Ci; A is "
         "the surface area of the box. Unit: the costs. Of several trees the mean, weighted by "
         "triangles; smaller is better. " +
         costs(traversal_cost, intersection_cost);
}

std::string epo_help(float traversal_cost, float intersection_cost) {
  return "End-point overlap (Aila, Karras, Laine 2013): what a ray pays at its ends for boxes that "
         "have nothing to do with the surface there. Sum over nodes n of C(n) A(S without Q(n), "
         "inside box(n)) / A(S); S is all surface, Q(n) that below n, C(n) is Ct for an inner node "
         "and count Ci for a leaf. Unit: the costs, as of SAH; smaller is better. By random points "
         "on the surface; after ± one standard error. " +
         costs(traversal_cost, intersection_cost);
}

void draw_blas_measures(Frame& frame) {
  const Measures none;
  const Measures* known = blas_measures(frame);
  const Measures& measures = known != nullptr ? *known : none;
  const tracer::BuildOptions& options = frame.snapshot.bvh->options;
  row(frame, "EPO", measures.blas_epo, epo_help(options.traversal_cost, options.intersection_cost),
      epo_text);
  row(frame, "SAH by lines", measures.sah_test,
      fmt::format("A self-test of builder, traversal and SAH: random lines through the root of "
                  "mesh {} that never stop, and what they cost on average ± one standard error. "
                  "It has to be what SAH says of this mesh, {:.3f}.",
                  measures.sah_test_mesh, measures.sah_test ? measures.sah_test->sah : 0.0),
      [](const tracer::SahTest& test) {
        return fmt::format("{:.2f} ± {:.2f}, {}", test.measured, test.standard_error,
                           holds(test) ? "as SAH says" : "not what SAH says");
      });
  draw_overlap(frame, measures.blas_overlap);
}

void draw_tlas_measures(Frame& frame) {
  const Measures none;
  const Measures* known = tlas_measures(frame);
  const Measures& measures = known != nullptr ? *known : none;
  const tracer::BuildOptions& options = frame.snapshot.bvh->options;
  row(frame, "EPO", measures.tlas_epo,
      epo_help(options.traversal_cost, options.intersection_cost) +
          " In the top level a leaf costs Ci an instance, and S is the surface of all instances.",
      epo_text);
  draw_overlap(frame, measures.tlas_overlap);
  const tracer::WastedEntries& wasted = frame.snapshot.wasted_entries;
  text_row("In vain",
           wasted.entries > 0 ? percent(share(wasted)) : std::string("after the first picture"),
           "Wasted entries: of the meshes' trees that primary rays entered, the share that did not "
           "give the ray's hit. 1 - hits / entries, over the first pass of the picture.");
  row(frame, "Shared boxes", measures.instances,
      "How many whole neighbours an instance shares its box with: sum over all other instances of "
      "A(boxes in common) / the smaller A of the two, as a mean over the instances. 0 is best.",
      [](const tracer::InstanceOverlap& of) { return fmt::format("{:.2f} instances", of.mean); });
  row(frame, "Neighbours", measures.instances,
      "How many other instances' boxes an instance's box overlaps, however little, on average",
      [](const tracer::InstanceOverlap& of) { return fmt::format("{:.1f}", of.mean_neighbours); });
  if (measures.instances) draw_pairs(frame, *measures.instances);
}

}  // namespace ui
