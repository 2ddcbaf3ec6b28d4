// Filling an Embree scene.
#include "app/peers/embree_scene.h"

#include <algorithm>
#include <cstring>

#include "tracer/error.h"

namespace app {
namespace {

using tracer::Hit;
using tracer::Mesh;
using tracer::PlacedInstance;
using tracer::Ray;

template <class Value>
void copy(void* to, const std::vector<Value>& from) {
  std::memcpy(to, from.data(), from.size() * sizeof(Value));
}

bool count_bytes(void* counter, ssize_t bytes, bool) {
  static_cast<std::atomic<int64_t>*>(counter)->fetch_add(bytes, std::memory_order_relaxed);
  return true;
}

}  // namespace

RTCRay embree_ray(const Ray& ray) {
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
  return query;
}

EmbreeScene::EmbreeScene(const tracer::Scene& scene, std::span<const PlacedInstance> instances,
                         bool robust, RTCBuildQuality quality)
    : bytes_(std::make_unique<std::atomic<int64_t>>(0)),
      device_(rtcNewDevice(nullptr)),
      quality_(quality) {
  if (device_ == nullptr) throw tracer::Error("Embree could not be started");
  rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, bytes_.get());
  top_ = new_scene(robust);
  for (const Mesh& mesh : scene.meshes) {
    geometries_.push_back(new_geometry(mesh));
    bottoms_.push_back(nullptr);
  }
  for (size_t i = 0; i < instances.size(); ++i) {
    const PlacedInstance& instance = instances[i];
    if (instance.to_world == tracer::mat4(1.0f)) {
      attach(geometries_[instance.mesh], top_, unsigned(i));
      top_has_triangles_ = true;
      continue;
    }
    RTCScene& bottom = bottoms_[instance.mesh];
    if (bottom == nullptr) {
      bottom = new_scene(robust);
      attach(geometries_[instance.mesh], bottom, 0);
      rtcCommitScene(bottom);
    }
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, bottom);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR,
                            &instance.to_world[0][0]);
    rtcCommitGeometry(geometry);
    attach(geometry, top_, unsigned(i));
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(top_);
}

EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(top_);
  for (RTCScene bottom : bottoms_)
    if (bottom != nullptr) rtcReleaseScene(bottom);
  for (RTCGeometry geometry : geometries_)
    rtcReleaseGeometry(geometry);
  rtcReleaseDevice(device_);
}

RTCScene EmbreeScene::new_scene(bool robust) const {
  RTCScene scene = rtcNewScene(device_);
  if (robust) rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, quality_);
  return scene;
}

RTCGeometry EmbreeScene::new_geometry(const Mesh& mesh) const {
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  copy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               sizeof(tracer::vec3), mesh.positions.size()),
       mesh.positions);
  copy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               sizeof(tracer::uvec3), mesh.triangles.size()),
       mesh.triangles);
  rtcSetGeometryBuildQuality(geometry, quality_);
  rtcCommitGeometry(geometry);
  return geometry;
}

void EmbreeScene::attach(RTCGeometry geometry, RTCScene scene, unsigned id) {
  rtcAttachGeometryByID(scene, geometry, id);
}

void EmbreeScene::rebuild() {
  for (RTCGeometry geometry : geometries_) {
    rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry);
  }
  for (RTCScene bottom : bottoms_)
    if (bottom != nullptr) rtcCommitScene(bottom);
  if (top_has_triangles_) rtcCommitScene(top_);
}

bool EmbreeScene::has_instances() const {
  return std::any_of(bottoms_.begin(), bottoms_.end(),
                     [](RTCScene bottom) { return bottom != nullptr; });
}

Hit EmbreeScene::intersect(const Ray& ray) const {
  RTCRayHit query{};
  query.ray = embree_ray(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if BVHSCOPE_EMBREE == 4
  rtcIntersect1(top_, &query);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(top_, &context, &query);
#endif
  const RTCHit& hit = query.hit;
  if (hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  const bool instanced = hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  return {query.ray.tfar, hit.u, hit.v, hit.primID, instanced ? hit.instID[0] : hit.geomID};
}

bool EmbreeScene::occluded(const Ray& ray) const {
  RTCRay query = embree_ray(ray);
#if BVHSCOPE_EMBREE == 4
  rtcOccluded1(top_, &query);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(top_, &context, &query);
#endif
  return query.tfar < 0.0f;
}

}  // namespace app
