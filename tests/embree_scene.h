// The same scene in Embree, for tests.
#pragma once

#include "app/peers/embree_scene.h"

namespace tracer::test {

using app::EmbreeScene;

}  // namespace tracer::test
