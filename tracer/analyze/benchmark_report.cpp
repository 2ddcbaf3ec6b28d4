// A benchmark for other programs.
#include "tracer/analyze/benchmark_report.h"

#include <fmt/format.h>

namespace tracer {
namespace {

Json build_row_json(const BuildTiming& row) {
  Json json = {{"builder", row.builder},
               {row.who.empty() ? "layout" : "quality", row.layout},
               {"threads", row.threads},
               {"ms", row.ms.median},
               {"ms_quartiles", {row.ms.low, row.ms.high}},
               {"builds", row.builds},
               {"mtris_per_s", row.mtris_per_s}};
  if (row.who.empty()) json["sah"] = row.sah;
  json["bytes_per_triangle"] = row.bytes_per_triangle;
  if (row.ratio > 0.0) json["ratio_to_peer"] = row.ratio;
  return json;
}

Json ray_row_json(const RayTiming& row) {
  Json json = {{"builder", row.builder},
               {row.who.empty() ? "layout" : "quality", row.layout},
               {"kernel", row.kernel}};
  if (row.who.empty()) {
    json["isa"] = row.isa.empty() ? Json() : Json(row.isa);
  } else {
    json["width_rays"] = row.width;
  }
  json.update({{"robust", row.robust},
               {"class", row.ray_class},
               {"view", row.view.empty() ? Json() : Json(row.view)},
               {"any_hit", row.any_hit},
               {"threads", row.threads},
               {"rays", row.rays},
               {"hits", row.hits},
               {"sum_t", row.any_hit ? Json() : Json(row.sum_t)},
               {"differing_rays", row.differ},
               {"agrees", row.agrees},
               {"mrays_per_s", row.mrays_per_s.median},
               {"mrays_per_s_quartiles", {row.mrays_per_s.low, row.mrays_per_s.high}},
               {"turns", row.turns}});
  Json ratios = Json::array();
  for (const RayTiming::Ratio& ratio : row.ratios)
    ratios.push_back({{"width_rays", ratio.width}, {"ratio", ratio.value}});
  if (row.who.empty()) json["ratios_to_peer"] = ratios;
  return json;
}

// The peer's name and version before what is known of its row.
Json with_peer(const BenchmarkFacts& facts, const std::string& who, const Json& row) {
  Json json = {{"name", who}};
  for (const PeerRow& peer : facts.peers)
    if (peer.id == who) json["version"] = peer.version;
  json.update(row);
  return json;
}

Json settings_of(const BenchmarkFacts& facts, const Benchmark& benchmark) {
  const BenchmarkOptions& options = facts.options;
  return {{"width", options.width},
          {"height", options.height},
          {"turns", options.turns},
          {"threads", options.threads},
          {"fast", options.fast},
          {"tolerated_share_of_peer_rays", tolerated_share},
          {"tolerated_share_of_fast_rays", tolerated_share_of_fast},
          {"complete", benchmark.complete}};
}

std::string number(double value) {
  return value > 0.0 ? fmt::format("{:.6g}", value) : "";
}

}  // namespace

Json benchmark_json(const BenchmarkFacts& facts, const Benchmark& benchmark) {
  Json builds = Json::array(), rays = Json::array();
  Json peers = Json::array(), peer_builds = Json::array();
  for (const BuildTiming& row : benchmark.builds) {
    const Json json = build_row_json(row);
    if (row.who.empty()) {
      builds.push_back(json);
    } else {
      peer_builds.push_back(with_peer(facts, row.who, json));
    }
  }
  for (const RayTiming& row : benchmark.rays) {
    const Json json = ray_row_json(row);
    if (row.who.empty()) {
      rays.push_back(json);
    } else {
      peers.push_back(with_peer(facts, row.who, json));
    }
  }
  return {{"schema", 1},
          {"scene", scene_json(facts.scene)},
          {"settings", settings_of(facts, benchmark)},
          {"builds", builds},
          {"rays", rays},
          {"peers", peers},
          {"peer_builds", peer_builds},
          {"missing_peers", facts.missing_peers},
          {"faults", benchmark.faults},
          {"machine", machine_json()}};
}

std::string benchmark_csv(const Benchmark& benchmark) {
  std::string csv =
      "what,who,builder,layout_or_quality,kernel,isa,class,view,threads,rays,hits,sum_t,"
      "differing_rays,mrays_per_s,mrays_per_s_low,mrays_per_s_high,ms,ms_low,ms_high,mtris_per_s,"
      "sah,bytes_per_triangle,robust\n";
  const auto who = [](const std::string& name) { return name.empty() ? "bvhscope" : name; };
  for (const BuildTiming& row : benchmark.builds) {
    csv += fmt::format("build,{},{},{},,,,,{},,,,,,,,{},{},{},{},{},{},\n", who(row.who),
                       row.builder, row.layout, row.threads, number(row.ms.median),
                       number(row.ms.low), number(row.ms.high), number(row.mtris_per_s),
                       number(row.sah), number(row.bytes_per_triangle));
  }
  for (const RayTiming& row : benchmark.rays) {
    csv += fmt::format("rays,{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},,,,,,,{}\n", who(row.who),
                       row.builder, row.layout, row.kernel, row.isa, row.ray_class, row.view,
                       row.threads, row.rays, row.hits,
                       row.any_hit ? "" : fmt::format("{:.17g}", row.sum_t), row.differ,
                       number(row.mrays_per_s.median), number(row.mrays_per_s.low),
                       number(row.mrays_per_s.high), row.robust);
  }
  return csv;
}

}  // namespace tracer
