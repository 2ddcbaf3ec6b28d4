// Sentences about steps.
#include "tracer/analyze/ray_words.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tracer {
namespace {

constexpr size_t most_listed = 12;  // nodes of the stack that are written out

bool is_box(const Step& step) {
  return step.kind == StepKind::node || step.kind == StepKind::leaf;
}

// Whether the node had waited on the stack until the step.
bool has_waited(const LoggedRay& ray, size_t step) {
  const Step& now = ray.steps[step];
  // The stack of the same tree before: instances in between have their own.
  for (size_t before = step; before-- > 0;) {
    const Step& last = ray.steps[before];
    if (last.instance != now.instance) continue;
    return is_box(now) && !last.stack.empty() && last.stack.back() == now.id &&
           (now.stack.empty() || now.stack.back() != now.id);
  }
  return false;
}

// Nothing has been hit: t_best is where the ray ends.
bool ends_at(const LoggedRay& ray, const Step& step) {
  return step.t_best == ray.cast.ray.t_max;
}

std::string best_words(const LoggedRay& ray, const Step& step) {
  if (!ends_at(ray, step)) return fmt::format("the nearest hit so far is at t {:.4g}", step.t_best);
  if (step.t_best == infinity) return "nothing has been hit yet";
  return fmt::format("nothing has been hit yet before the ray's end at t {:.4g}", step.t_best);
}

std::string place_words(const SceneBvh& bvh, const Step& step) {
  if (step.instance == none) return "the TLAS";
  return fmt::format("mesh {}, instance {}", bvh.instances[step.instance].mesh, step.instance);
}

std::string span_words(const Step& step) {
  return fmt::format("from t {:.4g} to {:.4g}", step.t_entry, step.t_exit);
}

// Of a child that is taken up, or waits.
std::string child_words(const LoggedRay& ray, const TestedChild& child) {
  if (child.order == ChildOrder::first) {
    return fmt::format("{} comes first, at t {:.4g}", child.node, ray.steps[child.step].t_entry);
  }
  if (child.step == none) return fmt::format("{} waits until the ray has ended", child.node);
  const Step& later = ray.steps[child.step];
  return fmt::format("{} waits, at t {:.4g}, until step {} {} it", child.node, later.t_entry,
                     child.step + 1, later.result == StepResult::entered ? "enters" : "drops");
}

// "3, 4 are missed".
std::string dropped_words(const std::vector<uint32_t>& nodes, std::string_view why) {
  return fmt::format("{} {} {}", fmt::join(nodes, ", "), nodes.size() == 1 ? "is" : "are", why);
}

std::string children_words(const LoggedRay& ray, size_t step) {
  const std::vector<TestedChild> children = tested_children(ray, step);
  if (children.empty()) return "";
  std::vector<std::string> parts;
  std::vector<uint32_t> missed, too_far;
  for (const ChildOrder order : {ChildOrder::first, ChildOrder::waits}) {
    for (const TestedChild& child : children)
      if (child.order == order) parts.push_back(child_words(ray, child));
  }
  const bool none_left = parts.empty();
  for (const TestedChild& child : children) {
    if (child.order != ChildOrder::dropped) continue;
    const bool passed = ray.steps[child.step].result == StepResult::missed;
    (passed ? missed : too_far).push_back(child.node);
  }
  if (!missed.empty()) parts.push_back(dropped_words(missed, "missed"));
  if (!too_far.empty()) parts.push_back(dropped_words(too_far, "too far away"));
  return fmt::format("Of its children {}.{}", fmt::join(parts, "; "),
                     none_left ? " The next one comes from the stack." : "");
}

std::string stack_words(const Step& step) {
  if (step.stack.empty()) return "Nothing waits in this tree.";
  std::string text;
  size_t listed = 0;
  for (auto node = step.stack.rbegin(); node != step.stack.rend() && listed < most_listed; ++node) {
    text += (listed++ > 0 ? ", " : "") + std::to_string(*node);
  }
  if (listed < step.stack.size()) text += fmt::format(" and {} more", step.stack.size() - listed);
  return "Waiting, the next one first: " + text + ".";
}

std::string box_words(const SceneBvh& bvh, const LoggedRay& ray, size_t index) {
  const Step& step = ray.steps[index];
  switch (step.result) {
    case StepResult::missed:
      return "Missed: the ray has left one pair of its box's sides before it enters another.";
    case StepResult::behind:
      return fmt::format(
          "{}: the ray enters its box at t {:.4g}, behind {} at t {:.4g}.",
          has_waited(ray, index) ? "Dropped from the stack" : "Dropped", step.t_entry,
          ends_at(ray, step) ? "its own end" : "the nearest hit so far", step.t_best);
    default:
      break;
  }
  std::string text =
      is_untested(bvh, ray, index)
          ? fmt::format("Entered: this layout does not test the {} box; {}.",
                        step.id == 0 ? "root's" : "first node's", best_words(ray, step))
          : fmt::format("Entered{}: the ray is in its box {}; {}.",
                        has_waited(ray, index) ? " from the stack" : "", span_words(step),
                        best_words(ray, step));
  if (step.kind == StepKind::node) return text + " " + children_words(ray, index);
  const Bvh& tree =
      step.instance == none ? bvh.tlas : bvh.blases[bvh.instances[step.instance].mesh]->tree;
  const uint32_t count = references_below(tree, step.id);
  const std::string_view what = step.instance != none ? "triangle"
                                : bvh.entries.empty() ? "instance"
                                                      : "part";
  return text + fmt::format(" It has {} {}{}.", count, what, count == 1 ? "" : "s");
}

std::string triangle_words(const LoggedRay& ray, const Step& step) {
  if (step.result == StepResult::tested) return "Tested: the ray does not hit it.";
  if (ray.cast.ray_class == RayClass::shadow) {
    return fmt::format("Hit at t {:.4g}: that is enough, the light is hidden.", step.t_entry);
  }
  return fmt::format("Hit at t {:.4g}: what begins behind it is dropped from now on.",
                     step.t_entry);
}

}  // namespace

