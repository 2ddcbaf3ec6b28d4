// The workspace's moving parts: what the user edits, the threads that follow, and what connects
// them once a frame.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "app/window/background_work.h"
#include "app/window/chores.h"
#include "app/window/gl_picture.h"
#include "app/window/painter.h"
#include "app/window/session.h"
#include "ui/workspace_state.h"

namespace app {

// Lives while its OpenGL context is current.
struct Workspace {
  explicit Workspace(const std::function<void()>& wake)
      : chores(wake), painter(wake), session(wake), background(session, wake) {}

  ui::Edited edited;
  ui::UiState state;
  ui::Requests requests;

  std::shared_ptr<const tracer::Snapshot> snapshot = std::make_shared<tracer::Snapshot>();
  std::shared_ptr<const Painting> painting = std::make_shared<Painting>();
  GlPicture texture;
  bool closing = false;

  // What has been handed on, to see what is new.
  std::optional<tracer::Settings> submitted;
  std::optional<tracer::ViewOptions> painted_view;
  tracer::BoxSources painted_boxes;
  std::string paint_error;

  Chores chores;
  Painter painter;
  Session session;
  BackgroundWork background;  // after the session, which it pauses
};

// Takes over what the threads have made; before the panels are drawn.
void receive(Workspace& workspace);

// Hands on what the user has edited; after the panels were drawn.
void send(Workspace& workspace);

// Carries out what the user has asked for and clears it, but for the screenshot.
void carry_out(Workspace& workspace);

// Opens a scene as named on the command line, or a session file. A message if that is impossible.
void open(Workspace& workspace, const std::string& name);

}  // namespace app
