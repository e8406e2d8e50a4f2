// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/io/trajectory_evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/SVD>

#include "edgevox/scan/motion.hpp"
#include "edgevox/statistics.hpp"

namespace edgevox {
namespace {

constexpr double kLongestGap = 0.005;  // [s]
constexpr size_t kFewestMatches = 3;
constexpr double kMovingDistance = 0.05;     // [m]
constexpr double kMovingAngle = 0.5;         // [degree]
constexpr double kOrientationWeight = 0.01;  // [m^2]; tells only where positions say little

double degrees(double radians) { return radians * 180.0 / M_PI; }

Eigen::Vector3d meanPosition(const std::vector<Pose>& poses) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Pose& pose : poses) sum += pose.translation();
  return sum / static_cast<double>(poses.size());
}

/// The rotation nearest to a matrix of correlations.
Eigen::Matrix3d rotationFrom(const Eigen::Matrix3d& correlation) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign(2, 2) = -1;
  return svd.matrixU() * sign * svd.matrixV().transpose();
}

std::vector<StampMatch> requireMatches(const Trajectory& estimate, const Trajectory& reference) {
  std::vector<StampMatch> matches = matchStamps(estimate, reference);
  if (matches.size() >= kFewestMatches) return matches;
  throw TrajectoryError(
      "only " + std::to_string(matches.size()) + " of " + std::to_string(estimate.size()) +
      " poses have a reference within 5 ms, " + std::to_string(kFewestMatches) +
      " are needed; check that the reference is of this recording and on the same clock");
}

PoseError absoluteError(double stamp, const Pose& aligned, const Pose& reference) {
  PoseError error;
  error.stamp = stamp;
  error.ape_m = (aligned.translation() - reference.translation()).norm();
  error.ape_deg = degrees(rotationAngle(reference.inverse() * aligned));
  error.rpe_m = error.rpe_deg = std::numeric_limits<double>::quiet_NaN();
  return error;
}

void setRelativeError(const Pose& estimated_step, const Pose& reference_step, PoseError& error) {
  const Pose difference = reference_step.inverse() * estimated_step;
  error.rpe_m = difference.translation().norm();
  error.rpe_deg = degrees(rotationAngle(difference));
  error.moving = reference_step.translation().norm() > kMovingDistance ||
                 degrees(rotationAngle(reference_step)) > kMovingAngle;
}

ErrorSummary summarise(const std::vector<PoseError>& poses, bool moving) {
  std::vector<double> metres;
  std::vector<double> angles;
  for (size_t i = 1; i < poses.size(); ++i) {
    if (poses[i].moving != moving) continue;
    metres.push_back(poses[i].rpe_m);
    angles.push_back(poses[i].rpe_deg);
  }
  return {metres.size(), quantile(metres, 0.5), quantile(metres, 0.95), quantile(angles, 0.5),
          quantile(angles, 0.95)};
}

double rmse(const std::vector<PoseError>& poses, double PoseError::*value) {
  std::vector<double> values;
  for (const PoseError& pose : poses) values.push_back(pose.*value);
  return rootMeanSquare(values);
}

}  // namespace

std::vector<StampMatch> matchStamps(const Trajectory& estimate, const Trajectory& reference) {
  std::vector<StampMatch> matches;
  const auto earlier = [](const StampedPose& pose, double stamp) { return pose.stamp < stamp; };
  for (size_t i = 0; i < estimate.size(); ++i) {
    const double stamp = estimate[i].stamp;
    auto nearest = std::lower_bound(reference.begin(), reference.end(), stamp, earlier);
    if (nearest != reference.begin() &&
        (nearest == reference.end() ||
         stamp - std::prev(nearest)->stamp <= nearest->stamp - stamp)) {
      --nearest;
    }
    if (nearest == reference.end() || std::abs(nearest->stamp - stamp) > kLongestGap) continue;
    matches.push_back({i, static_cast<size_t>(nearest - reference.begin())});
  }
  return matches;
}

Pose alignTrajectories(const std::vector<Pose>& estimate, const std::vector<Pose>& reference) {
  const Eigen::Vector3d from = meanPosition(estimate);
  const Eigen::Vector3d to = meanPosition(reference);
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < estimate.size(); ++i) {
    correlation +=
        (reference[i].translation() - to) * (estimate[i].translation() - from).transpose();
    correlation += kOrientationWeight * reference[i].linear() * estimate[i].linear().transpose();
  }
  Pose alignment = Pose::Identity();
  alignment.linear() = rotationFrom(correlation);
  alignment.translation() = to - alignment.linear() * from;
  return alignment;
}

TrajectoryErrors evaluate(const Trajectory& estimate, const Trajectory& reference) {
  const std::vector<StampMatch> matches = requireMatches(estimate, reference);
  std::vector<Pose> from;
  std::vector<Pose> to;
  for (const StampMatch& match : matches) {
    from.push_back(estimate[match.estimate].pose);
    to.push_back(reference[match.reference].pose);
  }
  const Pose alignment = alignTrajectories(from, to);

  TrajectoryErrors errors;
  for (size_t i = 0; i < matches.size(); ++i) {
    const double stamp = estimate[matches[i].estimate].stamp;
    errors.poses.push_back(absoluteError(stamp, alignment * from[i], to[i]));
    if (i == 0) continue;
    setRelativeError(from[i - 1].inverse() * from[i], to[i - 1].inverse() * to[i],
                     errors.poses.back());
  }
  errors.ape_rmse_m = rmse(errors.poses, &PoseError::ape_m);
  errors.ape_rmse_deg = rmse(errors.poses, &PoseError::ape_deg);
  errors.moving = summarise(errors.poses, true);
  errors.standing = summarise(errors.poses, false);
  return errors;
}

}  // namespace edgevox
