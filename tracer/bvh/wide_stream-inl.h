// Streams: many rays go down the tree together. A node is opened once for all rays that reach it,
// its planes stay in registers while one ray after the other is held against all of them, and each
// child gets the list of the rays that enter it. Rays need have nothing in common: they are sorted
// by the signs of their directions, and octant after octant opens a node in turn. So the steps of
// different rays wait neither for each other nor for memory, and few branches depend on a single
// ray. Children are visited in the order in which the first ray of the list meets them; triangle
// tests are put off until there are enough of them.
// C. Gribble, K. Ramani, Coherent Ray Tracing via Stream Filtering, 2008 (lists of active rays);
// R. Barringer, T. Akenine-Moeller, Dynamic Ray Stream Traversal, 2014 (rays by broadcasts, lists
// for each child).
// Compiled once for each instruction set.
#if defined(TRACER_BVH_WIDE_STREAM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_WIDE_STREAM_INL_H_
#undef TRACER_BVH_WIDE_STREAM_INL_H_
#else
#define TRACER_BVH_WIDE_STREAM_INL_H_
#endif

#include <memory>
#include <numeric>

#include "tracer/bvh/wide_traverse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

// What the triangle tests of a stream need of a ray before it hits anything.
template <Tests tests>
using StreamTest = std::conditional_t<tests == Tests::fast, FastTriangleRay, ShearedRay>;

// For every set of eight: where its members are among 16-bit numbers, one after the other.
struct alignas(16) SetMembers {
  uint8_t bytes[256][16] = {};
  constexpr SetMembers() {
    for (int set = 0; set < 256; ++set) {
      int count = 0;
      for (int i = 0; i < 8; ++i) {
        if ((set >> i & 1) == 0) continue;
        bytes[set][2 * count] = uint8_t(2 * i);
        bytes[set][2 * count + 1] = uint8_t(2 * i + 1);
        ++count;
      }
    }
  }
};
inline constexpr SetMembers set_members;

// Writes those of eight numbers that are in the set; what is behind them, up to eight, is lost.
HWY_INLINE void write_members(const uint16_t* numbers, uint32_t set, uint16_t* to) {
  const hn::CappedTag<uint8_t, 16> d;
  if constexpr (hn::MaxLanes(d) == 16) {
    const auto from = hn::LoadU(d, reinterpret_cast<const uint8_t*>(numbers));
    const auto members = hn::TableLookupBytes(from, hn::Load(d, set_members.bytes[set]));
    hn::StoreU(members, d, reinterpret_cast<uint8_t*>(to));
  } else {
    for (; set != 0; set &= set - 1)
      *to++ = numbers[std::countr_zero(set)];
  }
}

template <bool any_hit, class Nodes, Tests tests = Tests::watertight>
class StreamTraversal {
  using Node = std::remove_cvref_t<decltype(Nodes().nodes[0])>;
  static constexpr int W = Node::width;
  using D = SlotLanes<W>;
  using V = hn::Vec<D>;
  static constexpr int vectors = W / int(hn::MaxLanes(D()));  // that a node takes
  static constexpr size_t capacity = 2048;                    // rays under way
  static constexpr uint32_t octant_count = 8;
  static constexpr size_t most_waiting = 16;  // for triangle tests
  using Id = uint16_t;                        // of a ray under way

  // A ray in the space of a tree.
  struct alignas(64) RayInTree {
    float inverse[4], from_near[4], from_far[4];  // by axis, as in SlabOrigin
    float t_min;
    float end;          // of boxes that are worth a visit; any hit found: less than t_min
    uint32_t index;     // among all rays
    uint32_t in_scene;  // of rays in an instance: among those in the scene
    StreamTest<tests> test;
    uint32_t is_usual;  // SlabOrigin
    float t_max;
    Hit hit;
  };
  static_assert(sizeof(RayInTree) == 128);

  // A ray that is to be held against a block.
  struct Waiting {
    const TriangleBlock* block;
    RayInTree* ray;
  };

  // Rays that reach a child: `count` ids from `begin` on; from `free` on there is room.
  struct Task {
    WideChild child;
    uint32_t begin, count, free;
  };

  // Rays of one octant on their way through a tree.
  struct Walk {
    uint32_t near[3];  // planes that they meet first
    RayInTree* rays;
    Id* ids;
    Task* bottom;
    Task* top;
  };

  // For the lists and tasks of all octants in a tree.
  struct Room {
    size_t levels = 0;
    size_t tasks_of_octant = 0;
    UntouchedVector<Id> ids;
    UntouchedVector<Task> tasks;

