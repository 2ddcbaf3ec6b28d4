// The boxes of nodes drawn into a picture: lines and faces, seen by the film's own camera and held
// against its hits, so that they never swim and what is behind a surface is faded.
#pragma once

#include "tracer/analyze/box_set.h"
#include "tracer/render/colorize.h"

namespace tracer {

// What the colours of the boxes ask for, computed here: for pictures without a window.
BoxSources box_sources(const Snapshot& snapshot, const BoxOptions& options, const Job& job);

// Draws `boxes` over the picture of a snapshot and says so in picture.boxes. The same for any
// number of threads. Boxes of another BVH than the snapshot's are not drawn.
void draw_boxes(Picture& picture, const Snapshot& snapshot, const NodeBoxes& boxes,
                const BoxOptions& options);

// The colours of the boxes with their numbers, into the lower right; nothing if it is too small.
void draw_box_legend(Picture& picture, const BoxOptions& options);

}  // namespace tracer
