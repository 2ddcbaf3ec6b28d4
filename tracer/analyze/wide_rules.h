// What wide_bvh.h promises about a wide tree beside the canonical one it was made from, as rules.
#pragma once

#include "tracer/analyze/tree_rules.h"

namespace tracer {

// Nothing is found where there is no wide tree to check. Each may read what those above it with
// `gate` have found sound, and the canonical tree keeps its own rules with `gate`. Findings are at
// the node of the canonical tree that the slot at fault stands for, else that of its wide node.
void check_wide_links(const TreeToCheck& of, FindingList& found);
void check_wide_subtrees(const TreeToCheck& of, FindingList& found);
void check_wide_boxes(const TreeToCheck& of, FindingList& found);
void check_wide_leaves(const TreeToCheck& of, FindingList& found);
void check_wide_triangles(const TreeToCheck& of, FindingList& found);

inline constexpr TreeRule wide_rules[] = {
    {"wide_links", "Wide nodes make a tree",
     "A wide layout is the one that was asked for; its children come after their parent and are "
     "those of one node only; its depth is as stored and the traversal's stack deep enough; empty "
     "slots are the last, and no ray can hit them.",
     Severity::error, true, check_wide_links},
    {"wide_subtrees", "Wide nodes share out the tree",
     "Every slot of a wide node stands for a node of the binary tree, below the one that the wide "
     "node stands for; each leaf below that is below exactly one slot.",
     Severity::error, true, check_wide_subtrees},
    {"wide_boxes", "Wide boxes as in the tree",
     "Every slot's box is that of the node it stands for; a quantised one contains it.",
     Severity::error, false, check_wide_boxes},
    {"wide_leaves", "Wide leaves own the references",
     "A leaf's blocks of triangles, or entries, follow each other inside the array, are of this "
     "leaf only and hold the references below its node; lanes that are left repeat the last.",
     Severity::error, true, check_wide_leaves},
    {"wide_triangles", "Blocks hold the mesh",
     "The coordinates in the blocks are those of the mesh's triangles.", Severity::error, false,
     check_wide_triangles},
};

}  // namespace tracer
