// SPDX-License-Identifier: BSD-3-Clause
// The ways of Ryde, Delmerico, Corso 2013 to align scans, and those of edgevox.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/matching/matcher.hpp"
#include "edgevox/scan/voxel_scan.hpp"

namespace edgevox {

/// Which voxels of the map's size a method works on.
enum class PaperVoxels { kAll, kEdges, kOctreeLeaves };
VoxelScan chosenVoxels(const VoxelScan& scan, PaperVoxels voxels);

/// A scan as the sensor would have seen it in the moment of its stamp, with its edges.
struct PaperScan {
  VoxelScan scan;                        ///< in voxels of half the map's size
  VoxelScan voxels;                      ///< those of the map's size that a method works on
  Pose T_map_sensor = Pose::Identity();  ///< the truth
};

struct PaperPose {
  Pose T_map_sensor = Pose::Identity();
  bool located = false;
  Refusal refusal = Refusal::kNone;  ///< why it is not
};

/// Aligns one scan after another, each from a guess.
class PaperMethod {
 public:
  virtual ~PaperMethod() = default;
  /// Where the scan was taken; nothing is changed.
  virtual PaperPose align(const PaperScan& scan, const Pose& guess) = 0;
  /// Adds the scan at this pose to what the next scans are aligned to.
  virtual void insert(const PaperScan& scan, const Pose& T_map_sensor) = 0;
  /// Whether the next scan is aligned to the last one alone, and not to a map.
  virtual bool isScanToScan() const { return false; }
};

struct NamedPaperMethod {
  std::string name;  ///< as a text of Table
  PaperVoxels voxels = PaperVoxels::kAll;
  std::function<std::unique_ptr<PaperMethod>()> make;
};

/// ICP of PCL, scan to scan.
std::unique_ptr<PaperMethod> makeIcp();
constexpr double kIcpCorrespondence = 1.0;  ///< at most [m]
constexpr int kIcpSteps = 100;              ///< at most

/// MROL as published, scan to map.
std::unique_ptr<PaperMethod> makePublished(double voxel_size);

/// Standard deviations of the guesses on each axis.
struct GuessError {
  double distance = 0.5;  ///< [m]
  double angle = 10.0;    ///< [degrees]
};

/// The matcher of edgevox, scan to map.
std::unique_ptr<PaperMethod> makeEdgevox(const Config& config, const GuessError& error);

/// All of them; the configuration and the error of the guesses are told to edgevox.
std::vector<NamedPaperMethod> paperMethods(const Config& config, const GuessError& error);

}  // namespace edgevox
