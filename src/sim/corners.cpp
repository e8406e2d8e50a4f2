// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>

#include "sim/truth.hpp"

namespace edgevox::sim {
namespace {

using Eigen::Vector3d;

constexpr double kNear = 0.001;    // m, ends closer than this are one point
constexpr double kCell = 0.5;      // m, of the grid that finds creases near a point
constexpr double kSpanning = 0.2;  // least singular value of directions that span space

using Cell = std::array<std::int64_t, 3>;

// The offset keeps round coordinates off the cells' borders.
Cell cellOf(const Vector3d& point) {
  Cell cell;
  for (int i = 0; i < 3; ++i) {
    cell[i] = static_cast<std::int64_t>(std::floor(point[i] / kCell + 0.2871));
  }
  return cell;
}

// Which creases pass through or near each cell.
class CreaseGrid {
 public:
  explicit CreaseGrid(const std::vector<Crease>& creases) {
    for (std::size_t i = 0; i < creases.size(); ++i) {
      if (creases[i].rim) continue;
      const Vector3d way = creases[i].end - creases[i].start;
      const int steps = static_cast<int>(std::ceil(way.norm() / (0.5 * kCell)));
      for (int step = 0; step <= steps; ++step) {
        const double u = steps > 0 ? static_cast<double>(step) / steps : 0.0;
        cells_[cellOf(creases[i].start + u * way)].insert(i);
      }
    }
  }

  std::set<std::size_t> around(const Vector3d& point) const {
    std::set<std::size_t> found;
    const Cell centre = cellOf(point);
    for (std::int64_t x = -1; x <= 1; ++x) {
      for (std::int64_t y = -1; y <= 1; ++y) {
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto cell = cells_.find({centre[0] + x, centre[1] + y, centre[2] + z});
          if (cell != cells_.end()) found.insert(cell->second.begin(), cell->second.end());
        }
      }
    }
    return found;
  }

 private:
  std::map<Cell, std::set<std::size_t>> cells_;
};

bool passes(const Crease& crease, const Vector3d& point) {
  const Vector3d way = crease.end - crease.start;
  const double u = std::clamp((point - crease.start).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (crease.start + u * way - point).norm() < kNear;
}

}  // namespace

std::vector<Corner> findCorners(const std::vector<Crease>& creases) {
  const CreaseGrid grid(creases);
  std::vector<Corner> corners;
  std::map<Cell, std::vector<Vector3d>> known;
  const auto isKnown = [&](const Vector3d& point) {
    for (const auto& found : known[cellOf(point)]) {
      if ((found - point).norm() < 2.0 * kNear) return true;
    }
    return false;
  };
  const auto examine = [&](const Vector3d& point) {
    if (isKnown(point)) return;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    int count = 0;
    for (const std::size_t index : grid.around(point)) {
      if (!passes(creases[index], point)) continue;
      const Vector3d direction = (creases[index].end - creases[index].start).normalized();
      spread += direction * direction.transpose();
      ++count;
    }
    if (count < 3) return;
    const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues()[0];
    if (least < kSpanning * kSpanning) return;
    corners.push_back({point, count});
    known[cellOf(point)].push_back(point);
  };
  for (const Crease& crease : creases) {
    if (crease.rim) continue;
    examine(crease.start);
    examine(crease.end);
  }
  return corners;
}

}  // namespace edgevox::sim
