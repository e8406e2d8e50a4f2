// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <Eigen/Core>

#include "edgevox/config.hpp"
#include "edgevox/grid/voxel.hpp"

namespace edgevox::test {

struct HashVoxel {
  size_t operator()(const VoxelIndex& v) const { return voxelHash(v); }
};

/// Number of positive eigenvalues of a symmetric matrix, exactly (Sylvester's law of inertia).
/// Entries below 2^28.
int positiveEigenvalues(const Eigen::Matrix<int64_t, 3, 3>& m);

/// Edges by the definition (Ryde et al. 2013, eq. 5-7), cell by cell from a plain set of voxels.
class ReferenceExtractor {
 public:
  using IntegerMatrix = Eigen::Matrix<int64_t, 3, 3>;
  using IntegerVector = Eigen::Matrix<int64_t, 3, 1>;

  explicit ReferenceExtractor(const std::vector<VoxelIndex>& occupied);

  /// Eq. 5 with Sobel gradients and weights 1 4 6 4 1; a plane's largest eigenvalue is 2^19.
  IntegerMatrix structureTensor(const VoxelIndex& v) const;
  /// Of the positions of the occupied voxels in the 7^3 neighbourhood, times n^3 [voxel^2].
  IntegerMatrix scaledCovariance(const VoxelIndex& v, int64_t& n) const;
  /// Smallest eigenvalue of the same [voxel^2].
  double support(const VoxelIndex& v) const;
  /// Eq. 5-7 as printed, h = 2; ascending. A plane's largest is 10.016.
  Eigen::Vector3d paperEigenvalues(const VoxelIndex& v) const;

  /// The default mode: the tensor in 16ths, rounded down; thresholds rounded to 2^-15 of a plane
  /// (magnitude), 2^-16 (rho) and 2^-10 voxel^2 (support).
  bool isEdge(const VoxelIndex& v, double magnitude, const EdgeThresholds& thresholds) const;
  bool isPaperEdge(const VoxelIndex& v) const;
  /// The default mode: no eigenvalue of the tensor in 16ths, rounded down, reaches a tenth of a
  /// plane's, rounded likewise.
  bool isSparse(const VoxelIndex& v) const;

  std::vector<VoxelIndex> edges(double magnitude, const EdgeThresholds& thresholds) const;
  std::vector<VoxelIndex> paperEdges() const;

 private:
  bool isOccupied(const VoxelIndex& v) const { return occupied_.count(v) != 0; }
  bool isSupported(const VoxelIndex& v, double support) const;
  const IntegerVector& sobel(const VoxelIndex& cell) const;
  const Eigen::Vector3d& paperGradient(const VoxelIndex& cell) const;
  std::vector<VoxelIndex> select(const std::function<bool(const VoxelIndex&)>& chosen) const;

  std::vector<VoxelIndex> voxels_;
  std::unordered_set<VoxelIndex, HashVoxel> occupied_;
  mutable std::unordered_map<VoxelIndex, IntegerVector, HashVoxel> sobel_;
  mutable std::unordered_map<VoxelIndex, Eigen::Vector3d, HashVoxel> paper_gradient_;
};

/// Of the candidates those with at least `neighbours` others among their 26, one by one.
std::vector<VoxelIndex> thinnedAtOnce(const std::vector<VoxelIndex>& candidates, int neighbours);

/// The edges of a map with these occupied voxels, by the library's kernel on all of them.
std::vector<VoxelIndex> labelledAtOnce(const std::vector<VoxelIndex>& hit,
                                       const EdgeConfig& config = {});

}  // namespace edgevox::test
