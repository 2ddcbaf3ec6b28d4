// Streams: many rays that have nothing in common are under way in one thread, and each takes one
// step in turn. The steps of different rays do not wait for each other, what a ray will read next
// comes from memory meanwhile, and rays are sorted by the kind of their next step, so that the
// processor has little to guess. Each ray keeps its own stack and its own order.
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

#if HWY_TARGET != HWY_SCALAR
// Lanes in descending order, by a bitonic network (K. Batcher, Sorting Networks and Their
// Applications, 1968). Of four or eight lanes.
template <class D>
HWY_INLINE hn::Vec<D> descending(D d, hn::Vec<D> keys) {
  using V = hn::Vec<D>;
  const hn::RepartitionToWide<D> pairs;
  const auto by_neighbours = [&](V v) HWY_ATTR {
    const V other = hn::Shuffle2301(v);
    return hn::OddEven(hn::Min(v, other), hn::Max(v, other));
  };
  const auto by_pairs = [&](V v, V other) HWY_ATTR {
    return hn::BitCast(d, hn::OddEven(hn::BitCast(pairs, hn::Min(v, other)),
                                      hn::BitCast(pairs, hn::Max(v, other))));
  };
  keys = by_neighbours(keys);
  keys = by_pairs(keys, hn::Shuffle0123(keys));
  keys = by_neighbours(keys);
  if constexpr (hn::MaxLanes(D()) == 8) {
    const V other = hn::Reverse(d, keys);
    keys = hn::ConcatUpperLower(d, hn::Min(keys, other), hn::Max(keys, other));
    keys = by_pairs(keys, hn::Shuffle1032(keys));
    keys = by_neighbours(keys);
  }
  return keys;
}
#endif

// What a ray does next: open a node, test a block of triangles, or turn elsewhere: into an
// instance, out of it, or to its end.
enum StreamStep : uint32_t { open_node, test_block, turn };
inline constexpr uint32_t stream_steps = 3;

// Keeps a number a number: a compiler that knows what it stands for would rather branch.
HWY_INLINE void keep_number(uint32_t& number) {
  asm volatile("" : "+r"(number));
}

template <bool any_hit, class Nodes, Tests tests = Tests::watertight>
class StreamTraversal {
  using Node = std::remove_cvref_t<decltype(Nodes().nodes[0])>;
  static constexpr int W = Node::width;
  static constexpr uint32_t capacity = 32;  // rays under way

  // Entry distances are kept as integers, which sort alike. Their last bits hold the slot.
  static constexpr uint32_t slot_bits = 7;
  static constexpr uint32_t distance_bits = 0x7fffffff & ~slot_bits;
  using KeyLanes = hn::RebindToUnsigned<SlotLanes<W>>;

  // One of them, in the space of the tree that it is in.
  struct alignas(64) UnderWay {
    float from_near[4], from_far[4], inverse[4], padded[4];  // by axis, as in WideRay
    uint32_t near[4], far[4];
    float t_min, t_max;
    float end;          // of boxes that are worth a visit
    uint32_t last_key;  // the same for what waits
    uint32_t waiting;
    WideChild child;      // what is next
    uint32_t instance;    // none: in the TLAS
    uint32_t index;       // of the ray
    WideChild* children;  // the stack, and the keys of what waits there
    uint32_t* keys;
    const void* memory[2];  // of the tree's nodes, and blocks
    TriangleRayOf<tests> test;
    Hit hit;
  };

  // The rays under way by their next step.
  struct Sorted {
    uint32_t count[stream_steps] = {};
    uint32_t of[stream_steps][capacity];
    void put(StreamStep step, uint32_t slot) { of[step][count[step]++] = slot; }
  };

 public:
  StreamTraversal(const SceneBvh& bvh, const Nodes& tlas, std::span<const Ray> rays)
      : bvh_(bvh), tlas_(tlas), rays_(rays) {
    uint32_t depth = 0;
    for (const std::shared_ptr<const Blas>& blas : bvh.blases)
      if (const Nodes* tree = std::get_if<Nodes>(&blas->wide)) depth = std::max(depth, tree->depth);
    // All children but one for each level of two trees, the ray's and the instance's end, a next
    // entry; and whole vectors are written.
    const size_t room = size_t(W - 1) * (tlas.depth + depth + 2) + 3 + W;
    stacks_.resize(2 * room * capacity);
    for (uint32_t i = 0; i < capacity; ++i) {
      under_way_[i].children = stacks_.data() + 2 * room * i;
      under_way_[i].keys = under_way_[i].children + room;
    }
  }

