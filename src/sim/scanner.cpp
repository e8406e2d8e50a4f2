// SPDX-License-Identifier: BSD-3-Clause
#include "sim/scanner.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <thread>

#include "sim/random.hpp"

namespace edgevox::sim {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Beam {
  double horizontal;  // cosine of the elevation
  double vertical;    // sine of the elevation
};

std::vector<Beam> makeBeams(const Sensor& sensor) {
  std::vector<Beam> beams;
  beams.reserve(sensor.elevations.size());
  for (const double elevation : sensor.elevations) {
    beams.push_back({std::cos(elevation), std::sin(elevation)});
  }
  return beams;
}

void reserve(Scan& scan, std::size_t count) {
  scan.points.reserve(count);
  scan.times.reserve(count);
  scan.intensities.reserve(count);
  scan.rings.reserve(count);
}

float intensityOf(const World& world, const Hit& hit, const Eigen::Vector3d& direction) {
  const double facing = std::abs(hit.normal.dot(direction));
  return static_cast<float>(std::lround(255.0 * world.solids()[hit.solid].reflectivity * facing));
}

struct Echo {
  double range;     // m
  float intensity;  // 0 to 255
};

// The nearest surface of both.
std::optional<Echo> castRay(const World& still, const World& moving, const Eigen::Vector3d& origin,
                            const Eigen::Vector3d& direction, double max_range) {
  const auto behind = still.castRay(origin, direction, max_range);
  const auto before = moving.castRay(origin, direction, behind ? behind->range : max_range);
  if (before) return Echo{before->range, intensityOf(moving, *before, direction)};
  if (behind) return Echo{behind->range, intensityOf(still, *behind, direction)};
  return std::nullopt;
}

}  // namespace

int countSweeps(const Trajectory& trajectory, const Sensor& sensor) {
  return static_cast<int>(std::floor(trajectory.duration() / sensor.period + 1e-9));
}

Scan simulateSweep(const World& world, const Trajectory& trajectory, const Sensor& sensor,
                   int sweep, std::uint64_t seed, const Movers& movers) {
  const std::vector<Beam> beams = makeBeams(sensor);
  Random random(seed, static_cast<std::uint64_t>(sweep));
  Scan scan;
  scan.stamp = sweep * sensor.period;
  reserve(scan, beams.size() * static_cast<std::size_t>(sensor.columns));
  for (int column = 0; column < sensor.columns; ++column) {
    const double turn = static_cast<double>(column) / sensor.columns;
    const auto time = static_cast<float>(sensor.standing ? 0.0 : turn * sensor.period);
    const double azimuth = 2.0 * kPi * turn - kPi;
    const double now = scan.stamp + static_cast<double>(time);
    const Eigen::Isometry3d T_world_sensor = trajectory.poseAt(now);
    const World moving(solidsAt(movers, now));
    for (std::size_t ring = 0; ring < beams.size(); ++ring) {
      const double noise = sensor.noise * random.normal();
      const bool dropped = random.uniform() < sensor.dropout;
      const Eigen::Vector3d direction(beams[ring].horizontal * std::cos(azimuth),
                                      beams[ring].horizontal * std::sin(azimuth),
                                      beams[ring].vertical);
      const Eigen::Vector3d direction_world = T_world_sensor.linear() * direction;
      const auto echo =
          castRay(world, moving, T_world_sensor.translation(), direction_world, sensor.max_range);
      if (!echo || dropped) continue;
      const double range = echo->range + noise;
      if (range < sensor.min_range || range > sensor.max_range) continue;
      scan.points.push_back((range * direction).cast<float>());
      scan.times.push_back(time);
      scan.intensities.push_back(echo->intensity);
      scan.rings.push_back(static_cast<std::uint16_t>(ring));
    }
  }
  return scan;
}

std::vector<Scan> simulateSweeps(const World& world, const Trajectory& trajectory,
                                 const Sensor& sensor, int first, int count, std::uint64_t seed,
                                 unsigned threads, const Movers& movers) {
  std::vector<Scan> scans(static_cast<std::size_t>(std::max(count, 0)));
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) {
      scans[static_cast<std::size_t>(i)] =
          simulateSweep(world, trajectory, sensor, first + i, seed, movers);
    }
  };
  std::vector<std::thread> helpers;
  for (unsigned i = 1; i < threads; ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
  return scans;
}

std::vector<Eigen::Vector3d> pointsInWorld(const Scan& scan, const Trajectory& trajectory) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(scan.size());
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (i == 0 || scan.times[i] != scan.times[i - 1]) {
      T_world_sensor = trajectory.poseAt(scan.stamp + static_cast<double>(scan.times[i]));
    }
    points.push_back(T_world_sensor * scan.points[i].cast<double>());
  }
  return points;
}

}  // namespace edgevox::sim
