// SPDX-License-Identifier: BSD-3-Clause
// The second half of a sequence into and against the map of what came before.
#include <utility>

#include "benchmarks.hpp"
#include "core/matching/discrete_search.hpp"
#include "core/scan/scan_sample.hpp"
#include "edgevox/map/map_builder.hpp"
#include "edgevox/mapping/pipeline.hpp"
#include "edgevox/matching/matcher.hpp"
#include "sequence.hpp"

namespace edgevox::bench {
namespace {

using benchmark::State;

MapBuilder mapOf(const Sequence& s, size_t scans, int clear_after = 0) {
  MapConfig config = s.config.map;
  config.clear_after = clear_after;
  MapBuilder map(s.config.voxel_size, config, s.config.edges, 1);
  for (size_t i = 0; i < scans; ++i) map.insert(s.centroids[i], s.poses[i].translation());
  map.label();
  return map;
}

/// Times `step`, for a scan, over the second half of the sequence. Between steps, not timed,
/// `between` works on the same map.
template <typename Step, typename Between>
void timeSteps(State& state, const std::string& name, const Step& step, const Between& between,
               int clear_after = 0) {
  const Sequence& s = sequence(name);
  const size_t count = s.size() - s.half();
  while (state.KeepRunningBatch(static_cast<int64_t>(count))) {
    state.PauseTiming();
    MapBuilder map = mapOf(s, s.half(), clear_after);
    for (size_t i = s.half(); i < s.size(); ++i) {
      between(map, s, i);
      state.ResumeTiming();
      step(map, s, i);
      state.PauseTiming();
    }
    { const MapBuilder freed = std::move(map); }
    state.ResumeTiming();
  }
}

void addScan(MapBuilder& map, const Sequence& s, size_t i) {
  map.add(s.centroids[i], s.poses[i].translation());
}

void labelIfDue(MapBuilder& map, const Sequence&, size_t) {
  if (map.labelDue()) map.label();
}

void insert(State& state, const std::string& name) { timeSteps(state, name, addScan, labelIfDue); }

void insertClearing(State& state, const std::string& name) {
  constexpr int kClearAfter = 5;
  timeSteps(state, name, addScan, labelIfDue, kClearAfter);
}

void label(State& state, const std::string& name) {
  timeSteps(
      state, name, [](MapBuilder& map, const Sequence&, size_t) { map.label(); }, addScan);
}

ScanSample sampleOf(const Sequence& s, size_t i) {
  const size_t count = Matcher(s.config.matcher).sampleSize();
  const Pose T_sensor_map = s.poses[i].inverse();
  ScanSample sample;
  for (const size_t position : sampleVoxels(s.scans[i], count)) {
    sample.push_back(T_sensor_map * s.centroids[i][position]);
  }
  return sample;
}

DiscreteSearch searchOf(const Sequence& s, const MapBuilder& map, const ScanSample& sample) {
  return {map.matchMap(), sample, static_cast<size_t>(s.config.matcher.search_points)};
}

void search(State& state, const std::string& name) {
  const Sequence& s = sequence(name);
  const MapBuilder map = mapOf(s, s.sample());
  const ScanSample sample = sampleOf(s, s.sample());
  const Pose guess = s.predicted(s.sample());
  for (auto _ : state) benchmark::DoNotOptimize(searchOf(s, map, sample).climb(guess));
}

void refine(State& state, const std::string& name) {
  const Sequence& s = sequence(name);
  const MapBuilder map = mapOf(s, s.sample());
  const ScanSample sample = sampleOf(s, s.sample());
  const Matcher matcher(s.config.matcher);
  Matcher::Refinement refinement;
  refinement.start = refinement.predicted.T_map_sensor =
      searchOf(s, map, sample).climb(s.predicted(s.sample()));
  for (auto _ : state) benchmark::DoNotOptimize(matcher.refine(map.matchMap(), sample, refinement));
}

/// All stages, a scan.
void pipeline(State& state, const std::string& name) {
  const Sequence& s = sequence(name);
  const size_t count = s.size() - s.half();
  size_t lost = 0;
  while (state.KeepRunningBatch(static_cast<int64_t>(count))) {
    state.PauseTiming();
    {
      Pipeline pipeline(s.config);
      for (size_t i = 0; i < s.half(); ++i) pipeline.process(s.clouds[i].view);
      state.ResumeTiming();
      for (size_t i = s.half(); i < s.size(); ++i) {
        lost += pipeline.process(s.clouds[i].view).scan.located() ? 0 : 1;
      }
      state.PauseTiming();
    }
    state.ResumeTiming();
  }
  if (lost != 0) state.SkipWithError("a scan was lost");
}

}  // namespace

void addMapBenchmarks(const std::string& sequence_name) {
  add("insert", sequence_name, insert);
  add("insert_clearing", sequence_name, insertClearing);
  add("label", sequence_name, label);
  add("search", sequence_name, search);
  add("refine", sequence_name, refine);
  add("pipeline", sequence_name, pipeline);
}

}  // namespace edgevox::bench