  // answer(index of a ray, its hit), in any order.
  template <class Answer>
  void run(const Answer& answer) {
    Sorted lists[2];
    Sorted* now = &lists[0];
    Sorted* next = &lists[1];
    for (uint32_t slot = 0; slot < capacity; ++slot)
      if (begin_next(under_way_[slot], answer)) take_turn(slot, *now, answer);
    while (now->count[open_node] + now->count[test_block] > 0) {
      std::fill_n(next->count, stream_steps, 0u);
      for (uint32_t i = 0; i < now->count[open_node]; ++i)
        open(now->of[open_node][i], *next);
      for (uint32_t i = 0; i < now->count[test_block]; ++i)
        test(now->of[test_block][i], *next);
      for (uint32_t i = 0; i < next->count[turn]; ++i)
        take_turn(next->of[turn][i], *next, answer);
      std::swap(now, next);
    }
  }

 private:
  HWY_INLINE void open(uint32_t slot, Sorted& next) {
    UnderWay& ray = under_way_[slot];
    ray.waiting += push_children(static_cast<const Node*>(ray.memory[0])[ray.child], ray);
    ray.child = pop(ray);
    go_on(slot, ray, next);
  }

  HWY_INLINE void test(uint32_t slot, Sorted& next) {
    UnderWay& ray = under_way_[slot];
    const TriangleBlock& block =
        static_cast<const TriangleBlock*>(ray.memory[1])[ray.child & ~leaf_bit];
    BlockHits found;
    uint32_t hits = hit_triangles(block, ray.test, ray.t_min, ray.t_max, found);
    for (; hits != 0; hits &= hits - 1)
      take(ray, block, std::countr_zero(hits), found);
    ray.child = (block.triangle[0] & more_bit) != 0 ? ray.child + 1 : pop(ray);
    if (any_hit && is_hit(ray.hit)) {
      ray.child = no_child;
      ray.waiting = 0;
    }
    go_on(slot, ray, next);
  }

  static HWY_INLINE void take(UnderWay& ray, const TriangleBlock& block, int lane,
                              const BlockHits& found) {
    const float t = found.t[lane];
    const uint32_t triangle = block.triangle[lane] & ~more_bit;
    if (t > ray.t_max || (t == ray.hit.t && !is_before(ray.instance, triangle, ray.hit))) return;
    ray.hit = {t, found.u[lane], found.v[lane], triangle, ray.instance};
    end_at(ray, t);
  }

  // Those that the ray enters; the nearest one is on top. Says how many.
  static HWY_INLINE uint32_t push_children(const Node& node, UnderWay& ray) {
    const SlotLanes<W> d;
    const KeyLanes di;
    constexpr size_t lanes = hn::MaxLanes(SlotLanes<W>());
    ChildSpans<W> spans;
    const uint32_t hits = hit_children<tests>(node, ray, ray.t_min, ray.end, spans);
    const auto count = uint32_t(std::popcount(hits));
    WideChild* children = ray.children + ray.waiting;
    uint32_t* keys = ray.keys + ray.waiting;
    const uint8_t bits[8] = {uint8_t(hits)};
    if constexpr (lanes == W && any_hit) {
      hn::StoreU(hn::Compress(hn::Load(di, node.child), hn::LoadMaskBits(di, bits)), di, children);
    } else if constexpr (lanes == W) {
      const auto distances =
          hn::And(hn::BitCast(di, hn::Load(d, spans.entry)), hn::Set(di, distance_bits));
      const auto sorted = descending(
          di, hn::IfThenElseZero(hn::LoadMaskBits(di, bits), hn::Or(distances, hn::Iota(di, 0))));
      // Lanes of no child have key 0, too, and come after those that do.
      const auto slots = hn::IndicesFromVec(di, hn::And(sorted, hn::Set(di, slot_bits)));
      hn::StoreU(sorted, di, keys);
      hn::StoreU(hn::TableLookupLanes(hn::Load(di, node.child), slots), di, children);
    } else {
      uint32_t left = hits;
      for (uint32_t i = 0; i < count; ++i, left &= left - 1) {
        const int slot = std::countr_zero(left);
        const uint32_t key =
            (std::bit_cast<uint32_t>(spans.entry[slot]) & distance_bits) | uint32_t(slot);
        uint32_t place = i;
        for (; !any_hit && place > 0 && keys[place - 1] < key; --place) {
          keys[place] = keys[place - 1];
          children[place] = children[place - 1];
        }
        keys[place] = key;
        children[place] = node.child[slot];
      }
    }
    return count;
  }

