// Lines spread evenly over all that meet a box.
#include "tracer/analyze/random_lines.h"

#include <cmath>

namespace tracer {

Ray random_line(const Box& box, double face_share, Rng& rng) {
  const glm::dvec3 e = glm::dvec3(box.hi) - glm::dvec3(box.lo);
  const glm::dvec3 faces(e.y * e.z, e.z * e.x, e.x * e.y);
  const double half_area = faces.x + faces.y + faces.z;
  Ray line;
  line.direction = vec3(0.0f);
  if (is_empty(box) || !(half_area > 0.0)) return line;

  double wanted = face_share * 2.0 * half_area;
  const bool at_hi = wanted >= half_area;
  if (at_hi) wanted -= half_area;
  int axis = 0;
  while (axis < 2 && wanted >= faces[axis])
    wanted -= faces[axis++];
  while (faces[axis] == 0.0)
    axis = (axis + 1) % 3;
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  line.origin[axis] = at_hi ? box.hi[axis] : box.lo[axis];
  for (const int side : {u, v}) {
    const double place = box.lo[side] + uniform(rng) * e[side];
    line.origin[side] = std::min(float(place), box.hi[side]);
  }

  const double square = uniform(rng);  // of the sine
  const double angle = 2.0 * double(pi) * uniform(rng);
  line.direction[axis] = float((at_hi ? -1.0 : 1.0) * std::sqrt(1.0 - square));
  line.direction[u] = float(std::sqrt(square) * std::cos(angle));
  line.direction[v] = float(std::sqrt(square) * std::sin(angle));
  return line;
}

}  // namespace tracer