std::vector<TestedChild> tested_children(const LoggedRay& ray, size_t step) {
  const Step& parent = ray.steps[step];
  std::vector<TestedChild> children;
  for (const uint32_t node : parent.children)
    children.push_back({node, ChildOrder::waits, none});
  size_t left = children.size();
  bool taken = false;
  // A node is tested once in an instance: where one is entered more often, it is at other nodes,
  // none of which is below another.
  for (size_t i = step + 1; i < ray.steps.size() && left > 0; ++i) {
    const Step& later = ray.steps[i];
    if (!is_box(later) || later.instance != parent.instance) continue;
    const auto child = std::find_if(children.begin(), children.end(),
                                    [&](const TestedChild& one) { return one.node == later.id; });
    if (child == children.end()) continue;
    --left;
    child->step = static_cast<uint32_t>(i);
    const bool waited = has_waited(ray, i);
    if (later.result != StepResult::entered) {
      if (!waited) child->order = ChildOrder::dropped;
    } else if (!waited && !taken) {
      child->order = ChildOrder::first;
      taken = true;
    }
  }
  return children;
}

bool is_untested(const SceneBvh& bvh, const LoggedRay& ray, size_t step) {
  if (bvh.options.layout == "binary") return false;
  const Step& now = ray.steps[step];
  // A root that is a leaf stands in a slot, which is tested.
  if (now.id == 0) return now.kind == StepKind::node;
  return step > 0 && ray.steps[step - 1].kind == StepKind::instance;
}

std::string what(const Step& step) {
  return fmt::format("{} {}", name(step.kind), step.id);
}

std::string why(const LoggedRay& ray, size_t index) {
  const Step& step = ray.steps[index];
  switch (step.result) {
    case StepResult::entered:
      if (step.kind == StepKind::instance) {
        return step.from == 0
                   ? "the ray goes on in its own space"
                   : fmt::format("the ray goes on in its own space, from node {}", step.from);
      }
      return has_waited(ray, index) ? "from the stack" : "";
    case StepResult::missed:
      return "the ray passes its box by";
    case StepResult::behind:
      if (has_waited(ray, index)) return "something nearer was hit while it waited";
      return ends_at(ray, step) ? "it begins behind the ray's end"
                                : "it begins behind the nearest hit";
    case StepResult::tested:
      return "not hit";
    case StepResult::hit:
      return ray.cast.ray_class == RayClass::shadow ? "any hit is enough" : "the nearest so far";
  }
  return "";
}

std::string explain(const SceneBvh& bvh, const LoggedRay& ray, size_t index) {
  const Step& step = ray.steps[index];
  std::string text;
  if (step.kind == StepKind::instance) {
    const uint32_t mesh = bvh.instances[step.id].mesh;
    return fmt::format(
        "Instance {}, of mesh {}. Its box in the TLAS is entered, so the ray goes on in the "
        "instance's own space, from {} of the mesh's tree.",
        step.id, mesh, step.from == 0 ? "the root" : fmt::format("node {}", step.from));
  }
  text = fmt::format("{} of {}, depth {}. ", what(step), place_words(bvh, step), step.depth);
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  text += step.kind == StepKind::triangle ? triangle_words(ray, step) : box_words(bvh, ray, index);
  return text + " " + stack_words(step);
}

std::string hit_words(const CastRay& cast) {
  if (is_hit(cast.hit)) {
    return fmt::format("t {:.4g}, instance {}, triangle {}", cast.hit.t, cast.hit.instance,
                       cast.hit.triangle);
  }
  return cast.ray_class == RayClass::shadow ? "nothing: the light is seen" : "nothing: the sky";
}

}  // namespace tracer
