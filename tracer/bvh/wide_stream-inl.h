// Streams: many rays that have nothing in common are under way in one thread, and each takes one
// step in turn. The steps of different rays do not wait for each other, what a ray will read next
// comes from memory meanwhile, and rays are sorted by the kind of their next step, so that the
// processor has little to guess. Each ray keeps its own stack and its own order. A step is longer
// than that of a ray alone, and pays where rays have little in common or much to wait for.
// C. Gribble, K. Ramani, Coherent Ray Tracing via Stream Filtering, 2008 (rays sorted by what they
// do next); R. Barringer, T. Akenine-Moeller, Dynamic Ray Stream Traversal, 2014.
// Compiled once for each instruction set.
#if defined(TRACER_BVH_WIDE_STREAM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRACER_BVH_WIDE_STREAM_INL_H_
#undef TRACER_BVH_WIDE_STREAM_INL_H_
#else
#define TRACER_BVH_WIDE_STREAM_INL_H_
#endif

#include "tracer/bvh/wide_traverse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tracer::HWY_NAMESPACE {

// What a ray does next, by the upper two bits of its child: open a node, test a block of triangles,
// or turn elsewhere: out of an instance, to its end, or into an instance. Trees have fewer than
// 2^30 nodes and blocks: more would take 128 GiB.
enum StreamStep : uint32_t { open_node = 0, test_block = 2, turn = 3 };
inline constexpr uint32_t stream_steps = 4;
inline constexpr uint32_t step_shift = 30;
static_assert(leaf_bit >> step_shift == test_block && no_child >> step_shift == turn);

template <bool any_hit, class Nodes, Tests tests = Tests::watertight>
class StreamTraversal {
  using Node = std::remove_cvref_t<decltype(Nodes().nodes[0])>;
  static constexpr int W = Node::width;
  static constexpr uint32_t capacity = 32;  // rays under way

  // One of them, in the space of the tree that it is in.
  struct alignas(64) UnderWay {
    float from_near[4], from_far[4], near_inverse[4], far_inverse[4];  // by axis, as in WideSlabRay
    uint32_t near[4], far[4];
    float t_min, t_max;
    float end;          // of boxes that are worth a visit
    WideChild child;    // what is next
    uint32_t instance;  // none: in the TLAS
    uint32_t in_tlas;   // 1 there, else 0
    uint32_t index;     // of the ray
    WaitingKey* stack;
    WaitingKey* top;                   // of the stack: behind the last one that waits
    const char* memory[stream_steps];  // of the tree's nodes, and blocks
    TriangleRayOf<tests> test;
    Hit hit;
  };

  // The rays under way by their next step.
  struct Sorted {
    uint32_t count[stream_steps] = {};
    UnderWay* of[stream_steps][capacity];
    std::span<UnderWay* const> rays(StreamStep step) const { return {of[step], count[step]}; }
  };

 public:
  StreamTraversal(const SceneBvh& bvh, const Nodes& tlas, std::span<const Ray> rays)
      : bvh_(bvh), tlas_(tlas), rays_(rays) {
    uint32_t depth = 0;
    for (const std::shared_ptr<const Blas>& blas : bvh.blases)
      if (const Nodes* tree = std::get_if<Nodes>(&blas->wide)) depth = std::max(depth, tree->depth);
    // All children but one for each level of two trees, the ray's and the instance's end, a next
    // entry; and two are written at once.
    const size_t room = size_t(W - 1) * (tlas.depth + depth + 2) + 5;
    stacks_.resize(room * capacity);
    for (uint32_t i = 0; i < capacity; ++i)
      under_way_[i].stack = stacks_.data() + room * i;
  }

