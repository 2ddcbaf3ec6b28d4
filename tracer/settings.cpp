// From a scene to what can be edited of it.
#include "tracer/settings.h"

namespace tracer {

Look look_of(const Scene& scene) {
  return {scene.materials, scene.lights, scene.sky, scene.ambient, scene.camera};
}

}  // namespace tracer
