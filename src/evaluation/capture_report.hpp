// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "edgevox/config.hpp"
#include "evaluation/capture_scene.hpp"
#include "evaluation/table.hpp"

namespace edgevox {

struct CaptureOptions {
  size_t trials = 500;  ///< at least, of a row
  int threads = 1;      ///< probes at a time; the counts do not depend on it
  Config config;
  std::string config_name = "the defaults";  ///< to print
};

/// Rows of captures, of one scene after another.
class CaptureTable {
 public:
  explicit CaptureTable(const CaptureOptions& options) : options_(options) {}

  /// A row for each disturbance and registration: edgevox and, to compare with, PCL. `note` is told
  /// what is being measured.
  void add(const CaptureScene& scene, const std::function<void(const std::string&)>& note);

  const Table& table() const { return table_; }
  /// The table, with what its columns mean.
  std::string markdown() const;

 private:
  void addRow(const CaptureScene& scene, const Disturbance& disturbance, const char* registration,
              const CaptureCounts& counts);

  CaptureOptions options_;
  Table table_{{{"recording", "recording"},
                {"disturbance", "guess off by"},
                {"registration", "found by"},
                {"trials", "trials", 0},
                {"right", "right %", 1},
                {"refused", "refused %", 1},
                {"wrong", "accepted, wrong %", 1},
                {"ms", "ms median", 1}}};
};

}  // namespace edgevox
