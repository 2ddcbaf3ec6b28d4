// The surfaces at hits, a vector of hits at a time, with bounds for their rounding errors. Compiled
// once for each instruction set, with the same result.
#include <array>
#include <cassert>
#include <limits>

#include "tracer/math/normalize.h"
#include "tracer/math/shading_targets.h"
#include "tracer/render/surface.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/render/surfaces.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 8>;
using OneLane = hn::CappedTag<float, 1>;

// n rounding errors in a row: n e / (1 - n e).
constexpr float gamma(int n) {
  constexpr float e = 0.5f * std::numeric_limits<float>::epsilon();
  return static_cast<float>(n) * e / (1.0f - static_cast<float>(n) * e);
}

// As many vectors in space as V has lanes.
template <class V>
struct Triple {
  V x, y, z;

  HWY_INLINE Triple operator+(const Triple& b) const { return {x + b.x, y + b.y, z + b.z}; }
  HWY_INLINE Triple operator-(const Triple& b) const { return {x - b.x, y - b.y, z - b.z}; }
  HWY_INLINE Triple operator*(V scale) const { return {x * scale, y * scale, z * scale}; }
};

template <class V>
HWY_INLINE Triple<V> abs(const Triple<V>& a) {
  return {hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)};
}
template <class V>
HWY_INLINE Triple<V> max(const Triple<V>& a, const Triple<V>& b) {
  return {hn::Max(a.x, b.x), hn::Max(a.y, b.y), hn::Max(a.z, b.z)};
}
template <class V>
HWY_INLINE V max_component(const Triple<V>& a) {
  return hn::Max(hn::Max(a.x, a.y), a.z);
}
template <class V>
HWY_INLINE V dot(const Triple<V>& a, const Triple<V>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class V>
HWY_INLINE Triple<V> cross(const Triple<V>& a, const Triple<V>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// As many matrices, by column.
template <class V>
struct Matrices {
  Triple<V> x, y, z, w;

  // Directions ...
  HWY_INLINE Triple<V> turned(const Triple<V>& v) const { return x * v.x + y * v.y + z * v.z; }
  // ... and points.
  HWY_INLINE Triple<V> moved(const Triple<V>& v) const { return x * v.x + y * v.y + (z * v.z + w); }
};

template <class V>
HWY_INLINE Matrices<V> abs(const Matrices<V>& m) {
  return {abs(m.x), abs(m.y), abs(m.z), abs(m.w)};
}

// The instances of a vector's lanes, which are most often the same one.
template <class D>
struct Placed {
  using V = hn::Vec<D>;
  std::array<const PlacedInstance*, hn::MaxLanes(D())> instances;
  bool are_same = true;

  HWY_INLINE Placed(const SceneBvh& bvh, const Hit* hits) {
    for (size_t lane = 0; lane < instances.size(); ++lane) {
      instances[lane] = &bvh.instances[hits[lane].instance];
      are_same &= instances[lane] == instances[0];
    }
  }

  // Of the matrices that get(instance) gives.
  template <class Get>
  HWY_INLINE Matrices<V> matrices(const Get& get) const {
    const auto column = [&](int i) HWY_ATTR -> Triple<V> {
      const auto part = [&](int axis) HWY_ATTR {
        const D d;
        if (are_same) return hn::Set(d, get(*instances[0])[i][axis]);
        HWY_ALIGN std::array<float, hn::MaxLanes(D())> values;
        for (size_t lane = 0; lane < instances.size(); ++lane)
          values[lane] = get(*instances[lane])[i][axis];
        return hn::Load(d, values.data());
      };
      return {part(0), part(1), part(2)};
    };
    constexpr bool has_translation = std::is_same_v<decltype(get(*instances[0])), const mat4&>;
    const V zero = hn::Zero(D());
    return {column(0), column(1), column(2),
            has_translation ? column(3) : Triple<V>{zero, zero, zero}};
  }
};

constexpr auto to_world_of = [](const PlacedInstance& placed) -> const mat4& {
  return placed.to_world;
};
constexpr auto to_object_of = [](const PlacedInstance& placed) -> const mat4& {
  return placed.to_object;
};
constexpr auto normal_to_world_of = [](const PlacedInstance& placed) -> const mat3& {
  return placed.normal_to_world;
};

// What surfaces are computed from, by component; hits side by side.
struct Gathered {
  static constexpr size_t most = 64;  // hits

  template <size_t count>
  struct Parts {
    alignas(64) float part[count][most];

    HWY_INLINE void set(size_t at, const glm::vec<count, float>& v) {
      for (int i = 0; i < int(count); ++i)
        part[i][at] = v[i];
    }
  };
  Parts<3> positions[3], normals[3];  // of the corners
  Parts<2> uvs[3];
  Parts<3> weights;  // of the corners, at the hits
  Parts<3> directions;
};

template <class D>
HWY_INLINE Triple<hn::Vec<D>> load(D d, const Gathered::Parts<3>& from, size_t at) {
  return {hn::Load(d, &from.part[0][at]), hn::Load(d, &from.part[1][at]),
          hn::Load(d, &from.part[2][at])};
}

template <class D>
HWY_INLINE void store(D d, const Triple<hn::Vec<D>>& v, Gathered::Parts<3>& to, size_t at) {
  hn::Store(v.x, d, &to.part[0][at]);
  hn::Store(v.y, d, &to.part[1][at]);
  hn::Store(v.z, d, &to.part[2][at]);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> safe_normalize(D d, const Triple<V>& v, const Triple<V>& otherwise) {
  const V square = dot(v, v);
  const auto moderate =
      hn::And(hn::Gt(square, hn::Set(d, 1e-30f)), hn::Lt(square, hn::Set(d, 1e30f)));
  if (HWY_LIKELY(hn::AllTrue(d, moderate))) return v * (hn::Set(d, 1.0f) / hn::Sqrt(square));
  Gathered::Parts<3> from, instead, to;
  store(d, v, from, 0);
  store(d, otherwise, instead, 0);
  for (size_t lane = 0; lane < hn::MaxLanes(d); ++lane) {
    const auto of = [lane](const Gathered::Parts<3>& all) {
      return vec3(all.part[0][lane], all.part[1][lane], all.part[2][lane]);
    };
    to.set(lane, tracer::safe_normalize(of(from), of(instead)));
  }
  return load(d, to, 0);
}

// Of triangles, in the world.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> geometric_normals(D d, const Triple<V>& to_b, const Triple<V>& to_c,
                                       const Matrices<V>& normal_to_world) {
  const V scale = hn::Set(d, 1.0f) / max_component(max(abs(to_b), abs(to_c)));
  Triple<V> normal = cross(to_b * scale, to_c * scale);
  const Triple<V> up = {hn::Zero(d), hn::Set(d, 1.0f), hn::Zero(d)};  // of those without area
  const auto has_area = hn::Gt(dot(normal, normal), hn::Set(d, 1e-12f));
  if (HWY_UNLIKELY(!hn::AllTrue(d, has_area))) {
    const Triple<V> unit = safe_normalize(d, normal, up);
    normal = {hn::IfThenElse(has_area, normal.x, unit.x),
              hn::IfThenElse(has_area, normal.y, unit.y),
              hn::IfThenElse(has_area, normal.z, unit.z)};
  }
  return safe_normalize(d, normal_to_world.turned(normal), up);
}

void gather(const Scene& scene, const Hit& hit, const vec3& direction, size_t at, Gathered& to,
            Surface& surface) {
  const Mesh& mesh = scene.meshes[scene.instances[hit.instance].mesh];
  const uvec3& corners = mesh.triangles[hit.triangle];
  surface.barycentric = {1.0f - hit.u - hit.v, hit.u, hit.v};
  surface.material = material_at(scene, hit);
  surface.triangle = hit.triangle;
  surface.instance = hit.instance;
  for (int i = 0; i < 3; ++i) {
    to.positions[i].set(at, mesh.positions[corners[i]]);
    to.normals[i].set(at, mesh.normals[corners[i]]);
    to.uvs[i].set(at, mesh.uvs.empty() ? vec2(0.0f) : mesh.uvs[corners[i]]);
  }
  to.weights.set(at, surface.barycentric);
  to.directions.set(at, direction);
}

template <class D>
HWY_INLINE void find_surfaces(D d, const SceneBvh& bvh, const Gathered& from, const Hit* hits,
                              size_t at, Surface* surfaces) {
  using V = hn::Vec<D>;
  const auto times = [d](int errors) HWY_ATTR { return hn::Set(d, gamma(errors)); };
  const auto load_of = [&](const Gathered::Parts<3>& parts) HWY_ATTR { return load(d, parts, at); };
  const Placed<D> placed(bvh, hits);
  const auto to_world = placed.matrices(to_world_of);
  const auto to_object = placed.matrices(to_object_of);
  const auto normal_to_world = placed.matrices(normal_to_world_of);
  const Triple<V> a = load_of(from.positions[0]), b = load_of(from.positions[1]),
                  c = load_of(from.positions[2]);
  const Triple<V> weight = load_of(from.weights);

  const Triple<V> of_a = a * weight.x, of_b = b * weight.y, of_c = c * weight.z;
  const Triple<V> object = of_a + of_b + of_c;
  const Triple<V> position = to_world.moved(object);

  // Of the interpolation, and of the test that a new ray from here makes against this triangle, in
  // object space ...
  const Triple<V> sum = abs(of_a) + abs(of_b) + abs(of_c);
  const Triple<V> to_b = b - a, to_c = c - a;
  const V size = times(16) * max_component(max(abs(to_b), abs(to_c)));
  const auto abs_to_world = abs(to_world);
  const Triple<V> world_sum = abs_to_world.moved(abs(object));
  const Triple<V> back_sum = abs(to_object).moved(world_sum);
  const Triple<V> object_error = sum * times(8) + Triple<V>{size, size, size} + back_sum * times(6);
  // ... and of the way to the world (the way back is in object_error).
  const Triple<V> error = abs_to_world.turned(object_error) + world_sum * times(6);

  const Triple<V> geometric = geometric_normals(d, to_b, to_c, normal_to_world);
  const Triple<V> normal = load_of(from.normals[0]) * weight.x +
                           load_of(from.normals[1]) * weight.y +
                           load_of(from.normals[2]) * weight.z;
  const Triple<V> shading = safe_normalize(d, normal_to_world.turned(normal), geometric);
  // To the geometric normal's side.
  const V zero = hn::Zero(d);
  const V turn =
      hn::IfThenElse(hn::Lt(dot(shading, geometric), zero), hn::Set(d, -1.0f), hn::Set(d, 1.0f));
  const auto uv = [&](int axis) HWY_ATTR {
    const auto corner = [&](int i) HWY_ATTR { return hn::Load(d, &from.uvs[i].part[axis][at]); };
    return corner(0) * weight.x + corner(1) * weight.y + corner(2) * weight.z;
  };

  enum {
    position_at = 0,
    error_at = 3,
    geometric_at = 6,
    shading_at = 9,
    uv_at = 12,
    along_at = 14
  };
  alignas(64) std::array<std::array<float, hn::MaxLanes(D())>, 15> parts;
  const auto put = [&](size_t first, const Triple<V>& v) HWY_ATTR {
    hn::Store(v.x, d, parts[first].data());
    hn::Store(v.y, d, parts[first + 1].data());
    hn::Store(v.z, d, parts[first + 2].data());
  };
  put(position_at, position);
  put(error_at, error);
  put(geometric_at, geometric);
  put(shading_at, shading * turn);
  put(uv_at, {uv(0), uv(1), dot(geometric, load_of(from.directions))});
  for (size_t lane = 0; lane < hn::MaxLanes(d); ++lane) {
    const auto part = [&](size_t i) { return parts[i][lane]; };
    const auto get = [&](size_t i) { return vec3(part(i), part(i + 1), part(i + 2)); };
    Surface& surface = surfaces[lane];
    surface.position = get(position_at);
    surface.position_error = get(error_at);
    surface.geometric_normal = get(geometric_at);
    surface.shading_normal = get(shading_at);
    surface.uv = {part(uv_at), part(uv_at + 1)};
    surface.front = part(along_at) <= 0.0f;
  }
}

void find_all_surfaces(const Scene& scene, const SceneBvh& bvh, std::span<const vec3> directions,
                       std::span<const Hit> hits, std::span<Surface> surfaces) {
  constexpr size_t lanes = hn::MaxLanes(Lanes());
  Gathered gathered;
  for (size_t first = 0; first < hits.size(); first += Gathered::most) {
    const size_t count = std::min(hits.size() - first, Gathered::most);
    for (size_t i = 0; i < count; ++i)
      gather(scene, hits[first + i], directions[first + i], i, gathered, surfaces[first + i]);
    size_t i = 0;
    for (; i + lanes <= count; i += lanes)
      find_surfaces(Lanes(), bvh, gathered, &hits[first + i], i, &surfaces[first + i]);
    for (; i < count; ++i)
      find_surfaces(OneLane(), bvh, gathered, &hits[first + i], i, &surfaces[first + i]);
  }
}

vec3 find_geometric_normal(const Scene& scene, const SceneBvh& bvh, const Hit& hit) {
  const OneLane d;
  const Mesh& mesh = scene.meshes[scene.instances[hit.instance].mesh];
  const auto corner = [&](int i) HWY_ATTR -> Triple<hn::Vec<OneLane>> {
    const vec3& at = mesh.positions[mesh.triangles[hit.triangle][i]];
    return {hn::Set(d, at.x), hn::Set(d, at.y), hn::Set(d, at.z)};
  };
  const auto normal = geometric_normals(d, corner(1) - corner(0), corner(2) - corner(0),
                                        Placed<OneLane>(bvh, &hit).matrices(normal_to_world_of));
  return {hn::GetLane(normal.x), hn::GetLane(normal.y), hn::GetLane(normal.z)};
}

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tracer {

HWY_EXPORT(find_all_surfaces);
HWY_EXPORT(find_geometric_normal);

void surfaces_at(const Scene& scene, const SceneBvh& bvh, std::span<const vec3> directions,
                 std::span<const Hit> hits, std::span<Surface> surfaces) {
  assert(directions.size() == hits.size() && hits.size() == surfaces.size());
  HWY_DYNAMIC_DISPATCH(find_all_surfaces)(scene, bvh, directions, hits, surfaces);
}

Surface surface_at(const Scene& scene, const SceneBvh& bvh, const vec3& direction, const Hit& hit) {
  Surface surface;
  surfaces_at(scene, bvh, {&direction, 1}, {&hit, 1}, {&surface, 1});
  return surface;
}

vec3 geometric_normal_at(const Scene& scene, const SceneBvh& bvh, const Hit& hit) {
  return HWY_DYNAMIC_DISPATCH(find_geometric_normal)(scene, bvh, hit);
}

}  // namespace tracer
#endif