  // answer(index of a ray, its hit), in any order.
  template <class Answer>
  void run(const Answer& answer) {
    Sorted lists[2];
    Sorted* now = &lists[0];
    Sorted* next = &lists[1];
    for (UnderWay& ray : under_way_)
      if (begin_next(ray, answer)) take_turn(ray, *now, answer);
    while (now->count[open_node] + now->count[test_block] > 0) {
      std::fill_n(next->count, stream_steps, 0u);
      // Two loops over the same rays: what the second one of a ray waits for is long there.
      for (UnderWay* ray : now->rays(open_node))
        push_children(*ray);
      for (UnderWay* ray : now->rays(open_node)) {
        ray->child = pop(*ray);
        go_on(*ray, *next);
      }
      for (UnderWay* ray : now->rays(test_block))
        test(*ray, *next);
      for (UnderWay* ray : next->rays(turn))
        take_turn(*ray, *next, answer);
      std::swap(now, next);
    }
  }

 private:
  HWY_INLINE void test(UnderWay& ray, Sorted& next) {
    const TriangleBlock& block =
        reinterpret_cast<const TriangleBlock*>(ray.memory[test_block])[ray.child & ~leaf_bit];
    BlockHits found;
    uint32_t hits = hit_triangles(block, ray.test, ray.t_min, ray.t_max, found);
    for (; hits != 0; hits &= hits - 1)
      take(ray, block, std::countr_zero(hits), found);
    if ((block.triangle[0] & more_bit) != 0)
      ++ray.child;
    else
      ray.child = pop(ray);
    if (any_hit && is_hit(ray.hit)) {
      ray.child = no_child;
      ray.top = ray.stack;
    }
    go_on(ray, next);
  }

  static HWY_INLINE void take(UnderWay& ray, const TriangleBlock& block, int lane,
                              const BlockHits& found) {
    const float t = found.t[lane];
    const uint32_t triangle = block.triangle[lane] & ~more_bit;
    if (t > ray.t_max || (t == ray.hit.t && !is_before(ray.instance, triangle, ray.hit))) return;
    ray.hit = {t, found.u[lane], found.v[lane], triangle, ray.instance};
    end_at(ray, t);
  }

  // Those that the ray enters; the nearest one is on top, any hit: the last slot. Two are written
  // whether they are there or not: most nodes have no more.
  static HWY_INLINE void push_children(UnderWay& ray) {
    const Node& node = reinterpret_cast<const Node*>(ray.memory[open_node])[ray.child];
    ChildSpans<W> spans;
    uint32_t hits = hit_children(node, ray, ray.t_min, ray.end, spans);
    const auto count = std::popcount(hits);
    WaitingKey* const stack = ray.top;
    ray.top += count;
    WaitingKey first = take_slot<any_hit>(node, spans, hits);
    WaitingKey second = take_slot<any_hit>(node, spans, hits);
    if constexpr (!any_hit) {
      second &= -WaitingKey(count > 1);
      sort_pair(second, first);
    }
    stack[0] = first;
    stack[1] = second;
    if (count > 2) [[unlikely]] {
      for (WaitingKey* place = stack + 2; place < ray.top; ++place) {
        *place = take_slot<any_hit>(node, spans, hits);
        if constexpr (!any_hit)
          for (WaitingKey* at = place; at > stack && at[-1] < at[0]; --at)
            std::swap(at[-1], at[0]);
      }
    }
  }

  static HWY_INLINE void push(UnderWay& ray, WideChild child) { *ray.top++ = child; }

  static HWY_INLINE WideChild pop(UnderWay& ray) {
    const WaitingKey last = last_key(ray.end);
    do
      --ray.top;
    while (!any_hit && *ray.top > last);
    return WideChild(*ray.top);
  }

  static HWY_INLINE void end_at(UnderWay& ray, float t) {
    ray.t_max = t;
    ray.end = t * end_padding<tests>;
  }

  // Sorts the ray in, and fetches what it will read.
  static HWY_INLINE void go_on(UnderWay& ray, Sorted& next) {
    uint32_t step = ray.child >> step_shift;
    step |= step >> 1 & ray.in_tlas;
    next.of[step][next.count[step]++] = &ray;
    static constexpr size_t sizes[stream_steps] = {sizeof(Node), 0, sizeof(TriangleBlock), 0};
    const char* at = ray.memory[step] + (ray.child & ~leaf_bit) * sizes[step];
    constexpr size_t line = 64;
    for (size_t i = 0; i < sizeof(Node) / line; ++i)
      __builtin_prefetch(at + i * line);
  }

