#include "tracer/bvh/morton.h"

#include <algorithm>
#include <array>
#include <bit>

namespace tracer {

namespace {

constexpr int digit_bits = 8;
constexpr uint32_t digits = 1u << digit_bits;

// Two zeros before each of 21 bits.
uint64_t spread(uint32_t value) {
  uint64_t x = value;
  x = (x | x << 32) & 0x001f00000000ffffull;
  x = (x | x << 16) & 0x001f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

// One pass of a stable radix sort: counts by chunk tell each chunk where its codes go.
void sort_by_digit(const std::vector<MortonCode>& from, std::vector<MortonCode>& to, int shift) {
  const auto count = static_cast<uint32_t>(from.size());
  using Counts = std::array<uint32_t, digits>;
  std::vector<Counts> chunks((count + chunk_size - 1) / chunk_size, Counts{});
  for_chunks(0, count, [&](size_t chunk, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i)
      ++chunks[chunk][from[i].code >> shift & (digits - 1)];
  });
  uint32_t place = 0;
  for (uint32_t digit = 0; digit < digits; ++digit) {
    for (Counts& counts : chunks) {
      const uint32_t here = counts[digit];
      counts[digit] = place;
      place += here;
    }
  }
  for_chunks(0, count, [&](size_t chunk, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i)
      to[chunks[chunk][from[i].code >> shift & (digits - 1)]++] = from[i];
  });
}

}  // namespace

std::vector<MortonCode> morton_order(std::span<const Reference> references) {
  const auto count = static_cast<uint32_t>(references.size());
  const Bounds box = measured(references, 0, count).centroids;
  const float4 size = box.hi - box.lo;
  const float largest = std::max(std::max(size[0], size[1]), size[2]);
  constexpr float cells = 2097151.0f;
  const float scale = largest > 0.0f && std::isfinite(cells / largest) ? cells / largest : 0.0f;

  std::vector<MortonCode> codes(count), sorted(count);
  for_chunks(0, count, [&](size_t, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i) {
      const float4 cell = (centroid2(references[i]) - box.lo) * broadcast(scale);
      codes[i] = {spread(static_cast<uint32_t>(cell[0])) << 2 |
                      spread(static_cast<uint32_t>(cell[1])) << 1 |
                      spread(static_cast<uint32_t>(cell[2])),
                  i};
    }
  });
  for (int shift = 0; shift < 64; shift += digit_bits) {
    sort_by_digit(codes, sorted, shift);
    codes.swap(sorted);
  }
  return codes;
}

uint32_t first_change(std::span<const MortonCode> codes, uint32_t begin, uint32_t end) {
  const uint64_t differ = codes[begin].code ^ codes[end - 1].code;
  if (differ == 0) return begin + (end - begin) / 2;
  const uint64_t bit = std::bit_floor(differ);
  const auto first = std::partition_point(codes.begin() + begin, codes.begin() + end,
                                          [bit](const MortonCode& c) { return !(c.code & bit); });
  return static_cast<uint32_t>(first - codes.begin());
}

}  // namespace tracer
