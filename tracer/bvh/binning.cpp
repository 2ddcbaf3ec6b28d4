#include "tracer/bvh/binning.h"

namespace tracer {

void fill(Histogram& histogram, const Binning& binning, const Range& range,
          std::span<const Reference> all) {
  histogram.clear(binning.bins);
  if (range.size() < min_parallel) {
    histogram.add(binning, all.subspan(range.begin, range.size()));
    return;
  }
  std::vector<Histogram> pieces((range.size() + chunk_size - 1) / chunk_size);
  for_chunks(range.begin, range.end, [&](size_t chunk, uint32_t begin, uint32_t end) {
    pieces[chunk].clear(binning.bins);
    pieces[chunk].add(binning, all.subspan(begin, end - begin));
  });
  for (const Histogram& piece : pieces)
    histogram.add(piece, binning.bins);
}

}  // namespace tracer
