// SPDX-License-Identifier: BSD-3-Clause
#include "sim/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace edgevox::sim {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Leg {
  Eigen::Vector3d start;
  Eigen::Vector3d end;
  double seconds;
  double heading;  // rad
};

// The turn from one heading to the next, in (-pi, pi].
double turnBetween(double from, double to) { return std::remainder(to - from, 2.0 * kPi); }

std::vector<Leg> makeLegs(const std::vector<Waypoint>& waypoints, double speed) {
  std::vector<Leg> legs;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const Eigen::Vector3d way = waypoints[i].position - waypoints[i - 1].position;
    const double leg_speed = waypoints[i].speed > 0.0 ? waypoints[i].speed : speed;
    double heading = std::atan2(way.y(), way.x());
    if (!legs.empty()) {
      heading = legs.back().heading + turnBetween(legs.back().heading, heading);
    }
    legs.push_back(
        {waypoints[i - 1].position, waypoints[i].position, way.norm() / leg_speed, heading});
  }
  return legs;
}

std::vector<Eigen::Vector4d> sampleLegs(const std::vector<Leg>& legs, double step) {
  std::vector<Eigen::Vector4d> samples;
  double leg_start = 0.0;
  for (const Leg& leg : legs) {
    while (static_cast<double>(samples.size()) * step < leg_start + leg.seconds) {
      const double u = (static_cast<double>(samples.size()) * step - leg_start) / leg.seconds;
      samples.emplace_back();
      samples.back() << leg.start + u * (leg.end - leg.start), leg.heading;
    }
    leg_start += leg.seconds;
  }
  samples.emplace_back();
  samples.back() << legs.back().end, legs.back().heading;
  return samples;
}

// Turns start before a corner and end after it: a [1 2 1]/4 filter, twice.
void smoothHeadings(std::vector<Eigen::Vector4d>& controls) {
  for (int pass = 0; pass < 2; ++pass) {
    const auto previous = controls;
    for (std::size_t i = 1; i + 1 < controls.size(); ++i) {
      controls[i][3] = 0.25 * (previous[i - 1][3] + 2.0 * previous[i][3] + previous[i + 1][3]);
    }
  }
}

}  // namespace

Trajectory::Trajectory(const std::vector<Waypoint>& waypoints, const Gait& gait)
    : gait_(gait), step_(gait.smoothing) {
  if (waypoints.size() < 2) throw std::invalid_argument("a trajectory needs two waypoints");
  if (!(gait.speed > 0.0) || !(gait.smoothing > 0.0)) {
    throw std::invalid_argument("a gait needs a positive speed and smoothing");
  }
  controls_ = sampleLegs(makeLegs(waypoints, gait.speed), step_);
  smoothHeadings(controls_);
  const auto standing = static_cast<std::size_t>(std::ceil(gait.stand_still / step_)) + 3;
  controls_.insert(controls_.begin(), standing, Control(controls_.front()));
  controls_.insert(controls_.end(), standing, Control(controls_.back()));
}

Trajectory Trajectory::stations(int count, double period) const {
  if (count < 1 || !(period > 0.0)) {
    throw std::invalid_argument("stations need a positive count and period");
  }
  Trajectory survey;
  survey.standing_ = true;
  survey.step_ = period;
  for (int i = 0; i < count; ++i) {
    survey.controls_.push_back(interpolate(duration() * (i + 0.5) / count).value);
  }
  return survey;
}

double Trajectory::duration() const {
  const auto count = static_cast<double>(controls_.size());
  return step_ * (standing_ ? count : count - 3.0);
}

// Cubic B-spline over controls k .. k+3, u in [0, 1) within the segment.
Trajectory::Sample Trajectory::interpolate(double time) const {
  if (standing_) {
    const double last = static_cast<double>(controls_.size() - 1);
    const double index = std::clamp(std::floor(time / step_ + 1e-9), 0.0, last);
    return {controls_[static_cast<std::size_t>(index)], Control::Zero()};
  }
  const double last = static_cast<double>(controls_.size() - 4);
  const double position = std::clamp(time / step_, 0.0, last + 1.0);
  const double segment = std::min(std::floor(position), last);
  const double u = position - segment;
  const double v = 1.0 - u;
  const Control* c = &controls_[static_cast<std::size_t>(segment)];
  const double b1 = 3.0 * u * u * u - 6.0 * u * u + 4.0;
  const double b2 = 3.0 * v * v * v - 6.0 * v * v + 4.0;
  Sample sample;
  sample.value = (v * v * v * c[0] + b1 * c[1] + b2 * c[2] + u * u * u * c[3]) / 6.0;
  sample.rate = (-v * v * c[0] + (3.0 * u * u - 4.0 * u) * c[1] + (4.0 * v - 3.0 * v * v) * c[2] +
                 u * u * c[3]) /
                (2.0 * step_);
  return sample;
}

// The sway grows with the speed, so that a standing sensor is still.
Eigen::Isometry3d Trajectory::poseAt(double time) const {
  const Sample sample = interpolate(time);
  const double effort =
      std::min(sample.rate.head<3>().squaredNorm() / (gait_.speed * gait_.speed), 1.0);
  const double phase = 2.0 * kPi * gait_.sway_frequency * time;
  const double angle = effort * gait_.sway_angle;
  const Eigen::Vector3d sway =
      effort * gait_.sway_position *
      Eigen::Vector3d(0.3 * std::sin(0.7 * phase), std::sin(phase), 0.8 * std::cos(2.0 * phase));
  const Eigen::AngleAxisd heading(sample.value[3] + 0.8 * angle * std::sin(0.61 * phase + 0.4),
                                  Eigen::Vector3d::UnitZ());
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  T_world_sensor.translation() = sample.value.head<3>() + heading * sway;
  T_world_sensor.linear() =
      (heading * Eigen::AngleAxisd(angle * std::sin(1.37 * phase + 1.1), Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(angle * std::sin(phase + 0.3), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return T_world_sensor;
}

}  // namespace edgevox::sim
