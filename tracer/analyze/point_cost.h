// What rays pay where they end: the boxes around a point of the surface that have nothing to do
// with it. The integrand of EPO (epo.h), at one point.
#pragma once

#include "tracer/bvh/scene_bvh.h"

namespace tracer {

// Of nodes of the TLAS and of all BLASes whose instance boxes hold the point, each instance's by
// itself.
struct PointCost {
  uint32_t boxes = 0;    // that hold the point
  uint32_t useless = 0;  // of them, those that are not above the triangle which was hit there
  double cost = 0.0;     // of the useless ones: Ct an inner node, count * Ci a leaf
};

// Of a hit on the scene that the BVH was built for.
PointCost point_cost(const Scene& scene, const SceneBvh& bvh, const Hit& hit);

}  // namespace tracer
