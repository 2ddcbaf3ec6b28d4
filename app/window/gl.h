// OpenGL as the program uses it: what is loaded, checked and read back.
#pragma once

#include <glad/gl.h>

#include "tracer/render/colorize.h"

namespace app {

// Loads the functions of the current context. Throws tracer::Error below OpenGL 3.3. Builds without
// NDEBUG print what the driver reports through KHR_debug to standard error.
void load_gl(GLADloadfunc get_address);

// The pixels of the framebuffer that is bound for reading.
tracer::Image read_framebuffer(int width, int height);

}  // namespace app