  // Until the ray has a node or a block before it; or the next one has, in its place.
  template <class Answer>
  HWY_INLINE void take_turn(UnderWay& ray, Sorted& next, const Answer& answer) {
    while (is_leaf(ray.child) && (ray.instance == none || ray.child == no_child)) {
      if (ray.child != no_child) {
        enter(ray, tlas_.entries[ray.child & ~leaf_bit]);
      } else if (ray.top > ray.stack) {
        leave(ray);
      } else {
        answer(ray.index, ray.hit);
        if (!begin_next(ray, answer)) return;
      }
    }
    go_on(ray, next);
  }

  // False if no ray is left.
  template <class Answer>
  HWY_INLINE bool begin_next(UnderWay& ray, const Answer& answer) {
    while (begun_ < rays_.size() && !is_valid(rays_[begun_]))
      answer(begun_++, Hit{});
    if (begun_ == rays_.size()) return false;
    const Ray& from = rays_[begun_];
    ray.index = begun_++;
    ray.hit = {};
    ray.t_min = std::max(0.0f, from.t_min);
    end_at(ray, from.t_max);
    ray.top = ray.stack;
    aim(ray, from.origin, from.direction);
    // A single instance needs no way through the TLAS.
    if (tlas_.entries.size() == 1) {
      enter(ray, tlas_.entries[0]);
      return true;
    }
    push(ray, no_child);
    go_to(ray, tlas_, none);
    return true;
  }

  HWY_INLINE void enter(UnderWay& ray, const WideEntry& entry) {
    if ((entry.instance & more_bit) != 0) push(ray, ray.child + 1);
    push(ray, no_child);
    const uint32_t id = entry.instance & ~more_bit;
    const PlacedInstance& instance = bvh_.instances[id];
    if (!instance.in_place) {
      const Ray& from = rays_[ray.index];
      aim(ray, moved(instance.to_object, from.origin), turned(instance.to_object, from.direction));
    }
    go_to(ray, std::get<Nodes>(bvh_.blases[instance.mesh]->wide), id);
    ray.child = entry.at.child;
  }

  HWY_INLINE void leave(UnderWay& ray) {
    if (!bvh_.instances[ray.instance].in_place) {
      const Ray& from = rays_[ray.index];
      aim(ray, from.origin, from.direction);
    }
    go_to(ray, tlas_, none);
    ray.child = pop(ray);
  }

  static HWY_INLINE void go_to(UnderWay& ray, const Nodes& tree, uint32_t instance) {
    ray.memory[open_node] = reinterpret_cast<const char*>(tree.nodes.data());
    ray.memory[test_block] = reinterpret_cast<const char*>(tree.blocks.data());
    ray.memory[turn] = ray.memory[open_node];
    ray.instance = instance;
    ray.in_tlas = uint32_t(instance == none);
    ray.child = 0;
  }

  static HWY_INLINE void aim(UnderWay& ray, const vec3& origin, const vec3& direction) {
    const SlabRay slab = slab_ray<tests>(origin, direction);
    const int4 backwards = slab.near_inverse < broadcast(0.0f);
    const int4 nearest = int4{0, 2, 4, 0} - backwards;  // true is -1
    const int4 furthest = int4{1, 3, 5, 0} + backwards;
    std::memcpy(ray.from_near, &slab.from_near, sizeof slab.from_near);
    std::memcpy(ray.from_far, &slab.from_far, sizeof slab.from_far);
    std::memcpy(ray.near_inverse, &slab.near_inverse, sizeof slab.near_inverse);
    std::memcpy(ray.far_inverse, &slab.far_inverse, sizeof slab.far_inverse);
    std::memcpy(ray.near, &nearest, sizeof nearest);
    std::memcpy(ray.far, &furthest, sizeof furthest);
    ray.test = triangle_ray<tests>(origin, direction, box_ray<tests>(origin, direction));
  }

  const SceneBvh& bvh_;
  const Nodes& tlas_;
  std::span<const Ray> rays_;
  uint32_t begun_ = 0;  // of the rays
  std::vector<WaitingKey> stacks_;
  std::array<UnderWay, capacity> under_way_;
};

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
