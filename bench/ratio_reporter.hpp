// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace edgevox::bench {

/// Prints one line a benchmark, the median of its repetitions, and remembers all of them for the
/// tables of times and ratios.
class RatioReporter : public benchmark::ConsoleReporter {
 public:
  RatioReporter() : ConsoleReporter(OO_None) {}

  void ReportRuns(const std::vector<Run>& runs) override;

  /// A column a sequence.
  void printTables(const std::vector<std::string>& sequences) const;

 private:
  /// Median CPU time of an iteration [ms]; NaN if it has not run.
  double median(const std::string& row, const std::string& sequence) const;
  void printLimits() const;
  double ratio(const std::string& slow, const std::string& fast, const std::string& sequence) const;

  std::map<std::string, std::vector<double>> times_;  // by name
};

}  // namespace edgevox::bench
