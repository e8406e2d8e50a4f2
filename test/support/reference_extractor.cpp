// SPDX-License-Identifier: BSD-3-Clause
#include "support/reference_extractor.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "edgevox/edges/edge_extractor.hpp"
#include "support/voxel_sets.hpp"

namespace edgevox::test {
namespace {

using Wide = __int128;
using WideMatrix = std::array<std::array<Wide, 3>, 3>;

/// Calls visit(offset) for every offset of the cube of side 2 reach + 1.
template <typename Visit>
void forEachOffset(int reach, Visit&& visit) {
  for (int z = -reach; z <= reach; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) visit(VoxelIndex{x, y, z});
    }
  }
}

VoxelIndex shifted(const VoxelIndex& v, const VoxelIndex& by) {
  return {v.x + by.x, v.y + by.y, v.z + by.z};
}

double squaredLength(const VoxelIndex& v) { return v.x * v.x + v.y * v.y + v.z * v.z; }

/// Smooth 1 2 1 and slope -1 0 1 at -1..1.
int smoothTap(int i) { return i == 0 ? 2 : 1; }
/// 1 4 6 4 1 at -2..2.
int binomialTap(int i) { return i == 0 ? 6 : std::abs(i) == 1 ? 4 : 1; }

int64_t fixedPoint(double value, int bits) { return std::llround(std::ldexp(value, bits)); }

/// Rounded down.
int64_t sixteenth(int64_t a) { return (a - ((a % 16) + 16) % 16) / 16; }

void swapBoth(WideMatrix& m, size_t i, size_t j) {
  std::swap(m[i], m[j]);
  for (auto& row : m) std::swap(row[i], row[j]);
}

/// Adds row and column j to row and column i.
void addBoth(WideMatrix& m, size_t i, size_t j) {
  for (size_t k = 0; k < 3; ++k) m[i][k] += m[j][k];
  for (size_t k = 0; k < 3; ++k) m[k][i] += m[k][j];
}

/// Brings a diagonal element other than 0 to `first`, by a congruence; false if all of the rest
/// is 0.
bool findPivot(WideMatrix& m, size_t first) {
  for (size_t i = first; i < 3; ++i) {
    if (m[i][i] == 0) continue;
    swapBoth(m, first, i);
    return true;
  }
  for (size_t i = first; i < 3; ++i) {
    for (size_t j = i + 1; j < 3; ++j) {
      if (m[i][j] == 0) continue;
      addBoth(m, i, j);
      swapBoth(m, first, i);
      return true;
    }
  }
  return false;
}

}  // namespace

int positiveEigenvalues(const Eigen::Matrix<int64_t, 3, 3>& matrix) {
  WideMatrix m;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      m[i][j] = matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
  int positive = 0;
  for (size_t k = 0; k < 3 && findPivot(m, k); ++k) {
    const Wide pivot = m[k][k];
    positive += pivot > 0 ? 1 : 0;
    const int sign = pivot > 0 ? 1 : -1;  // the Schur complement below is |pivot| times the true
    for (size_t i = k + 1; i < 3; ++i) {
      for (size_t j = k + 1; j < 3; ++j) m[i][j] = sign * (pivot * m[i][j] - m[i][k] * m[k][j]);
    }
  }
  return positive;
}

ReferenceExtractor::ReferenceExtractor(const std::vector<VoxelIndex>& occupied)
    : voxels_(occupied), occupied_(occupied.begin(), occupied.end()) {}

const ReferenceExtractor::IntegerVector& ReferenceExtractor::sobel(const VoxelIndex& cell) const {
  const auto [entry, is_new] = sobel_.try_emplace(cell, IntegerVector::Zero());
  IntegerVector& gradient = entry->second;
  if (!is_new) return gradient;
  forEachOffset(1, [&](const VoxelIndex& d) {
    if (!isOccupied(shifted(cell, d))) return;
    gradient.x() += d.x * smoothTap(d.y) * smoothTap(d.z);
    gradient.y() += smoothTap(d.x) * d.y * smoothTap(d.z);
    gradient.z() += smoothTap(d.x) * smoothTap(d.y) * d.z;
  });
  return gradient;
}

ReferenceExtractor::IntegerMatrix ReferenceExtractor::structureTensor(const VoxelIndex& v) const {
  IntegerMatrix tensor = IntegerMatrix::Zero();
  forEachOffset(2, [&](const VoxelIndex& d) {
    const IntegerVector& gradient = sobel(shifted(v, d));
    const int64_t weight = binomialTap(d.x) * binomialTap(d.y) * binomialTap(d.z);
    tensor += weight * gradient * gradient.transpose();
  });
  return tensor;
}

ReferenceExtractor::IntegerMatrix ReferenceExtractor::scaledCovariance(const VoxelIndex& v,
                                                                       int64_t& n) const {
  std::vector<IntegerVector> positions;
  forEachOffset(3, [&](const VoxelIndex& d) {
    if (isOccupied(shifted(v, d))) positions.emplace_back(d.x, d.y, d.z);
  });
  n = static_cast<int64_t>(positions.size());
  IntegerVector sum = IntegerVector::Zero();
  for (const auto& position : positions) sum += position;
  IntegerMatrix scatter = IntegerMatrix::Zero();
  for (const auto& position : positions) {
    const IntegerVector from_mean = n * position - sum;
    scatter += from_mean * from_mean.transpose();
  }
  return scatter;
}

