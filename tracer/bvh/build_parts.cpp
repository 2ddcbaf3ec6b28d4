#include "tracer/bvh/build_parts.h"

namespace tracer {

UntouchedVector<Reference> references_of(const BuildInput& input) {
  const auto count = static_cast<uint32_t>(input.boxes.size());
  UntouchedVector<Reference> references(count);
  for_chunks(0, count, [&](size_t, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i) {
      const Box& box = input.boxes[i];
      references[i].lo = float4{box.lo.x, box.lo.y, box.lo.z, std::bit_cast<float>(i)};
      references[i].hi = float4{box.hi.x, box.hi.y, box.hi.z, 0.0f};
    }
  });
  return references;
}

Range measured(std::span<const Reference> references, uint32_t begin, uint32_t end) {
  Range whole{begin, end, {}, {}};
  std::vector<Range> pieces((whole.size() + chunk_size - 1) / chunk_size);
  for_chunks(begin, end, [&](size_t chunk, uint32_t from, uint32_t to) {
    for (uint32_t i = from; i < to; ++i)
      add(pieces[chunk], references[i]);
  });
  for (const Range& piece : pieces) {
    whole.box.grow(piece.box);
    whole.centroids.grow(piece.centroids);
  }
  return whole;
}

}  // namespace tracer
