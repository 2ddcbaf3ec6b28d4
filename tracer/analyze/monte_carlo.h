// Means by random sampling: the same for any number of threads, and stopped when good enough.
#pragma once

#include <algorithm>
#include <cmath>
#include <stop_token>
#include <vector>

#include <tbb/parallel_for.h>

#include "tracer/math/rng.h"

namespace tracer {

// Sampling ends when the standard error is at most this share of the mean, or at most
// absolute_error, or when max_samples are taken.
struct SampleLimits {
  double relative_error = 0.01;
  double absolute_error = 0.0;
  uint64_t max_samples = 1 << 21;
};

struct Estimate {
  double mean = 0.0;
  double standard_error = 0.0;
  uint64_t samples = 0;
};

// sample(share, rng) gives the value at a place that share, evenly in [0, 1), chooses; it is called
// from many threads, mostly with rising shares, which is kind to caches. Stopped: what the complete
// rounds tell.
//
// Each round cuts [0, 1) into strata of equal size with two samples a and b each. The variance of
// a + b in a stratum is estimated by (a - b)^2; what differs between strata costs nothing.
template <class Sample>
Estimate estimate_mean(const SampleLimits& limits, uint64_t seed, const std::stop_token& stop,
                       const Sample& sample) {
  constexpr uint64_t chunk_strata = 64;  // of one random stream
  constexpr uint64_t chunk_samples = 2 * chunk_strata;
  constexpr uint64_t first_chunks = 8;
  // The error is not known before some samples were different from 0; rare ones may not exist.
  constexpr uint64_t enough_values = 512;
  constexpr uint64_t enough_samples = 8192;
  struct Chunk {
    double sum = 0.0;
    double squares = 0.0;
    uint64_t values = 0;  // other than 0
  };

  Estimate result;
  Chunk all;
  uint64_t chunks_done = 0;
  uint64_t next_chunks = first_chunks;
  while (result.samples < limits.max_samples) {
    std::vector<Chunk> round(next_chunks);
    const double strata = double(round.size() * chunk_strata);
    tbb::parallel_for(size_t{0}, round.size(), [&](size_t chunk) {
      if (stop.stop_requested()) return;
      Rng rng = make_rng(seed, chunks_done + chunk);
      const auto value_in = [&](uint64_t stratum) {
        const double jitter = (next(rng) + next(rng) * 0x1p-32) * 0x1p-32;
        return double(sample(std::min((double(stratum) + jitter) / strata, 1.0 - 0x1p-53), rng));
      };
      for (uint64_t i = 0; i < chunk_strata; ++i) {
        const double a = value_in(chunk * chunk_strata + i);
        const double b = value_in(chunk * chunk_strata + i);
        round[chunk].sum += a + b;
        round[chunk].squares += (a - b) * (a - b);
        round[chunk].values += uint64_t(a != 0.0) + uint64_t(b != 0.0);
      }
    });
    if (stop.stop_requested()) return result;
    for (const Chunk& chunk : round) {
      all.sum += chunk.sum;
      all.squares += chunk.squares;
      all.values += chunk.values;
    }
    chunks_done += round.size();
    result.samples = chunks_done * chunk_samples;
    result.mean = all.sum / double(result.samples);
    result.standard_error = std::sqrt(all.squares) / double(result.samples);

    const double wanted = std::max(limits.relative_error * result.mean, limits.absolute_error);
    const bool is_known = all.values >= enough_values || result.samples >= enough_samples;
    if (is_known && result.standard_error <= wanted) break;
    // A little more than what the error so far asks for.
    const double missing = wanted > 0.0 ? result.standard_error / wanted : 1.0;
    const double factor = std::clamp(1.05 * missing * missing, 1.25, 3.0);
    next_chunks = uint64_t(std::ceil((factor - 1.0) * double(chunks_done)));
    const uint64_t left = limits.max_samples - std::min(limits.max_samples, result.samples);
    next_chunks = std::clamp<uint64_t>(next_chunks, 1, left / chunk_samples + 1);
  }
  return result;
}

}  // namespace tracer