double ReferenceExtractor::support(const VoxelIndex& v) const {
  int64_t n = 0;
  const Eigen::Matrix3d scatter = scaledCovariance(v, n).cast<double>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  return solver.eigenvalues().x() / static_cast<double>(n * n * n);
}

bool ReferenceExtractor::isSupported(const VoxelIndex& v, double support) const {
  int64_t n = 0;
  const IntegerMatrix scatter = scaledCovariance(v, n);
  const int64_t threshold = fixedPoint(support, 10) * n * n / 1024;  // times n^2, rounded down
  return positiveEigenvalues(scatter - n * threshold * IntegerMatrix::Identity()) == 3;
}

bool ReferenceExtractor::isSparse(const VoxelIndex& v) const {
  const IntegerMatrix tensor = structureTensor(v).unaryExpr(&sixteenth);
  return positiveEigenvalues(fixedPoint(0.1, 15) * IntegerMatrix::Identity() - tensor) == 3;
}

bool ReferenceExtractor::isEdge(const VoxelIndex& v, double magnitude,
                                const EdgeThresholds& thresholds) const {
  const IntegerMatrix tensor = structureTensor(v).unaryExpr(&sixteenth);
  const int64_t rho = fixedPoint(thresholds.ratio / (1.0 + thresholds.ratio), 16);
  const int64_t threshold = std::max(fixedPoint(magnitude, 15), rho * tensor.trace() / 65536);
  if (positiveEigenvalues(tensor - threshold * IntegerMatrix::Identity()) < 2) return false;
  return thresholds.support == 0.0 || isSupported(v, thresholds.support);
}

const Eigen::Vector3d& ReferenceExtractor::paperGradient(const VoxelIndex& cell) const {
  static const std::array<double, 13> kDecay = [] {  // exp(-(x^2+y^2+z^2) / (h/2)^2)
    std::array<double, 13> decay{};
    for (size_t i = 0; i < decay.size(); ++i) decay[i] = std::exp(-static_cast<double>(i));
    return decay;
  }();
  const auto [entry, is_new] = paper_gradient_.try_emplace(cell, Eigen::Vector3d::Zero());
  Eigen::Vector3d& gradient = entry->second;
  if (!is_new) return gradient;
  forEachOffset(2, [&](const VoxelIndex& d) {
    if (!isOccupied(shifted(cell, d))) return;
    gradient -= Eigen::Vector3d(d.x, d.y, d.z) * kDecay[static_cast<size_t>(squaredLength(d))];
  });
  return gradient;
}

Eigen::Vector3d ReferenceExtractor::paperEigenvalues(const VoxelIndex& v) const {
  constexpr double kHalfWidth = 2.0;
  Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
  forEachOffset(2, [&](const VoxelIndex& d) {
    const Eigen::Vector3d& gradient = paperGradient(shifted(v, d));
    tensor += std::exp(-squaredLength(d) / kHalfWidth) * gradient * gradient.transpose();
  });
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor).eigenvalues();
}

bool ReferenceExtractor::isPaperEdge(const VoxelIndex& v) const {
  const Eigen::Vector3d eigenvalues = paperEigenvalues(v);
  return eigenvalues[0] < 1.0 && eigenvalues[1] > 1.0;
}

std::vector<VoxelIndex> ReferenceExtractor::select(
    const std::function<bool(const VoxelIndex&)>& chosen) const {
  std::vector<VoxelIndex> out;
  std::copy_if(voxels_.begin(), voxels_.end(), std::back_inserter(out), chosen);
  return out;
}

std::vector<VoxelIndex> ReferenceExtractor::edges(double magnitude,
                                                  const EdgeThresholds& thresholds) const {
  return select([&](const VoxelIndex& v) { return isEdge(v, magnitude, thresholds); });
}

std::vector<VoxelIndex> ReferenceExtractor::paperEdges() const {
  return select([&](const VoxelIndex& v) { return isPaperEdge(v); });
}

std::vector<VoxelIndex> thinnedAtOnce(const std::vector<VoxelIndex>& candidates, int neighbours) {
  const std::unordered_set<VoxelIndex, HashVoxel> all(candidates.begin(), candidates.end());
  std::vector<VoxelIndex> thinned;
  for (const VoxelIndex& v : candidates) {
    int count = -1;  // itself
    for (int i = 0; i < 27; ++i) {
      count += static_cast<int>(all.count({v.x + i % 3 - 1, v.y + i / 3 % 3 - 1, v.z + i / 9 - 1}));
    }
    if (count >= neighbours) thinned.push_back(v);
  }
  return thinned;
}

std::vector<VoxelIndex> labelledAtOnce(const std::vector<VoxelIndex>& hit,
                                       const EdgeConfig& config) {
  const auto occupied = gridOf<32>(hit);
  BitGrid<32> candidates;
  EdgeLabeller<32>(config, config.map, 1).label(occupied, occupied, candidates);
  const bool paper = config.mode == EdgeMode::kPaper;
  return thinnedAtOnce(voxelsOf(candidates), paper ? 0 : config.map_neighbours);
}

}  // namespace edgevox::test
