// What the shared options say, as settings, view and camera.
#pragma once

#include "app/commands/scene_options.h"
#include "tracer/session_file.h"

namespace app {

// The settings and the view: of the session file if the scene is one, changed by what was typed.
// The camera is left to place_camera. Throws UsageError for what cannot be meant, tracer::Error for
// an unreadable session.
tracer::SavedSession resolve(const SceneOptions& options);

// Whether a camera was typed, and the scene's camera changed by it.
bool has_camera(const SceneOptions& options);
tracer::Camera placed(const SceneOptions& options, tracer::Camera camera);

// Puts the typed camera into settings.look. Loads the scene for it if the settings bring no look.
void place_camera(const SceneOptions& options, tracer::Settings& settings);

}  // namespace app
