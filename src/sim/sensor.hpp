// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace edgevox::sim {

/// A spinning lidar. Column 0 looks backwards and the head turns counter-clockwise.
struct Sensor {
  std::string name;
  std::vector<double> elevations;  ///< rad by ring, ring 0 lowest
  int columns = 0;                 ///< per turn
  double min_range = 0.5;          ///< m; nearer returns are omitted
  double max_range = 100.0;        ///< m; farther returns are omitted
  double noise = 0.01;             ///< m, standard deviation of the range
  double dropout = 0.02;           ///< probability that a return is omitted
  double period = 0.1;             ///< s between the stamps of two sweeps
  bool standing = false;           ///< sweeps from standing stations, all time offsets 0
};

/// The sensor called "16", "32", "64", "scanner" or "fine-scanner", of which the last two stand,
/// one ray in 0.25 degrees to 80 m or one in 0.04 degrees (22.5 million in all) to 600 m. Throws
/// std::invalid_argument otherwise.
Sensor makeSensor(std::string_view name);

}  // namespace edgevox::sim
