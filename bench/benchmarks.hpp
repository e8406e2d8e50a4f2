// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <benchmark/benchmark.h>

#include <string>

namespace edgevox::bench {

/// CPU time of all threads; the name is "row/sequence".
template <typename Function>
benchmark::internal::Benchmark* add(const std::string& row, const std::string& sequence_name,
                                    Function function) {
  const std::string name = row + "/" + sequence_name;
  return benchmark::RegisterBenchmark(
             name.c_str(), [=](benchmark::State& state) { function(state, sequence_name); })
      ->MeasureProcessCPUTime()
      ->Unit(benchmark::kMillisecond);
}

void addScanBenchmarks(const std::string& sequence_name);
void addMapBenchmarks(const std::string& sequence_name);
void addRegistrationBenchmarks(const std::string& sequence_name);
/// Independent of the sequences: RatioReporter checks their times against limits.
void addLimitBenchmarks();
void addNoiseBenchmarks();

}  // namespace edgevox::bench