  static HWY_INLINE void push(UnderWay& ray, WideChild child) {
    ray.children[ray.waiting] = child;
    ray.keys[ray.waiting++] = 0;
  }

  static HWY_INLINE WideChild pop(UnderWay& ray) {
    uint32_t top = ray.waiting - 1;
    while (!any_hit && ray.keys[top] > ray.last_key)
      --top;
    ray.waiting = top;
    return ray.children[top];
  }

  static HWY_INLINE void end_at(UnderWay& ray, float t) {
    ray.t_max = t;
    ray.end = t * end_padding<tests>;
    ray.last_key = std::bit_cast<uint32_t>(ray.end) | slot_bits;
  }

  // Sorts the ray in, and fetches what it will read.
  static HWY_INLINE void go_on(uint32_t slot, const UnderWay& ray, Sorted& next) {
    const uint32_t leaf = ray.child >> 31;
    const auto elsewhere = uint32_t(ray.instance == none) | uint32_t(ray.child == no_child);
    uint32_t step = leaf + (leaf & elsewhere);
    keep_number(step);
    next.put(StreamStep(step), slot);
    static constexpr size_t sizes[stream_steps] = {sizeof(Node), sizeof(TriangleBlock), 0};
    const char* at =
        static_cast<const char*>(ray.memory[leaf]) + (ray.child & ~leaf_bit) * sizes[step];
    constexpr size_t line = 64;
    for (size_t i = 0; i < sizeof(Node) / line; ++i)
      __builtin_prefetch(at + i * line);
  }

  // Until the ray has a node or a block before it; or the next one has, in its place.
  template <class Answer>
  HWY_INLINE void take_turn(uint32_t slot, Sorted& next, const Answer& answer) {
    UnderWay& ray = under_way_[slot];
    while (is_leaf(ray.child) && (ray.instance == none || ray.child == no_child)) {
      if (ray.child != no_child) {
        enter(ray, tlas_.entries[ray.child & ~leaf_bit]);
      } else if (ray.waiting > 0) {
        leave(ray);
      } else {
        answer(ray.index, ray.hit);
        if (!begin_next(ray, answer)) return;
      }
    }
    go_on(slot, ray, next);
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
    ray.waiting = 0;
    push(ray, no_child);
    aim(ray, from.origin, from.direction);
    go_to(ray, tlas_, none);
    // A single instance needs no way through the TLAS.
    if (tlas_.entries.size() == 1) {
      ray.waiting = 0;
      enter(ray, tlas_.entries[0]);
    }
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
    ray.memory[0] = tree.nodes.data();
    ray.memory[1] = tree.blocks.data();
    ray.instance = instance;
    ray.child = 0;
  }

  static HWY_INLINE void aim(UnderWay& ray, const vec3& origin, const vec3& direction) {
    const BoxRay box = box_ray<tests>(origin, direction);
    const int4 backwards = box.inverse < broadcast(0.0f);
    const int4 nearest = int4{0, 2, 4, 0} - backwards;  // true is -1
    const int4 furthest = int4{1, 3, 5, 0} + backwards;
    if constexpr (tests == Tests::fast) {
      const float4 near = box.from_lo * box.inverse;
      std::memcpy(ray.from_near, &near, sizeof near);
    } else {
      const float4 near = backwards ? box.from_hi : box.from_lo;
      const float4 far = backwards ? box.from_lo : box.from_hi;
      std::memcpy(ray.from_near, &near, sizeof near);
      std::memcpy(ray.from_far, &far, sizeof far);
      std::memcpy(ray.padded, &box.padded, sizeof box.padded);
    }
    std::memcpy(ray.inverse, &box.inverse, sizeof box.inverse);
    std::memcpy(ray.near, &nearest, sizeof nearest);
    std::memcpy(ray.far, &furthest, sizeof furthest);
    ray.test = triangle_ray<tests>(origin, direction, box);
  }

  const SceneBvh& bvh_;
  const Nodes& tlas_;
  std::span<const Ray> rays_;
  uint32_t begun_ = 0;  // of the rays
  std::vector<uint32_t> stacks_;
  std::array<UnderWay, capacity> under_way_;
};

}  // namespace tracer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
