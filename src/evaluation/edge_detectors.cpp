// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/edge_detectors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Eigenvalues>

#include "edgevox/grid/block_grid.hpp"
#include "edgevox/statistics.hpp"
#include "evaluation/paper_data.hpp"

namespace edgevox {
namespace {

constexpr int kReach = 3;             // voxels
constexpr double kNarrowSigma = 1.0;  // voxels
constexpr double kWideSigma = 1.6;    // the same

/// The voxels of a scan by their place.
class Neighbours {
 public:
  explicit Neighbours(const VoxelScan& scan) : scan_(scan) {
    for (uint32_t i = 0; i < scan.voxels.size(); ++i) positions_.insert(scan.voxels[i].index, i);
  }

  /// Calls visit(offset in voxels, neighbour) for those within reach of voxel `i`, itself too.
  template <typename Visit>
  void around(size_t i, const Visit& visit) const {
    const VoxelIndex& centre = scan_.voxels[i].index;
    for (int z = -kReach; z <= kReach; ++z) {
      for (int y = -kReach; y <= kReach; ++y) {
        for (int x = -kReach; x <= kReach; ++x) {
          const uint32_t found = positions_.find({centre.x + x, centre.y + y, centre.z + z});
          if (found != SlotGrid<8>::kNone) visit(Eigen::Vector3i(x, y, z), scan_.voxels[found]);
        }
      }
    }
  }

  template <typename Respond>
  Responses respond(const Respond& of) const {
    Responses responses(scan_.voxels.size());
    for (size_t i = 0; i < responses.size(); ++i) responses[i] = of(i);
    return responses;
  }

 private:
  const VoxelScan& scan_;
  SlotGrid<8> positions_;
};

double gaussian(double squared_distance, double sigma) {
  return std::exp(-squared_distance / (2 * sigma * sigma)) /
         std::pow(2 * M_PI * sigma * sigma, 1.5);
}

}  // namespace

Responses structureTensor(const VoxelScan& scan) {
  BitGrid<16> occupied;
  std::vector<VoxelIndex> indices;
  for (const ScanVoxel& voxel : scan.voxels) {
    occupied.set(voxel.index);
    indices.push_back(voxel.index);
  }
  Responses responses;
  for (const Eigen::Vector3d& values : publishedEigenvalues(occupied, indices)) {
    responses.push_back(values[1]);
  }
  return responses;
}

Responses surfaceVariation(const VoxelScan& scan) {
  const Neighbours neighbours(scan);
  return neighbours.respond([&](size_t i) {
    const Eigen::Vector3f& centre = scan.voxels[i].centroid;
    double count = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    neighbours.around(i, [&](const Eigen::Vector3i&, const ScanVoxel& neighbour) {
      const Eigen::Vector3d from = (neighbour.centroid - centre).cast<double>();
      ++count;
      sum += from;
      products += from * from.transpose();
    });
    const Eigen::Matrix3d covariance = products / count - (sum / count) * (sum / count).transpose();
    const Eigen::Vector3d values =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly)
            .eigenvalues();
    return values.sum() > 0 ? std::max(values[0], 0.0) / values.sum() : 0.0;
  });
}

Responses differenceOfGaussians(const VoxelScan& scan) {
  const Neighbours neighbours(scan);
  Responses responses = neighbours.respond([&](size_t i) {
    double sum = 0.0;
    neighbours.around(i, [&](const Eigen::Vector3i& offset, const ScanVoxel&) {
      const double distance = offset.squaredNorm();
      sum += gaussian(distance, kNarrowSigma) - gaussian(distance, kWideSigma);
    });
    return sum;
  });
  if (responses.empty()) return responses;
  const double plane = upperMedian(responses);
  for (double& response : responses) response = std::abs(response - plane);
  return responses;
}

Responses haarLike(const VoxelScan& scan) {
  const Neighbours neighbours(scan);
  return neighbours.respond([&](size_t i) {
    Eigen::Vector3i balance = Eigen::Vector3i::Zero();
    neighbours.around(
        i, [&](const Eigen::Vector3i& offset, const ScanVoxel&) { balance += offset.cwiseSign(); });
    return balance.cast<double>().norm();
  });
}

void markStrongest(const EdgeDetector& detector, size_t count, VoxelScan& scan) {
  const VoxelScan voxels = inMapVoxels(scan);
  const Responses responses = detector.respond(voxels);
  std::vector<size_t> order(responses.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return responses[a] > responses[b]; });
  order.resize(std::min(count, order.size()));
  BitGrid<16> strongest;
  for (const size_t i : order) strongest.set(voxels.voxels[i].index);
  for (ScanVoxel& voxel : scan.voxels) voxel.edge = strongest.test(coarser(voxel.index, 1));
}

}  // namespace edgevox
