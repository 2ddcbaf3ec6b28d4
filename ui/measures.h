// The rows of the Build panel about measures that take longer than a picture.
#pragma once

#include "ui/workspace.h"

namespace ui {

// What is known of the snapshot's trees; nullptr: nothing. The figures of an older tree are not
// shown under a newer one.
const tracer::Measures* blas_measures(const Frame& frame);
const tracer::Measures* tlas_measures(const Frame& frame);

// Rows with definitions as tooltips; "measuring ..." where a figure is not known yet.
void draw_blas_measures(Frame& frame);
void draw_tlas_measures(Frame& frame);

// For tooltips: definition, unit, and the costs that the figure was made with.
std::string sah_help(float traversal_cost, float intersection_cost);
std::string epo_help(float traversal_cost, float intersection_cost);

}  // namespace ui