    void make(uint32_t depth, size_t rays) {
      levels = depth + 1;
      tasks_of_octant = (W - 1) * levels + 1;
      ids.resize(octant_count * ids_for(0) + ids_for(rays));
      tasks.resize(octant_count * tasks_of_octant);
    }
    // The rays themselves, and at each level all of them in all children, in whole vectors.
    size_t ids_for(size_t rays) const { return (1 + W * levels) * (rays + 8); }
  };

  // The planes of a node as rays of one octant meet them.
  struct NodePlanes {
    V near[3][vectors], far[3][vectors];

    HWY_INLINE NodePlanes(const Node& node, const uint32_t (&nearest)[3]) {
      const D d;
      const auto planes = planes_of(node);
      for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < vectors; ++i) {
          near[axis][i] = planes.load(d, nearest[axis], i * hn::Lanes(d));
          far[axis][i] = planes.load(d, nearest[axis] ^ 1, i * hn::Lanes(d));
        }
      }
    }
  };

 public:
  StreamTraversal(const SceneBvh& bvh, const Nodes& tlas, std::span<const Ray> rays)
      : bvh_(bvh), tlas_(tlas), rays_(rays) {
    uint32_t depth = 0;
    for (const std::shared_ptr<const Blas>& blas : bvh.blases)
      if (const Nodes* tree = std::get_if<Nodes>(&blas->wide)) depth = std::max(depth, tree->depth);
    const size_t most = std::min(capacity, rays.size());
    in_instance_.resize(most);
    room_in_instance_.make(depth, most);
    if (tlas.entries.size() == 1) return;
    in_scene_.resize(most);
    room_in_scene_.make(tlas.depth, most);
  }

  // answer(index of a ray, its hit), in any order.
  template <class Answer>
  void run(const Answer& answer) {
    for (size_t first = 0; first < rays_.size(); first += capacity)
      trace(first, std::min(capacity, rays_.size() - first), answer);
  }

 private:
  template <class Answer>
  void trace(size_t first, size_t count, const Answer& answer) {
    Id valid[capacity];
    uint32_t begun = 0;
    for (size_t i = 0; i < count; ++i) {
      valid[begun] = Id(i);
      if (is_valid(rays_[first + i]) && rays_[first + i].t_max >= 0.0f)
        ++begun;
      else
        answer(uint32_t(first + i), Hit{});
    }
    const auto ray_of = [&](uint32_t i) HWY_ATTR -> const Ray& { return rays_[first + valid[i]]; };
    const auto begin = [&](uint32_t i, RayInTree& ray) HWY_ATTR {
      ray.index = uint32_t(first + valid[i]);
      ray.t_min = std::max(0.0f, ray_of(i).t_min);
      ray.hit = {};
      end_at(ray, ray_of(i).t_max);
    };
    // A single instance needs no way through the TLAS.
    const bool is_alone = tlas_.entries.size() == 1;
    RayInTree* const rays = is_alone ? in_instance_.data() : in_scene_.data();
    if (is_alone) {
      visit(tlas_.entries[0], begun, ray_of, begin);
    } else {
      const auto at_home = [&](const Ray& ray, const auto& use)
                               HWY_ATTR { return use(ray.origin, ray.direction); };
      walk(tlas_, 0, rays, sort_in(rays, begun, at_home, ray_of, begin), room_in_scene_,
           [&](uint32_t entry, RayInTree* reached, std::span<const Id> ids)
               HWY_ATTR { enter(&tlas_.entries[entry], reached, ids); });
    }
    for (uint32_t i = 0; i < begun; ++i)
      answer(rays[i].index, rays[i].hit);
  }

  // Through the instances of a leaf.
  void enter(const WideEntry* entry, RayInTree* in_scene, std::span<const Id> ids) {
    const auto count = uint32_t(ids.size());
    const auto ray_of = [&](uint32_t i) -> const Ray& { return rays_[in_scene[ids[i]].index]; };
    for (;; ++entry) {
      visit(*entry, count, ray_of, [&](uint32_t i, RayInTree& ray) HWY_ATTR {
        const RayInTree& from = in_scene[ids[i]];
        ray.index = from.index;
        ray.in_scene = ids[i];
        ray.t_min = from.t_min;
        ray.end = from.end;
        ray.t_max = from.t_max;
        ray.hit = from.hit;
      });
      for (const RayInTree& ray : std::span(in_instance_.data(), count)) {
        RayInTree& to = in_scene[ray.in_scene];
        to.end = ray.end;
        to.t_max = ray.t_max;
        to.hit = ray.hit;
      }
      if ((entry->instance & more_bit) == 0) return;
    }
  }

  // Rays 0 to count - 1 through an instance: ray_of(i), as `begin` says (i, ray in the instance).
  template <class RayOf, class Begin>
  void visit(const WideEntry& entry, uint32_t count, const RayOf& ray_of, const Begin& begin) {
    const uint32_t id = entry.instance & ~more_bit;
    const PlacedInstance& instance = bvh_.instances[id];
    const Nodes& tree = std::get<Nodes>(bvh_.blases[instance.mesh]->wide);
    RayInTree* const rays = in_instance_.data();
    const auto in_its_space = [&](const Ray& ray, const auto& use)
                                  HWY_ATTR { return use_in(instance, ray, use); };
    walk(tree, entry.at.child, rays, sort_in(rays, count, in_its_space, ray_of, begin),
         room_in_instance_,
         [&](uint32_t block, RayInTree* reached, std::span<const Id> ids)
             HWY_ATTR { put_off(&tree.blocks[block], id, reached, ids); });
    test_waiting(id);
  }

  // use(origin, direction) of a ray in an instance's space.
  template <class Use>
  static HWY_INLINE auto use_in(const PlacedInstance& instance, const Ray& ray, const Use& use) {
    if (instance.in_place) return use(ray.origin, ray.direction);
    return use(moved(instance.to_object, ray.origin), turned(instance.to_object, ray.direction));
  }

  // Where the rays of each octant begin, and where the last ones end.
  using Octants = std::array<uint32_t, octant_count + 1>;

  // Rays 0 to count - 1, sorted by the signs of their directions. aimed(ray, use) calls use(origin,
  // direction) in the space of the tree.
  template <class Aimed, class RayOf, class Begin>
  static HWY_INLINE Octants sort_in(RayInTree* rays, uint32_t count, const Aimed& aimed,
                                    const RayOf& ray_of, const Begin& begin) {
    uint8_t octant[capacity];
    Octants octants = {};
    for (uint32_t i = 0; i < count; ++i) {
      octant[i] = aimed(ray_of(i), [](const vec3&, const vec3& direction) HWY_ATTR {
        return uint8_t(sign_bits(float4{direction.x, direction.y, direction.z, 0.0f}));
      });
      ++octants[octant[i] + 1];
    }
    std::partial_sum(octants.begin(), octants.end(), octants.begin());
    Octants next = octants;
    Id order[capacity];
    for (uint32_t i = 0; i < count; ++i)
      order[next[octant[i]]++] = Id(i);
    for (uint32_t i = 0; i < count; ++i) {
      RayInTree& ray = rays[i];
      aimed(ray_of(order[i]), [&](const vec3& origin, const vec3& direction) HWY_ATTR {
        const SlabOrigin slab = slab_origin<tests>(origin, direction);
        std::memcpy(ray.inverse, &slab.inverse, sizeof ray.inverse);
        std::memcpy(ray.from_near, &slab.from_near, sizeof ray.from_near);
        std::memcpy(ray.from_far, &slab.from_far, sizeof ray.from_far);
        ray.is_usual = uint32_t(slab.is_usual);
        if constexpr (tests == Tests::fast)
          ray.test = {origin, direction};
        else
          ray.test = sheared_ray(origin, direction, box_ray(origin, direction));
      });
      begin(order[i], ray);
    }
    return octants;
  }

  // leaf(first block or entry, rays of one octant, ids) for the leaves that rays may hit, from
  // `child` on. The octants take turns: what one will read next comes from memory meanwhile.
  template <class Leaf>
  static HWY_NOINLINE void walk(const Nodes& tree, WideChild child, RayInTree* rays,
                                const Octants& octants, Room& room, const Leaf& leaf) {
    std::array<Walk, octant_count> walks;
    size_t under_way = 0;
    Id* ids = room.ids.data();
    Task* tasks = room.tasks.data();
    for (uint32_t i = 0; i < octant_count; ++i) {
      const uint32_t count = octants[i + 1] - octants[i];
      if (count == 0) continue;
      Walk& walk = walks[under_way++];
      for (uint32_t axis = 0; axis < 3; ++axis)
        walk.near[axis] = 2 * axis + (i >> axis & 1);
      walk.rays = rays + octants[i];
      walk.ids = ids;
      std::iota(ids, ids + count, Id(0));
      ids += room.ids_for(count);
      walk.bottom = tasks;
      *tasks = {child, 0, count, whole_vectors(count)};
      walk.top = tasks + 1;
      tasks += room.tasks_of_octant;
    }
    while (under_way > 0) {
      for (size_t i = 0; i < under_way;) {
        Walk& walk = walks[i];
        Task* const task = --walk.top;
        if (is_leaf(task->child))
          leaf(task->child & ~leaf_bit, walk.rays, {walk.ids + task->begin, task->count});
        else
          walk.top = open(tree, walk.near, walk.rays, walk.ids, task);
        if (walk.top == walk.bottom)
          walk = walks[--under_way];
        else
          ++i;
      }
    }
  }

  // Puts the tasks of a node's children in the place of its own, the nearest one on top; any hit:
  // the last slot. Returns the new top.
  static HWY_INLINE Task* open(const Nodes& tree, const uint32_t (&near)[3], const RayInTree* rays,
                               Id* ids, Task* task) {
    const Node& node = tree.nodes[task->child];
    const Id* const list = ids + task->begin;
    const uint32_t size = task->count;
    const NodePlanes planes(node, near);
    // A byte for each ray: the children that it enters.
    uint64_t entered[capacity / 8];
    uint64_t by_any = 0;
    for (uint32_t first = 0; first < size; first += 8) {
      uint64_t eight = 0;
      const uint32_t here = std::min(8u, size - first);
      for (uint32_t i = 0; i < here; ++i)
        eight |= uint64_t(hit_planes(planes, rays[list[first + i]])) << 8 * i;
      entered[first / 8] = eight;
      by_any |= eight;
    }
    by_any |= by_any >> 32;
    by_any |= by_any >> 16;
    by_any |= by_any >> 8;
    const uint32_t children = uint32_t(by_any) & 0xff & planes_of(node).slots();

    uint64_t order[W];  // entry of the first ray, and slot
    const int found = sort_children(planes, rays[list[0]], children, order);
    Task* top = task;
    uint32_t end = task->free;
    for (int i = 0; i < found; ++i) {
      const auto slot = uint32_t(order[i]);
      prefetch(tree, node.child[slot]);
      uint32_t count = 0;
      for (uint32_t first = 0; first < size; first += 8) {
        const uint32_t set = set_of(entered[first / 8], slot);
        write_members(list + first, set, ids + end + count);
        count += uint32_t(std::popcount(set));
      }
      *top++ = {node.child[slot], end, count, 0};
      end += whole_vectors(count);
    }
    for (Task* at = task; at < top; ++at)
      at->free = end;
    return top;
  }

  // A list begins where no vector of another one is written: it would have to wait for that.
  static HWY_INLINE uint32_t whole_vectors(uint32_t ids) { return (ids + 7) & ~7u; }

  // Of eight rays those that enter the child.
  static HWY_INLINE uint32_t set_of(uint64_t entered, uint32_t slot) {
    constexpr uint64_t ones = 0x0101010101010101, bit_of_each = 0x0102040810204080;
    return uint32_t(((entered >> slot & ones) * bit_of_each) >> 56);
  }

  // The furthest one first, as the ray sees them, if their order matters.
  static HWY_INLINE int sort_children(const NodePlanes& planes, const RayInTree& ray,
                                      uint32_t children, uint64_t (&order)[W]) {
    alignas(64) float entries[W] = {};
    if (!any_hit && (children & (children - 1)) != 0) hit_planes(planes, ray, entries);
    int found = 0;
    for (; children != 0; children &= children - 1) {
      const int slot = std::countr_zero(children);
      const uint64_t key = waiting_key(entries[slot], WideChild(slot));
      int at = found++;
      if constexpr (!any_hit)
        for (; at > 0 && order[at - 1] < key; --at)
          order[at] = order[at - 1];
      order[at] = key;
    }
    return found;
  }

  // The children that the ray enters: a bit for each slot.
  static HWY_INLINE uint32_t hit_planes(const NodePlanes& planes, const RayInTree& ray,
                                        float* entries = nullptr) {
    const D d;
    uint32_t hits = 0;
    for (int i = 0; i < vectors; ++i) {
      const auto entry_of = [&](int axis) HWY_ATTR {
        return hn::MulSub(planes.near[axis][i], hn::Set(d, ray.inverse[axis]),
                          hn::Set(d, ray.from_near[axis]));
      };
      const auto exit_of = [&](int axis) HWY_ATTR {
        return hn::MulSub(planes.far[axis][i], hn::Set(d, ray.inverse[axis]),
                          hn::Set(d, ray.from_far[axis]));
      };
      const V entry =
          hn::Max(hn::Max(entry_of(0), entry_of(1)), hn::Max(entry_of(2), hn::Set(d, ray.t_min)));
      V exit = hn::Min(hn::Min(exit_of(0), exit_of(1)), exit_of(2));
      if constexpr (tests != Tests::fast) exit = hn::Mul(exit, hn::Set(d, slab_padding));
      hits |= bits_of(d, hn::Le(entry, hn::Min(exit, hn::Set(d, ray.end))))
              << i * int(hn::Lanes(d));
      if (entries != nullptr) hn::Store(entry, d, entries + i * hn::Lanes(d));
    }
    return hits;
  }

  // The blocks of a leaf wait for their rays.
  HWY_INLINE void put_off(const TriangleBlock* block, uint32_t instance, RayInTree* rays,
                          std::span<const Id> ids) {
    while (true) {
      for (const Id id : ids) {
        __builtin_prefetch(&rays[id].test);
        waiting_[waiting_count_++] = {block, &rays[id]};
        if (waiting_count_ == most_waiting) test_waiting(instance);
      }
      if ((block->triangle[0] & more_bit) == 0) return;
      ++block;
    }
  }

  // First the edges of all, since nobody can guess which ones a ray is inside of.
  HWY_NOINLINE void test_waiting(uint32_t instance) {
    const std::span<const Waiting> all(waiting_.data(), std::exchange(waiting_count_, 0));
    if constexpr (tests == Tests::fast || hn::MaxLanes(BlockLanes()) < block_size) {
      for (const auto& [block, ray] : all) {
        BlockHits found;
        const uint32_t hits = hit_block(*block, instance, *ray, found);
        take(*ray, instance, *block, hits, found);
      }
    } else {
      EdgeTests edges[most_waiting];
      uint32_t maybe[most_waiting];
      Waiting inside[most_waiting];
      size_t count = 0;
      for (const Waiting& one : all) {
        edges[count] = test_edges(*one.block, one.ray->test, 0);
        maybe[count] = inside_edges(edges[count]);
        inside[count] = one;
        count += size_t(maybe[count] != 0);
      }
      for (size_t i = 0; i < count; ++i) {
        const auto& [block, ray] = inside[i];
        const BoxRay box = box_in(instance, *ray);
        BlockHits found;
        uint32_t exact = 0;
        uint32_t hits = hit_lanes(*block, edges[i], maybe[i], ray->test.shear_z, box, ray->t_min,
                                  ray->t_max, 0, exact, found);
        if (exact != 0) [[unlikely]]
          hits |= test_exactly(*block, {ray->test, box}, ray->t_min, ray->t_max, exact, found);
        take(*ray, instance, *block, hits, found);
      }
    }
  }

  static HWY_INLINE void take(RayInTree& ray, uint32_t instance, const TriangleBlock& block,
                              uint32_t hits, const BlockHits& found) {
    for (; hits != 0; hits &= hits - 1) {
      const int lane = std::countr_zero(hits);
      const float t = found.t[lane];
      const uint32_t triangle = block.triangle[lane] & ~more_bit;
      if (t > ray.t_max || (t == ray.hit.t && !is_before(instance, triangle, ray.hit))) continue;
      ray.hit = {t, found.u[lane], found.v[lane], triangle, instance};
      end_at(ray, t);
      if (any_hit) ray.end = -1.0f;
    }
  }

  HWY_INLINE uint32_t hit_block(const TriangleBlock& block, uint32_t instance, const RayInTree& ray,
                                BlockHits& found) const {
    if constexpr (tests == Tests::fast) {
      return hit_triangles(block, ray.test, ray.t_min, ray.t_max, found);
    } else {
      const auto box_of = [&]() HWY_ATTR { return box_in(instance, ray); };
      return hit_triangles(block, ray.test, box_of, ray.t_min, ray.t_max, found);
    }
  }

  HWY_INLINE BoxRay box_in(uint32_t instance, const RayInTree& ray) const {
    if (ray.is_usual == 0) [[unlikely]] {
      return use_in(bvh_.instances[instance], rays_[ray.index],
                    [](const vec3& origin, const vec3& direction)
                        HWY_ATTR { return box_ray(origin, direction); });
    }
    const float4 origin = load4(ray.test.origin), inverse = load4(ray.inverse);
    return {origin, origin, inverse, inverse * broadcast(exit_padding)};
  }

  static HWY_INLINE void end_at(RayInTree& ray, float t) {
    ray.t_max = t;
    ray.end = t * end_padding<tests>;
  }

  std::array<Waiting, most_waiting> waiting_;
  size_t waiting_count_ = 0;
  const SceneBvh& bvh_;
  const Nodes& tlas_;
  std::span<const Ray> rays_;
  std::vector<RayInTree, LineAllocator<RayInTree>> in_scene_, in_instance_;
  Room room_in_scene_, room_in_instance_;
};

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
