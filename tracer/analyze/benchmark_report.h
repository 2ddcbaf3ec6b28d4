// A benchmark as JSON, as comma separated values, and as tables for a terminal.
#pragma once

#include "tracer/analyze/benchmark.h"
#include "tracer/analyze/report.h"

namespace tracer {

struct BenchmarkFacts {
  const Scene& scene;
  const BenchmarkOptions& options;
  std::span<const PeerRow> peers;
  std::string_view missing_peers;  // a sentence, or ""
};

Json benchmark_json(const BenchmarkFacts& facts, const Benchmark& benchmark);
// A line a row, builds first; what a row does not have is empty.
std::string benchmark_csv(const Benchmark& benchmark);
std::string benchmark_text(const BenchmarkFacts& facts, const Benchmark& benchmark);

}  // namespace tracer
