// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/capture.hpp"

#include <cmath>
#include <ctime>

#include "edgevox/io/number_text.hpp"
#include "edgevox/scan/motion.hpp"

namespace edgevox {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// The last three numbers drawn come first.
Eigen::Vector3d normalVector(sim::Random& random) {
  const double z = random.normal();
  const double y = random.normal();
  return {random.normal(), y, z};
}

Eigen::Vector3d direction(sim::Random& random) { return normalVector(random).normalized(); }

Eigen::Vector3d within(double radius, sim::Random& random) {
  const Eigen::Vector3d towards = direction(random);
  return radius * random.uniform() * towards;
}

/// By a translation [m] and a rotation vector [degrees].
Pose moved(const Pose& pose, const Eigen::Vector3d& translation, const Eigen::Vector3d& rotation) {
  Pose guess = pose;
  guess.translation() += translation;
  guess.linear() = rotationOf(kDegree * rotation) * pose.linear();
  return guess;
}

std::string sizeText(double distance, double angle) {
  return shortText(distance) + " m / " + shortText(angle) + " degrees";
}

/// CPU time of this thread.
double threadMilliseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

void count(const CapturedPose& found, const Pose& truth, CaptureCounts& counts) {
  if (!found.accepted) {
    ++counts.refused;
  } else if (isFound(truth, found.T_map_sensor)) {
    ++counts.right;
  } else {
    ++counts.wrong;
  }
}

}  // namespace

bool isFound(const Pose& truth, const Pose& pose) {
  const Pose off = truth.inverse() * pose;
  return off.translation().norm() < kFoundDistance && rotationAngle(off) < kFoundAngle * kDegree;
}

Disturbance disturbedBy(double distance, double angle) {
  return {sizeText(distance, angle), [=](const Pose& truth, sim::Random& random) {
            const Eigen::Vector3d translation = distance * direction(random);
            return moved(truth, translation, angle * direction(random));
          }};
}

Disturbance disturbedNormally(double distance, double angle) {
  return {"sigma " + sizeText(distance, angle), [=](const Pose& truth, sim::Random& random) {
            const Eigen::Vector3d translation = distance * normalVector(random);
            return moved(truth, translation, angle * normalVector(random));
          }};
}

Disturbance disturbedWithin(double distance, double angle) {
  return {"within " + sizeText(distance, angle), [=](const Pose& truth, sim::Random& random) {
            const Eigen::Vector3d translation = within(distance, random);
            return moved(truth, translation, within(angle, random));
          }};
}

CaptureCounts& CaptureCounts::operator+=(const CaptureCounts& more) {
  right += more.right;
  refused += more.refused;
  wrong += more.wrong;
  milliseconds.insert(milliseconds.end(), more.milliseconds.begin(), more.milliseconds.end());
  return *this;
}

CaptureCounts capture(const CaptureProbe& probe, const Disturbance& disturbance, size_t trials,
                      const Registration& registration) {
  CaptureCounts counts;
  sim::Random random(1, probe.stream);
  for (size_t trial = 0; trial < trials; ++trial) {
    const Pose guess = disturbance.apply(probe.T_map_sensor, random);
    const uint64_t seed = random.next();
    const double start = threadMilliseconds();
    const CapturedPose found = registration(guess, seed);
    counts.milliseconds.push_back(threadMilliseconds() - start);
    count(found, probe.T_map_sensor, counts);
  }
  return counts;
}

}  // namespace edgevox
