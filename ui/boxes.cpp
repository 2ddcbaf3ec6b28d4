#include "ui/boxes.h"

namespace ui {

tracer::BoxSources box_sources(const UiState& state, const Work& work) {
  tracer::BoxSources sources;
  sources.inspection = work.inspection.result;
  sources.visits = work.visits.result;
  sources.measures = work.measures.result;
  sources.selected = state.selection.node;
  sources.instance = state.selection.instance;
  sources.isolated = state.box_filter.isolated;
  sources.hidden = state.box_filter.hidden;
  return sources;
}

void request_box_facts(Frame& frame) {
  const tracer::BoxOptions& boxes = frame.edited.view.boxes;
  if (!boxes.show) return;
  frame.requests.inspect = true;
  if (tracer::needs_visits(boxes)) frame.requests.count_visits = true;
}

}  // namespace ui
