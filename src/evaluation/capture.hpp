// SPDX-License-Identifier: BSD-3-Clause
// How often the pose of a scan is found again from a wrong guess.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "edgevox/grid/voxel.hpp"
#include "edgevox/scan/voxel_scan.hpp"
#include "sim/random.hpp"

namespace edgevox {

constexpr double kFoundDistance = 0.1;  ///< of a pose that is found from the truth [m]
constexpr double kFoundAngle = 1.0;     ///< the same [degrees]

/// Whether a pose is so near the truth.
bool isFound(const Pose& truth, const Pose& pose);

/// A scan whose pose is to be found again.
struct CaptureProbe {
  VoxelScan scan;                        ///< as seen at once
  Pose T_map_sensor = Pose::Identity();  ///< the truth
  uint64_t stream = 0;                   ///< of random numbers
};

/// Makes a wrong guess of a pose: the translation is moved, and the rotation turned about the
/// sensor, both in the map's axes.
struct Disturbance {
  std::string name;
  std::function<Pose(const Pose& truth, sim::Random& random)> apply;
};
/// So far off, in any direction [m, degrees].
Disturbance disturbedBy(double distance, double angle);
/// Normally distributed on each axis, with these standard deviations.
Disturbance disturbedNormally(double distance, double angle);
/// Off by any length and any angle up to these, both evenly distributed, in any direction.
Disturbance disturbedWithin(double distance, double angle);

struct CapturedPose {
  Pose T_map_sensor = Pose::Identity();
  bool accepted = false;
};

/// Finds a probe from a guess; `seed` is for what is random in it. Safe to call from several
/// threads unless made for one.
using Registration = std::function<CapturedPose(const Pose& guess, uint64_t seed)>;
using RegistrationFor = std::function<Registration(const CaptureProbe& probe)>;

/// A trial is right if the pose is accepted and near the truth, refused if not accepted, else
/// wrong.
struct CaptureCounts {
  size_t right = 0;
  size_t refused = 0;
  size_t wrong = 0;
  std::vector<double> milliseconds;  ///< CPU time of each trial

  size_t trials() const { return right + refused + wrong; }
  CaptureCounts& operator+=(const CaptureCounts& more);
};

/// Looks for a probe from `trials` guesses, the same for any registration.
CaptureCounts capture(const CaptureProbe& probe, const Disturbance& disturbance, size_t trials,
                      const Registration& registration);

}  // namespace edgevox
