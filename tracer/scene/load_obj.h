// Wavefront OBJ and MTL, through tinyobjloader, hardened.
#pragma once

#include <filesystem>

#include "tracer/scene/scene.h"

namespace tracer {

// One mesh and one identity instance per file, one material per usemtl name in use (grey where no
// MTL file defines it; "default" for faces before any). Textures and MTL files are looked for
// beside the file and below. Missing normals are smoothed up to a crease of 50 degrees; smoothing
// groups are not read. What is bad is left out, counted and told in Scene::warnings. Throws Error
// ("file: ...") when nothing is left to show.
Scene load_obj(const std::filesystem::path& file, const Job& job);

}  // namespace tracer
