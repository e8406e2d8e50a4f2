// SPDX-License-Identifier: BSD-3-Clause
#include "sim/truth.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/crease_lines.hpp"

namespace edgevox::sim {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kProbeRadius = 0.002;  // m, smaller than any solid or gap
constexpr double kStep = 0.02;          // m between probes along a line
constexpr double kSameAngle = 0.02;     // rad, probes that agree so well belong together
constexpr double kShortest = 0.005;     // m, shorter bends are a probe's view of a corner
constexpr double kChord = 0.05;         // m, longest chord of a rim

// Looks at the solids around a point, on a small circle across a given direction.
class Probe {
 public:
  explicit Probe(const World& world) : world_(world) {}

  /// The solid angle around the line if the surface bends there, none on flat, buried or free
  /// places. `direction` has unit length.
  std::optional<double> bendAt(const Vector3d& point, const Vector3d& direction) {
    const Vector3d u = direction.unitOrthogonal() * kProbeRadius;
    const Vector3d v = direction.cross(u);
    const Vector3d reach = Vector3d::Constant(kProbeRadius);
    world_.findSolids({point - reach, point + reach}, near_);
    const auto solidAt = [&](double angle) {
      const Vector3d at = point + std::cos(angle) * u + std::sin(angle) * v;
      return std::any_of(near_.begin(), near_.end(),
                         [&](int i) { return world_.solids()[i].contains(at); });
    };
    constexpr int kAngles = 32;
    constexpr double kOffset = 0.0371;  // off the angles at which faces usually lie
    double solid_angle = 0.0;
    int borders = 0;
    bool previous = solidAt(kOffset);
    for (int i = 0; i < kAngles; ++i) {
      const double low = kOffset + 2.0 * kPi * i / kAngles;
      const double high = kOffset + 2.0 * kPi * (i + 1) / kAngles;
      const bool next = solidAt(high);
      double solid_part = next ? high - low : 0.0;
      if (next != previous) {
        const double border = findBorder(solidAt, low, high, previous);
        solid_part = next ? high - border : border - low;
        ++borders;
      }
      solid_angle += solid_part;
      previous = next;
    }
    if (borders == 0) return std::nullopt;
    if (borders == 2 && std::abs(solid_angle - kPi) < kMinBend) return std::nullopt;
    return solid_angle;
  }

 private:
  template <typename Solidity>
  static double findBorder(const Solidity& solidAt, double low, double high, bool at_low) {
    for (int i = 0; i < 14; ++i) {
      const double middle = 0.5 * (low + high);
      (solidAt(middle) == at_low ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  const World& world_;
  std::vector<int> near_;
};

using Bend = std::optional<double>;

bool agree(const Bend& a, const Bend& b) {
  return a.has_value() == b.has_value() && (!a || std::abs(*a - *b) < kSameAngle);
}

Crease makeCrease(const Vector3d& start, const Vector3d& end, double solid_angle, bool rim) {
  return {start, end, solid_angle, solid_angle < kPi ? CreaseKind::Convex : CreaseKind::Concave,
          rim};
}

// Follows one line and closes a crease wherever the bend changes.
class RayTraversaler {
 public:
  RayTraversaler(Probe& probe, const CreaseLine& line, std::vector<Crease>& creases)
      : probe_(probe), line_(line), creases_(creases) {}

  void walk() {
    for (std::size_t i = 0; i < line_.candidate.size(); ++i) {
      if (line_.candidate[i]) {
        walkPiece(line_.breaks[i], line_.breaks[i + 1]);
      } else {
        change(line_.breaks[i], std::nullopt);
      }
    }
    change(line_.breaks.back(), std::nullopt);
  }

 private:
  Bend bendAt(double t) {
    return probe_.bendAt(line_.origin + t * line_.direction, line_.direction);
  }

  void walkPiece(double from, double to) {
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / kStep)));
    double previous = from;
    for (int i = 0; i < steps; ++i) {
      const double t = from + (to - from) * (i + 0.5) / steps;
      const Bend bend = bendAt(t);
      if (!agree(bend, bend_)) change(i == 0 ? from : findChange(previous, t), bend);
      previous = t;
    }
  }

  double findChange(double low, double high) {
    while (high - low > 1e-4) {
      const double middle = 0.5 * (low + high);
      (agree(bendAt(middle), bend_) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  void change(double t, const Bend& bend) {
    if (bend_ && t - start_ > kShortest) {
      creases_.push_back(makeCrease(line_.origin + start_ * line_.direction,
                                    line_.origin + t * line_.direction, *bend_, false));
    }
    bend_ = bend;
    start_ = t;
  }

  Probe& probe_;
  const CreaseLine& line_;
  std::vector<Crease>& creases_;
  Bend bend_;
  double start_ = 0.0;
};

void walkCircle(Probe& probe, const CreaseCircle& circle, std::vector<Crease>& creases) {
  const double length = 2.0 * kPi * circle.u.norm();
  const int chords = std::max(16, static_cast<int>(std::ceil(length / kChord)));
  const auto at = [&](double angle) -> Vector3d {
    return circle.centre + std::cos(angle) * circle.u + std::sin(angle) * circle.v;
  };
  for (int i = 0; i < chords; ++i) {
    const double middle = 2.0 * kPi * (i + 0.5) / chords;
    const Vector3d tangent =
        (std::cos(middle) * circle.v - std::sin(middle) * circle.u).normalized();
    const Bend bend = probe.bendAt(at(middle), tangent);
    if (!bend) continue;
    creases.push_back(
        makeCrease(at(2.0 * kPi * i / chords), at(2.0 * kPi * (i + 1) / chords), *bend, true));
  }
}

}  // namespace

std::vector<Crease> findCreases(const World& world) {
  std::vector<Crease> creases;
  Probe probe(world);
  for (const CreaseLine& line : findCreaseLines(world)) RayTraversaler(probe, line, creases).walk();
  for (const CreaseCircle& circle : findCreaseCircles(world)) walkCircle(probe, circle, creases);
  return creases;
}

std::vector<Crease> visibleCreases(const World& world, const std::vector<Crease>& creases,
                                   const std::vector<Vector3d>& viewpoints, double max_range,
                                   double step) {
  constexpr double kStandOff = 0.005;  // m, a ray that comes so close has seen the crease
  const auto seen = [&](const Vector3d& point) {
    return std::any_of(viewpoints.begin(), viewpoints.end(), [&](const Vector3d& eye) {
      const double range = (point - eye).norm();
      if (range > max_range) return false;
      return !world.castRay(eye, (point - eye) / range, range - kStandOff);
    });
  };
  std::vector<Crease> visible;
  for (const Crease& crease : creases) {
    const Vector3d way = crease.end - crease.start;
    const int parts = std::max(1, static_cast<int>(std::ceil(way.norm() / step)));
    int first = -1;
    for (int i = 0; i <= parts; ++i) {
      const bool sees = i < parts && seen(crease.start + way * ((i + 0.5) / parts));
      if (sees && first < 0) first = i;
      if (sees || first < 0) continue;
      Crease part = crease;
      part.start = crease.start + way * (static_cast<double>(first) / parts);
      part.end = crease.start + way * (static_cast<double>(i) / parts);
      visible.push_back(part);
      first = -1;
    }
  }
  return visible;
}

}  // namespace edgevox::sim
