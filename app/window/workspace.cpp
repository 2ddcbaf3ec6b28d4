#include "app/window/workspace.h"

#include <algorithm>
#include <utility>

#include "app/window/save.h"
#include "tracer/choice.h"
#include "tracer/error.h"
#include "tracer/render/views.h"
#include "tracer/session_file.h"
#include "ui/boxes.h"

namespace app {
namespace {

// What the boxes in the picture depend on beside its snapshot.
tracer::BoxSources box_sources(const Workspace& workspace) {
  if (!workspace.edited.view.boxes.show) return {};
  return tracer::needed(workspace.edited.view.boxes,
                        ui::box_sources(workspace.state, work_of(workspace.background)));
}

void have_painted(Workspace& workspace) {
  if (workspace.snapshot->film.tiles.empty()) return;  // the last picture stays until there is one
  workspace.painted_view = workspace.edited.view;
  workspace.painted_boxes = box_sources(workspace);
  workspace.painter.submit(workspace.snapshot, workspace.edited.view, workspace.painted_boxes);
}

// Refining changes the radiance alone; the other views have nothing new to show then.
bool shows_change(const tracer::ViewOptions& view, const tracer::Film& was,
                  const tracer::Film& now) {
  const tracer::ViewRow* row = tracer::find_row(tracer::views(), view.view);
  const bool radiance = row != nullptr && row->kind == tracer::ViewKind::radiance;
  return !std::equal(was.tiles.begin(), was.tiles.end(), now.tiles.begin(), now.tiles.end(),
                     [&](const auto& a, const auto& b) {
                       return a == b || (!radiance && a && b && a->facts == b->facts);
                     });
}

void receive_picture(Workspace& workspace) {
  const std::shared_ptr<const Painting> painting = workspace.painter.painting();
  if (painting == workspace.painting) return;
  if (painting->picture && painting->picture != workspace.painting->picture) {
    workspace.texture.upload(painting->picture->image);
  }
  workspace.painting = painting;
  if (painting->error != workspace.paint_error && !painting->error.empty()) {
    ui::post(workspace.state, ui::Severity::error, painting->error);
  }
  workspace.paint_error = painting->error;
}

void receive_messages(Workspace& workspace) {
  for (ChoreResult& result : workspace.chores.take_results()) {
    if (result.message.empty()) continue;
    const ui::Severity severity = result.failed ? ui::Severity::error : ui::Severity::info;
    ui::post(workspace.state, severity, std::move(result.message));
  }
}

void open_session(Workspace& workspace, const std::string& name) {
  tracer::SavedSession saved = tracer::read_session(name);
  const bool same_scene = saved.settings.source == workspace.edited.settings.source;
  if (!same_scene) {
    // Clears what belongs to the scene before; the session's own look is then put in.
    ui::open_scene(workspace.edited, workspace.state, saved.settings.source);
  }
  workspace.edited.settings = std::move(saved.settings);
  workspace.edited.view = std::move(saved.view);
  for (std::string& warning : saved.warnings) {
    ui::post(workspace.state, ui::Severity::warning, std::move(warning));
  }
}

template <class Action>
void attempt(Workspace& workspace, const Action& action) {
  try {
    action();
  } catch (const tracer::Error& error) {
    ui::post(workspace.state, ui::Severity::error, error.what());
  }
}

}  // namespace

void receive(Workspace& workspace) {
  const std::shared_ptr<const tracer::Snapshot> snapshot = workspace.session.snapshot();
  const bool changed =
      shows_change(workspace.edited.view, workspace.snapshot->film, snapshot->film);
  workspace.snapshot = snapshot;
  ui::adopt(workspace.edited, workspace.state, *snapshot);
  if (changed) have_painted(workspace);
  keep_measured(workspace.background, *snapshot);
  drop_stale(workspace.background, *snapshot, workspace.edited.settings);
  receive_picture(workspace);
  receive_messages(workspace);
}

void send(Workspace& workspace) {
  if (workspace.submitted != workspace.edited.settings) {
    workspace.submitted = workspace.edited.settings;
    workspace.session.submit(workspace.edited.settings);
    drop_stale(workspace.background, *workspace.snapshot, workspace.edited.settings);
  }
  if (workspace.painted_view != workspace.edited.view ||
      workspace.painted_boxes != box_sources(workspace)) {
    have_painted(workspace);
  }
}

void open(Workspace& workspace, const std::string& name) {
  attempt(workspace, [&] {
    if (tracer::is_session_file(name)) {
      open_session(workspace, name);
    } else {
      ui::open_scene(workspace.edited, workspace.state, tracer::parse_scene_source(name));
    }
  });
}

void carry_out(Workspace& workspace) {
  const bool screenshot = workspace.requests.screenshot;
  const ui::Requests requests = std::exchange(workspace.requests, {});
  workspace.requests.screenshot = screenshot;
  if (requests.open) open(workspace, *requests.open);
  if (requests.open_session) {
    attempt(workspace, [&] { open_session(workspace, *requests.open_session); });
  }
  if (requests.save_picture) {
    workspace.chores.add([snapshot = workspace.snapshot, view = workspace.edited.view,
                          boxes = box_sources(workspace), file = *requests.save_picture] {
      return save_picture(snapshot, view, boxes, file);
    });
  }
  if (requests.save_session) {
    const tracer::SavedSession session{workspace.edited.settings, workspace.edited.view};
    workspace.chores.add([session, file = *requests.save_session] {
      tracer::write_session(file, session);
      return "Saved the session as " + file;
    });
  }
  carry_out(workspace.background, requests, *workspace.snapshot);
  keep_inspected(workspace.background, requests, *workspace.snapshot);
  keep_logged(workspace.background, requests, *workspace.snapshot);
  if (requests.measure_timeline) {
    start_timeline(workspace.background, *workspace.snapshot, workspace.edited.settings,
                   *requests.measure_timeline);
  }
  if (requests.cancel) workspace.session.cancel();
  if (requests.quit) workspace.closing = true;
}

}  // namespace app
