// The workspace in a window: what `bvhscope [SCENE]` opens.
#pragma once

#include "tracer/settings.h"

namespace app {

struct WorkspaceOptions {
  tracer::Settings settings;  // source, build options, ... of the first scene
  tracer::ViewOptions view;
  int width = 1600;  // of the window, in points: pixels at scale 1
  int height = 900;
  float scale = 0.0f;    // of text and controls, 0.5..4; 0: what the screen asks for
  int frames = 0;        // closes the window after so many drawn frames; 0: when the user does
  bool timings = false;  // prints the frame times to standard output at the end
};

// Runs until the window is closed; gives the exit status. Without a display or OpenGL 3.3 it prints
// one sentence to standard error and gives 1.
int run_workspace(const WorkspaceOptions& options);

// False if there is neither an X nor a Wayland display to open a window on.
bool has_display();

}  // namespace app
