// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <vector>

#include "edgevox/grid/voxel.hpp"

namespace edgevox {

struct StampedPose {
  double stamp = 0.0;  ///< [s]
  Pose pose = Pose::Identity();
};

using Trajectory = std::vector<StampedPose>;  ///< stamps ascend

/// A trajectory that cannot be used; the text says what is wrong with it.
struct TrajectoryError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads lines of "stamp tx ty tz qx qy qz qw" (the TUM format); empty lines and those that begin
/// with '#' are left out. Throws TrajectoryError with `name` and the line's number.
Trajectory parseTum(std::istream& in, const std::string& name);
/// Throws FileError if there is no such file.
Trajectory readTum(const std::filesystem::path& file);

/// Equal trajectories give equal bytes.
std::string tumText(const Trajectory& trajectory);
/// Throws FileError.
void writeTum(const std::filesystem::path& file, const Trajectory& trajectory);

}  // namespace edgevox
