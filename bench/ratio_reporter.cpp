// SPDX-License-Identifier: BSD-3-Clause
#include "ratio_reporter.hpp"

#include <cmath>
#include <cstdio>
#include <limits>

#include "edgevox/statistics.hpp"

namespace edgevox::bench {
namespace {

/// Of the table of times, in its order.
constexpr const char* kRows[] = {
    "voxelize",     "pcl_voxel_grid", "extract", "kernel_fast", "kernel_portable",
    "kernel_dense", "kernel_naive",   "insert",  "label",       "search",
    "refine",       "pipeline",       "pcl_ndt", "pcl_gicp",    "pcl_gicp_raw",
};

/// `slow` takes how many times as long as `fast`.
struct Ratio {
  const char* slow;
  const char* fast;
  double claim;  // at least; 0: none is made
};
constexpr Ratio kRatios[] = {
    {"pcl_voxel_grid", "voxelize", 0},   {"kernel_portable", "kernel_fast", 0},
    {"kernel_dense", "kernel_fast", 20}, {"kernel_naive", "kernel_fast", 0},
    {"pcl_ndt", "pipeline", 0},          {"pcl_gicp", "pipeline", 5},
    {"pcl_gicp_raw", "pipeline", 5},
};

/// A median time, or how many times that of the same row on something else it is.
struct Limit {
  const char* row;
  const char* on;
  double most;  // [ms]; 0: only shown
  const char* times_on = nullptr;
};
constexpr Limit kLimits[] = {
    {"voxelize", "100k_points", 1},
    {"extract", "100k_points_10cm", 4},
    {"extract", "100k_points_5cm", 10},
    {"label", "map_100k", 5},
    {"label", "map_1M", 5},
    {"label", "map_10M", 5},
    {"insert", "map_100k", 0},
    {"insert", "map_1M", 0},
    {"insert", "map_10M", 0},
    {"insert_after_snapshot", "map_100k", 0},
    {"insert_after_snapshot", "map_1M", 0},
    {"insert_after_snapshot", "map_10M", 0},
    {"snapshot", "map_100k", 5},
    {"snapshot", "map_1M", 5},
    {"snapshot", "map_10M", 0},
    {"pipeline", "noisy_room", 1.5, "room"},
};

void printHeader(const char* title, const std::vector<std::string>& sequences) {
  std::printf("\n%-30s", title);
  for (const std::string& sequence : sequences) std::printf("%14s", sequence.c_str());
  std::printf("\n");
}

void printValue(double value) {
  if (std::isnan(value)) {
    std::printf("%14s", "-");
  } else {
    std::printf("%14.*f", value < 10 ? 2 : value < 100 ? 1 : 0, value);
  }
}

std::string verdict(double least, double claim) {
  if (claim == 0 || !std::isfinite(least)) return "";
  const std::string text = "  claim: at least " + std::to_string(std::lround(claim));
  return text + (least >= claim ? ", holds" : ", FAILS");
}

}  // namespace

void RatioReporter::ReportRuns(const std::vector<Run>& runs) {
  std::vector<Run> shown;
  for (const Run& run : runs) {
    const bool single = run.run_type == Run::RT_Iteration;
    const bool failed = run.cpu_accumulated_time == 0;
    if (failed || (single ? runs.size() == 1 : run.aggregate_name == "median")) {
      shown.push_back(run);
    }
    if (!single || failed) continue;
    times_[run.run_name.function_name].push_back(run.GetAdjustedCPUTime());
  }
  if (!shown.empty()) ConsoleReporter::ReportRuns(shown);
}

double RatioReporter::median(const std::string& row, const std::string& sequence) const {
  const auto times = times_.find(row + "/" + sequence);
  return times == times_.end() ? std::numeric_limits<double>::quiet_NaN()
                               : quantile(times->second, 0.5);
}

double RatioReporter::ratio(const std::string& slow, const std::string& fast,
                            const std::string& sequence) const {
  return median(slow, sequence) / median(fast, sequence);
}

void RatioReporter::printTables(const std::vector<std::string>& sequences) const {
  printHeader("median CPU time [ms]", sequences);
  for (const char* row : kRows) {
    std::printf("%-30s", row);
    for (const std::string& sequence : sequences) printValue(median(row, sequence));
    std::printf("\n");
  }
  printHeader("ratio", sequences);
  for (const Ratio& r : kRatios) {
    double least = std::numeric_limits<double>::infinity();
    std::printf("%-30s", (std::string(r.slow) + " / " + r.fast).c_str());
    for (const std::string& sequence : sequences) {
      const double value = ratio(r.slow, r.fast, sequence);
      least = value < least ? value : least;
      printValue(value);
    }
    std::printf("%s\n", verdict(least, r.claim).c_str());
  }
  printLimits();
}

void RatioReporter::printLimits() const {
  printHeader("median CPU time [ms]", {"", "limit"});
  for (const Limit& limit : kLimits) {
    const bool is_ratio = limit.times_on != nullptr;
    const double value = is_ratio ? median(limit.row, limit.on) / median(limit.row, limit.times_on)
                                  : median(limit.row, limit.on);
    const std::string name = std::string(limit.row) + " " + limit.on;
    std::printf("%-30s", (is_ratio ? name + " / " + limit.times_on : name).c_str());
    printValue(value);
    const bool judged = limit.most != 0 && !std::isnan(value);
    if (judged) printValue(limit.most);
    std::printf("%s\n", !judged ? "" : value <= limit.most ? "  holds" : "  FAILS");
  }
}

}  // namespace edgevox::bench
