// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "edgevox/mapping/pipeline.hpp"
#include "ros/conversions/point_cloud.hpp"
#include "ros/conversions/scan_transforms.hpp"
#include "run/run_record.hpp"
#include "tools/bag_reader.hpp"
#include "tools/console.hpp"

namespace edgevox {

/// Maps the clouds of one sensor and keeps account of them. A cloud that cannot be read or that
/// ScanTransformer refuses is left out.
class CloudMapping {
 public:
  /// `frames` and `console` must outlive this. Throws ConfigError.
  CloudMapping(const Config& config, const SensorFrames& frames, Console& console);

  void add(size_t index, const BagCloud& cloud);
  Pipeline& pipeline() { return pipeline_; }

  const Config& config() const { return pipeline_.config(); }
  const RunRecord& run() const { return run_; }
  /// The first advice on scans that became this; empty if there is none.
  std::string adviceOn(ScanStatus status) const;
  const MapBuilder& map() const { return pipeline_.map(); }
  const DensityMonitor& densityMonitor() const { return pipeline_.densityMonitor(); }

 private:
  void leaveOut(size_t cloud, const std::string& reason, const std::string& text);
  void process(size_t cloud, const CheckedCloud& checked, const ScanTransforms& transforms);
  void noteMissingOdometry(size_t cloud, const std::string& error);
  void noteOdometryJump(size_t cloud, const ScanResult& scan);
  void noteBegunAnew(size_t cloud, const ScanResult& scan);
  void noteNotLocated(size_t cloud, const ScanResult& scan);
  void printNote(const std::string& note);

  VoxelizerConfig config_;
  ScanTransformer transformer_;
  Console& console_;
  Pipeline pipeline_;
  RunRecord run_;
  std::string printed_note_;
  std::map<ScanStatus, std::string> advice_;
};

}  // namespace edgevox
