// How hands move the camera: pure functions, angles in radians, lengths in world units.
#pragma once

#include "tracer/scene/camera.h"

namespace ui {

// About the target; `right` and `up` are how far the view turns. Stops short of the poles.
tracer::Camera orbit(tracer::Camera camera, float right, float up);

// Turns the head: the eye stays, the target moves.
tracer::Camera look_around(tracer::Camera camera, float right, float up);

// So that what is at the target's distance follows the mouse by `pixels` of a picture that is
// `height` pixels high.
tracer::Camera pan(tracer::Camera camera, tracer::vec2 pixels, int height);

// Moves eye and target towards a point (factor < 1) or away from it; the point stays where it is in
// the picture. Eye and target stay at least `nearest` apart.
tracer::Camera zoom_at(const tracer::Camera& camera, tracer::vec3 point, float factor,
                       float nearest);

// `move` is in the camera's frame: right, up (the world's), forward.
tracer::Camera fly(tracer::Camera camera, tracer::vec3 move);

// The same target and distance, seen along a direction (any length, not zero).
tracer::Camera seen_along(tracer::Camera camera, tracer::vec3 direction);

// Focused on a box, with the view direction kept; a box without extent is looked at from close by.
tracer::Camera focused_on(const tracer::Camera& camera, const tracer::Box& box, float aspect);

}  // namespace ui
