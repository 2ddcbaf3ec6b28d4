// What bvh.h and scene_bvh.h promise about one tree, as rules that can be checked.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/bvh/scene_bvh.h"

namespace tracer {

enum class Severity : uint8_t { error, warning };
std::string_view name(Severity severity);

// Where a rule does not hold; `none` for what does not apply.
struct Finding {
  std::string_view rule;  // its id
  Severity severity = Severity::error;
  uint32_t bvh = none;  // mesh whose BLAS it is; none: the TLAS
  uint32_t node = none;
  uint32_t triangle = none;  // of the mesh
  std::string message;
};

// A tree and what it should be built over.
struct TreeToCheck {
  const Bvh& tree;
  std::span<const Box> boxes;  // by primitive
  const BuildOptions& options;
  const Mesh* mesh = nullptr;  // nullptr: the TLAS
  const Blas* blas = nullptr;
  uint32_t id = none;               // of the mesh
  const WideTree* wide = nullptr;   // nullptr: only the canonical tree is checked
  const SceneBvh* scene = nullptr;  // of the TLAS: where its instances are entered
};

inline constexpr size_t max_findings = 20;  // a rule and tree; one more says how many are left out

// Findings of one rule in one tree.
class FindingList {
 public:
  FindingList(std::string_view rule, Severity severity, const TreeToCheck& of)
      : rule_(rule), severity_(severity), of_(of) {}

  // primitive: triangle or instance. message() is called for the first findings only.
  template <class Message>
  void add(uint32_t node, uint32_t primitive, const Message& message) {
    if (++count_ > max_findings) return;
    const uint32_t triangle = of_.mesh != nullptr ? primitive : none;
    found_.push_back({rule_, severity_, of_.id, node, triangle, message()});
  }
  std::vector<Finding> take();

 private:
  std::string_view rule_;
  Severity severity_;
  const TreeToCheck& of_;
  size_t count_ = 0;
  std::vector<Finding> found_;
};

// Calls visit(node, slot) for every slot of `references` that a leaf owns.
template <class Visit>
void for_each_reference(const Bvh& tree, const Visit& visit) {
  for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
    const BvhNode& node = tree.nodes[i];
    for (uint32_t k = 0; k < node.count; ++k)
      visit(i, node.first + k);
  }
}

// After a broken rule with `gate` the others would read outside the arrays: they are left out, and
// nothing may walk the tree.
struct TreeRule {
  std::string_view id, label, help;
  Severity severity;
  bool gate;
  void (*check)(const TreeToCheck&, FindingList&);
};
std::span<const TreeRule> tree_rules();

struct TreeVerdict {
  std::vector<Finding> findings;
  bool walkable = true;
};
TreeVerdict check_tree(const TreeToCheck& tree);

}  // namespace tracer
