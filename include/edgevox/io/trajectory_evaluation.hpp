// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "edgevox/io/trajectory_io.hpp"

namespace edgevox {

/// Positions of the poses that belong together.
struct StampMatch {
  size_t estimate = 0;
  size_t reference = 0;
};

/// Pairs of each estimated pose and the reference's nearest in time, if that is within 5 ms.
std::vector<StampMatch> matchStamps(const Trajectory& estimate, const Trajectory& reference);

/// The rigid transform T that makes the sum of |reference_i - T estimate_i|^2 least (Umeyama 1991,
/// without scale). Orientations have a small weight, which settles the rotation where positions
/// leave it open, as on a straight line. Sizes must be equal and not 0.
Pose alignTrajectories(const std::vector<Pose>& estimate, const std::vector<Pose>& reference);

struct ErrorSummary {
  size_t pairs = 0;
  double median_m = 0.0;  ///< NaN without pairs, as all below
  double p95_m = 0.0;
  double median_deg = 0.0;
  double p95_deg = 0.0;
};

/// Errors of one estimated pose and of the step to it from the one before.
struct PoseError {
  double stamp = 0.0;  ///< [s]
  double ape_m = 0.0;  ///< after alignment
  double ape_deg = 0.0;
  double rpe_m = 0.0;    ///< |trans(inv(reference step) * estimated step)|; NaN for the first
  double rpe_deg = 0.0;  ///< the same of the rotation
  bool moving = false;   ///< the reference moved by more than 5 cm or 0.5 degree
};

struct TrajectoryErrors {
  std::vector<PoseError> poses;  ///< one for each estimated pose that the reference knows
  double ape_rmse_m = 0.0;
  double ape_rmse_deg = 0.0;
  ErrorSummary moving;
  ErrorSummary standing;
};

/// Throws TrajectoryError if fewer than three poses match.
TrajectoryErrors evaluate(const Trajectory& estimate, const Trajectory& reference);

}  // namespace edgevox
