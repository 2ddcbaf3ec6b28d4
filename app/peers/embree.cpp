// Embree as a peer: single rays and packets of 8 and 16, also with its hint that rays are coherent.
// Rays are brought into Embree's own packets beforehand, so only tracing is timed; what a packet
// finds stays as Embree writes it.
#include <algorithm>
#include <cstring>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "app/peers/embree_scene.h"
#include "app/peers/peers.h"
#include "tracer/choice.h"

namespace app {
namespace {

using tracer::PeerTracer;
using tracer::Ray;
using tracer::RaySet;
using SharedScene = std::shared_ptr<EmbreeScene>;

// What Embree's authors ask for: numbers too small to be normal count as zero while it traces.
class FlushToZero {
 public:
#if defined(__SSE2__)
  FlushToZero() : before_(_mm_getcsr()) {
    _mm_setcsr(before_ | 0x8040);
  }
  ~FlushToZero() {
    _mm_setcsr(before_);
  }

 private:
  unsigned before_;
#else
  FlushToZero() {}
  ~FlushToZero() {}
#endif
};

// What goes with a call. The two versions of Embree want their arguments in another order.
struct Query {
#if BVHSCOPE_EMBREE == 4
  RTCIntersectArguments nearest;
  RTCOccludedArguments any;
  explicit Query(bool coherent) {
    rtcInitIntersectArguments(&nearest);
    rtcInitOccludedArguments(&any);
    nearest.flags = any.flags =
        coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  }
#else
  RTCIntersectContext context;
  explicit Query(bool coherent) {
    rtcInitIntersectContext(&context);
    context.flags =
        coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
#endif
};

template <int width>
struct Api;
template <>
struct Api<8> {
  using Rays = RTCRay8;
  using RayHits = RTCRayHit8;
  static constexpr auto nearest = rtcIntersect8;
  static constexpr auto any = rtcOccluded8;
};
template <>
struct Api<16> {
  using Rays = RTCRay16;
  using RayHits = RTCRayHit16;
  static constexpr auto nearest = rtcIntersect16;
  static constexpr auto any = rtcOccluded16;
};

#if BVHSCOPE_EMBREE == 4
void intersect(RTCScene scene, Query& query, RTCRayHit* ray) {
  rtcIntersect1(scene, ray, &query.nearest);
}
void occluded(RTCScene scene, Query& query, RTCRay* ray) {
  rtcOccluded1(scene, ray, &query.any);
}
template <int width>
void intersect(const int* valid, RTCScene scene, Query& query, typename Api<width>::RayHits* rays) {
  Api<width>::nearest(valid, scene, rays, &query.nearest);
}
template <int width>
void occluded(const int* valid, RTCScene scene, Query& query, typename Api<width>::Rays* rays) {
  Api<width>::any(valid, scene, rays, &query.any);
}
#else
void intersect(RTCScene scene, Query& query, RTCRayHit* ray) {
  rtcIntersect1(scene, &query.context, ray);
}
void occluded(RTCScene scene, Query& query, RTCRay* ray) {
  rtcOccluded1(scene, &query.context, ray);
}
template <int width>
void intersect(const int* valid, RTCScene scene, Query& query, typename Api<width>::RayHits* rays) {
  Api<width>::nearest(valid, scene, &query.context, rays);
}
template <int width>
void occluded(const int* valid, RTCScene scene, Query& query, typename Api<width>::Rays* rays) {
  Api<width>::any(valid, scene, &query.context, rays);
}
#endif

// What is kept of the answers: enough for a shader to go on from.
struct Found {
  float t;
  uint32_t triangle;
};

struct Singles {
  SharedScene scene;
  std::vector<RTCRay> rays;
  std::vector<Found> found;  // of any-hit rays only t: 0 or infinity
};

void trace_nearest(Singles& job, size_t first, size_t last) {
  const FlushToZero flush;
  Query query(false);
  for (size_t i = first; i < last; ++i) {
    RTCRayHit ray;
    ray.ray = job.rays[i];
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect(job.scene->top(), query, &ray);
    const bool hit = ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    job.found[i] = {hit ? ray.ray.tfar : tracer::infinity, ray.hit.primID};
  }
}

void trace_any(Singles& job, size_t first, size_t last) {
  const FlushToZero flush;
  Query query(false);
  for (size_t i = first; i < last; ++i) {
    RTCRay ray = job.rays[i];
    occluded(job.scene->top(), query, &ray);
    job.found[i].t = ray.tfar < 0.0f ? 0.0f : tracer::infinity;
  }
}

PeerTracer single_tracer(const SharedScene& scene, const RaySet& set) {
  auto job = std::make_shared<Singles>();
  job->scene = scene;
  for (const Ray& ray : set.rays)
    job->rays.push_back(embree_ray(ray));
  job->found.resize(set.rays.size());
  return {[job, trace = set.any_hit ? trace_any : trace_nearest](size_t first, size_t last) {
            trace(*job, first, last);
          },
          [job](size_t ray) { return job->found[ray].t; }};
}

template <int width>
struct alignas(64) Packet {
  int valid[width];
  typename Api<width>::Rays rays;
};

template <int width>
struct alignas(64) FoundTogether {
  float t[width];
  uint32_t geometry[width], triangle[width];
};

template <int width>
struct Packets {
  SharedScene scene;
  bool coherent = false;
  std::vector<Packet<width>> packets;
  std::vector<FoundTogether<width>> found;  // of any-hit rays only t, negative where hit
};

template <int width>
void put(Packet<width>& packet, int lane, const RTCRay& ray, bool valid) {
  auto& rays = packet.rays;
  packet.valid[lane] = valid ? -1 : 0;
  rays.org_x[lane] = ray.org_x;
  rays.org_y[lane] = ray.org_y;
  rays.org_z[lane] = ray.org_z;
  rays.dir_x[lane] = ray.dir_x;
  rays.dir_y[lane] = ray.dir_y;
  rays.dir_z[lane] = ray.dir_z;
  rays.tnear[lane] = ray.tnear;
  rays.tfar[lane] = ray.tfar;
  rays.time[lane] = 0.0f;
  rays.mask[lane] = ~0u;
  rays.id[lane] = rays.flags[lane] = 0;
}

template <int width>
void trace_nearest(Packets<width>& job, size_t first, size_t last) {
  const FlushToZero flush;
  Query query(job.coherent);
  typename Api<width>::RayHits rays;
  for (size_t i = first / width; i < (last + width - 1) / width; ++i) {
    rays.ray = job.packets[i].rays;
    std::memset(rays.hit.geomID, -1, sizeof(rays.hit.geomID));
    intersect<width>(job.packets[i].valid, job.scene->top(), query, &rays);
    FoundTogether<width>& found = job.found[i];
    std::memcpy(found.t, rays.ray.tfar, sizeof(found.t));
    std::memcpy(found.geometry, rays.hit.geomID, sizeof(found.geometry));
    std::memcpy(found.triangle, rays.hit.primID, sizeof(found.triangle));
  }
}

template <int width>
void trace_any(Packets<width>& job, size_t first, size_t last) {
  const FlushToZero flush;
  Query query(job.coherent);
  for (size_t i = first / width; i < (last + width - 1) / width; ++i) {
    typename Api<width>::Rays rays = job.packets[i].rays;
    occluded<width>(job.packets[i].valid, job.scene->top(), query, &rays);
    std::memcpy(job.found[i].t, rays.tfar, sizeof(job.found[i].t));
  }
}

template <int width>
PeerTracer packet_tracer(const SharedScene& scene, const RaySet& set, bool coherent) {
  auto job = std::make_shared<Packets<width>>();
  job->scene = scene;
  job->coherent = coherent;
  const size_t count = (set.rays.size() + width - 1) / width;
  job->packets.resize(count);
  job->found.resize(count);
  for (size_t i = 0; i < count * width; ++i) {
    const bool valid = i < set.rays.size();
    put(job->packets[i / width], int(i % width),
        embree_ray(set.rays[std::min(i, set.rays.size() - 1)]), valid);
  }
  if (set.any_hit) {
    return {[job](size_t first, size_t last) { trace_any(*job, first, last); },
            [job](size_t ray) {
              return job->found[ray / width].t[ray % width] < 0.0f ? 0.0f : tracer::infinity;
            }};
  }
  return {[job](size_t first, size_t last) { trace_nearest(*job, first, last); },
          [job](size_t ray) {
            const FoundTogether<width>& found = job->found[ray / width];
            const bool hit = found.geometry[ray % width] != RTC_INVALID_GEOMETRY_ID;
            return hit ? found.t[ray % width] : tracer::infinity;
          }};
}

constexpr tracer::PeerKernelRow kernel_rows[] = {
    {"single", "Single rays", "rtcIntersect1 and rtcOccluded1"},
    {"packet8", "Packets of 8", "rtcIntersect8 and rtcOccluded8", 8},
    {"packet16", "Packets of 16", "rtcIntersect16 and rtcOccluded16", 16},
    {"packet8-coherent", "Packets of 8, coherent", "rtcIntersect8, told that rays are coherent", 8,
     true},
    {"packet16-coherent", "Packets of 16, coherent", "rtcIntersect16, told that rays are coherent",
     16, true},
};

PeerTracer tracer_of(const SharedScene& scene, std::string_view kernel, const RaySet& set) {
  const tracer::PeerKernelRow& row =
      *tracer::find_row(std::span<const tracer::PeerKernelRow>(kernel_rows), kernel);
  // Robust any-hit packets of 16 with that hint never come back from instances (Embree 3.13.5).
  if (row.coherent_only && scene->has_instances()) return {};
  if (row.width == 16) return packet_tracer<16>(scene, set, row.coherent_only);
  if (row.width == 8) return packet_tracer<8>(scene, set, row.coherent_only);
  return single_tracer(scene, set);
}

constexpr tracer::PeerQualityRow quality_rows[] = {
    {"low", "lbvh"},
    {"medium", "binned"},
    {"high", "sbvh", true},  // splits triangles only where it need not be robust
};

RTCBuildQuality quality_of(std::string_view id) {
  return id == "low"    ? RTC_BUILD_QUALITY_LOW
         : id == "high" ? RTC_BUILD_QUALITY_HIGH
                        : RTC_BUILD_QUALITY_MEDIUM;
}

tracer::PeerScene build(const tracer::Scene& scene,
                        std::span<const tracer::PlacedInstance> instances, std::string_view quality,
                        bool robust) {
  auto held = std::make_shared<EmbreeScene>(scene, instances, robust, quality_of(quality));
  return {
      [held] { held->rebuild(); },
      [held](std::string_view kernel, const RaySet& set) { return tracer_of(held, kernel, set); },
      held->bytes()};
}

}  // namespace

std::span<const tracer::PeerRow> peers() {
  static const tracer::PeerRow rows[] = {
      {"embree", "Embree", RTC_VERSION_STRING, kernel_rows, quality_rows, "medium", build}};
  return rows;
}

std::string_view missing_peers() {
  return "";
}

}  // namespace app
