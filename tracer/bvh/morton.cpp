#include "tracer/bvh/morton.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <functional>
#include <numeric>

namespace tracer {

namespace {

constexpr int digit_bits = 11;
constexpr uint32_t digits = 1u << digit_bits;
constexpr uint32_t small = 2048;  // codes that fit into the cache: sorted by comparing them
constexpr int place_bits = 11;    // of a place among them
constexpr int bin_bits = 7;       // that many are sorted by before they are compared
constexpr uint32_t bins = 1u << bin_bits;

// Two zeros before each of 21 bits.
uint64_t spread(uint32_t value) {
  uint64_t x = value;
  x = (x | x << 32) & 0x001f00000000ffffull;
  x = (x | x << 16) & 0x001f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

struct Digits {
  int shift;
  uint32_t of(const MortonCode& code) const {
    return static_cast<uint32_t>(code.code >> shift) & (digits - 1);
  }
};

// The bits in which codes[begin, end) are not all alike.
uint64_t differing_bits(const UntouchedVector<MortonCode>& codes, uint32_t begin, uint32_t end) {
  std::vector<uint64_t> pieces((end - begin + chunk_size - 1) / chunk_size);
  for_chunks(begin, end, [&](size_t chunk, uint32_t from, uint32_t to) {
    uint64_t differ = 0;
    for (uint32_t i = from; i < to; ++i)
      differ |= codes[i].code ^ codes[begin].code;
    pieces[chunk] = differ;
  });
  return std::accumulate(pieces.begin(), pieces.end(), uint64_t{0}, std::bit_or<>());
}

// Writes from[begin, end) to the same places of `to`, sorted; at most `small` codes that differ in
// their lowest `bits` only. What they differ in and their place make one number.
void sort_few(const UntouchedVector<MortonCode>& from, UntouchedVector<MortonCode>& to,
              uint32_t begin, uint32_t end, int bits) {
  assert(bits + place_bits <= 64);
  const uint64_t mask = (uint64_t{1} << bits) - 1;
  const uint32_t count = end - begin;
  const auto low_bits = [&](uint32_t i) { return from[begin + i].code & mask; };
  std::array<uint64_t, small> keys;
  if (count < bins) {
    for (uint32_t i = 0; i < count; ++i)
      keys[i] = low_bits(i) << place_bits | i;
    std::sort(keys.begin(), keys.begin() + count);
  } else {
    const int shift = std::max(bits - bin_bits, 0);
    std::array<uint32_t, bins + 1> ends{};
    for (uint32_t i = 0; i < count; ++i)
      ++ends[(low_bits(i) >> shift) + 1];
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    for (uint32_t i = 0; i < count; ++i)
      keys[ends[low_bits(i) >> shift]++] = low_bits(i) << place_bits | i;
    for (uint32_t bin = 0, first = 0; bin < bins; first = ends[bin++])
      if (ends[bin] > first + 1) std::sort(keys.begin() + first, keys.begin() + ends[bin]);
  }
  for (uint32_t i = 0; i < count; ++i)
    to[begin + i] = from[begin + (keys[i] & (small - 1))];
}

// Sorts codes[begin, end), which are in the order of their primitives; `moved` is room to work in.
// A radix sort from the highest digit that differs, stable: counts by chunk tell each chunk where
// its codes go.
void sort(UntouchedVector<MortonCode>& codes, UntouchedVector<MortonCode>& moved, uint32_t begin,
          uint32_t end) {
  const uint32_t count = end - begin;
  if (count <= small) {
    std::sort(codes.begin() + begin, codes.begin() + end,
              [](const MortonCode& a, const MortonCode& b) {
                return a.code != b.code ? a.code < b.code : a.primitive < b.primitive;
              });
    return;
  }
  const uint64_t differ = differing_bits(codes, begin, end);
  if (differ == 0) return;
  const Digits digit{std::max(static_cast<int>(std::bit_width(differ)) - digit_bits, 0)};
  using Counts = std::array<uint32_t, digits>;
  std::vector<Counts> chunks((count + chunk_size - 1) / chunk_size, Counts{});
  for_chunks(begin, end, [&](size_t chunk, uint32_t from, uint32_t to) {
    for (uint32_t i = from; i < to; ++i)
      ++chunks[chunk][digit.of(codes[i])];
  });
  std::vector<uint32_t> starts(digits + 1, end);
  uint32_t place = begin;
  for (uint32_t value = 0; value < digits; ++value) {
    starts[value] = place;
    for (Counts& counts : chunks) {
      const uint32_t here = counts[value];
      counts[value] = place;
      place += here;
    }
  }
  for_chunks(begin, end, [&](size_t chunk, uint32_t from, uint32_t to) {
    for (uint32_t i = from; i < to; ++i)
      moved[chunks[chunk][digit.of(codes[i])]++] = codes[i];
  });
  tbb::parallel_for(uint32_t{0}, digits, [&](uint32_t value) {
    const uint32_t from = starts[value], to = starts[value + 1];
    if (to - from <= small) {
      sort_few(moved, codes, from, to, digit.shift);
      return;
    }
    std::copy(moved.begin() + from, moved.begin() + to, codes.begin() + from);
    if (digit.shift > 0) sort(codes, moved, from, to);
  });
}

}  // namespace

UntouchedVector<MortonCode> morton_order(std::span<const Box> boxes) {
  const auto count = static_cast<uint32_t>(boxes.size());
  const auto centroid2 = [&](uint32_t i) { return boxes[i].lo + boxes[i].hi; };
  std::vector<Box> pieces((count + chunk_size - 1) / chunk_size);
  for_chunks(0, count, [&](size_t chunk, uint32_t begin, uint32_t end) {
    Box box;
    for (uint32_t i = begin; i < end; ++i)
      box = grown(box, centroid2(i));
    pieces[chunk] = box;
  });
  Box all;
  for (const Box& piece : pieces)
    all = united(all, piece);
  const vec3 size = extent(all);
  const float largest = std::max(std::max(size.x, size.y), size.z);
  constexpr float cells = 2097151.0f;
  const float scale = largest > 0.0f && std::isfinite(cells / largest) ? cells / largest : 0.0f;

  UntouchedVector<MortonCode> codes(count), moved(count);
  for_chunks(0, count, [&](size_t, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i) {
      const vec3 cell = (centroid2(i) - all.lo) * scale;
      codes[i] = {spread(static_cast<uint32_t>(cell.x)) << 2 |
                      spread(static_cast<uint32_t>(cell.y)) << 1 |
                      spread(static_cast<uint32_t>(cell.z)),
                  i};
    }
  });
  sort(codes, moved, 0, count);
  return codes;
}

uint32_t first_change(std::span<const MortonCode> codes, uint32_t begin, uint32_t end) {
  const uint64_t differ = codes[begin].code ^ codes[end - 1].code;
  if (differ == 0) return begin + (end - begin) / 2;
  const uint64_t bit = std::bit_floor(differ);
  if (end - begin <= 16) {  // quicker than a search that cannot be predicted
    uint32_t first = begin + 1;
    while (!(codes[first].code & bit))
      ++first;
    return first;
  }
  const auto first = std::partition_point(codes.begin() + begin, codes.begin() + end,
                                          [bit](const MortonCode& c) { return !(c.code & bit); });
  return static_cast<uint32_t>(first - codes.begin());
}

}  // namespace tracer
