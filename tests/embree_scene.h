// The same scene in Embree, for tests and benchmarks: one Embree scene a mesh, one instance each.
#pragma once

#include <cstring>
#include <span>
#include <string>
#include <vector>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "tracer/bvh/scene_bvh.h"
#include "tracer/math/ray.h"

namespace tracer::test {

class EmbreeScene {
 public:
  // threads 0: all. The instances are posed as in `bvh`.
  EmbreeScene(const Scene& scene, std::span<const PlacedInstance> instances, int threads,
              bool robust = true, RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM)
      : device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())),
        quality_(quality),
        top_(new_scene(robust)) {
    for (const Mesh& mesh : scene.meshes) {
      RTCScene bottom = new_scene(robust);
      RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      copy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   sizeof(vec3), mesh.positions.size()),
           mesh.positions);
      copy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   sizeof(uvec3), mesh.triangles.size()),
           mesh.triangles);
      rtcSetGeometryBuildQuality(geometry, quality);
      attach(geometry, bottom);
      bottoms_.push_back(bottom);
    }
    for (RTCScene bottom : bottoms_)
      rtcCommitScene(bottom);
    for (const PlacedInstance& instance : instances) {
      RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, bottoms_[instance.mesh]);
      rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR,
                              &instance.to_world[0][0]);
      attach(geometry, top_);
    }
    rtcCommitScene(top_);
  }
  ~EmbreeScene() {
    rtcReleaseScene(top_);
    for (RTCScene bottom : bottoms_)
      rtcReleaseScene(bottom);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  // Builds all BLASes again, from scratch.
  void rebuild() {
    for (RTCScene bottom : bottoms_) {
      RTCGeometry geometry = rtcGetGeometry(bottom, 0);
      rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
      rtcCommitGeometry(geometry);
      rtcCommitScene(bottom);
    }
  }

  Hit intersect(const Ray& ray) const {
    RTCRayHit query{};
    query.ray.org_x = ray.origin.x;
    query.ray.org_y = ray.origin.y;
    query.ray.org_z = ray.origin.z;
    query.ray.dir_x = ray.direction.x;
    query.ray.dir_y = ray.direction.y;
    query.ray.dir_z = ray.direction.z;
    query.ray.tnear = ray.t_min;
    query.ray.tfar = ray.t_max;
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(top_, &query);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(top_, &context, &query);
#endif
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID, query.hit.instID[0]};
  }

  bool occluded(const Ray& ray) const {
    RTCRay query{};
    query.org_x = ray.origin.x;
    query.org_y = ray.origin.y;
    query.org_z = ray.origin.z;
    query.dir_x = ray.direction.x;
    query.dir_y = ray.direction.y;
    query.dir_z = ray.direction.z;
    query.tnear = ray.t_min;
    query.tfar = ray.t_max;
    query.mask = ~0u;
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(top_, &query);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(top_, &context, &query);
#endif
    return query.tfar < 0.0f;
  }

 private:
  RTCScene new_scene(bool robust) const {
    RTCScene scene = rtcNewScene(device_);
    if (robust) rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, quality_);
    return scene;
  }
  template <class Value>
  static void copy(void* to, const std::vector<Value>& from) {
    std::memcpy(to, from.data(), from.size() * sizeof(Value));
  }
  static void attach(RTCGeometry geometry, RTCScene scene) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }

  RTCDevice device_;
  RTCBuildQuality quality_;
  RTCScene top_;
  std::vector<RTCScene> bottoms_;
};

}  // namespace tracer::test
