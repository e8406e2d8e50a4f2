// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdio>
#include <exception>
#include <string>

#include "benchmarks.hpp"
#include "ratio_reporter.hpp"
#include "sequence.hpp"

namespace edgevox::bench {
namespace {

/// Flags that an old Google Benchmark doesn't know are left out.
void initializeDefaults() {
  std::array<std::string, 4> flags = {"edgevox_bench", "--benchmark_repetitions=5",
                                      "--benchmark_min_time=0.1",
                                      "--benchmark_enable_random_interleaving=true"};
  std::array<char*, flags.size() + 1> arguments{};
  for (size_t i = 0; i < flags.size(); ++i) arguments[i] = flags[i].data();
  int count = static_cast<int>(flags.size());
  benchmark::Initialize(&count, arguments.data());
}

int run(int argc, char** argv) {
  initializeDefaults();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  const auto names = sequenceNames();
  for (const std::string& name : names) {
    addScanBenchmarks(name);
    addMapBenchmarks(name);
    addRegistrationBenchmarks(name);
  }
  addLimitBenchmarks();
  addNoiseBenchmarks();
  RatioReporter reporter;
  if (benchmark::RunSpecifiedBenchmarks(&reporter) != 0) reporter.printTables(names);
  return 0;
}

}  // namespace
}  // namespace edgevox::bench

int main(int argc, char** argv) {
  try {
    return edgevox::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "edgevox_bench: %s\n", error.what());
    return 1;
  }
}
