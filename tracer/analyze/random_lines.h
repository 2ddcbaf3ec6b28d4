// Lines spread evenly over all that meet a box: what the surface area heuristic is about.
#pragma once

#include "tracer/math/box.h"
#include "tracer/math/ray.h"
#include "tracer/math/rng.h"

namespace tracer {

// A ray that begins on the box and goes through it: evenly spread over the surface, the cosine of
// the angle to the face's normal evenly squared, so that (Cauchy, Crofton) any convex body inside
// is met with the probability of its surface over the box's. face_share, 0..1, chooses the face. A
// box without area gives a ray without direction.
Ray random_line(const Box& box, double face_share, Rng& rng);

}  // namespace tracer
