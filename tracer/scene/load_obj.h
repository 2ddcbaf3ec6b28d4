// Wavefront OBJ and MTL, through tinyobjloader, hardened.
#pragma once

#include <filesystem>

#include "tracer/scene/scene.h"

namespace tracer {

// One mesh and one identity instance per file, one material per MTL entry in use (plus "default").
// Textures are looked for beside the file. Throws Error ("file:line: ...") when nothing is left to
// show.
Scene load_obj(const std::filesystem::path& file, const Job& job);

}  // namespace tracer
