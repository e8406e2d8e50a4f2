// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include <Eigen/LU>

#include "edgevox/occupied_voxel_map.hpp"

namespace edgevox {
namespace {

constexpr double kSensorSigma = 0.02;    // [m]
constexpr double kVoxelSigma = 0.3;      // [voxel]; spread assumed where few points tell
constexpr double kPriorWeight = 2.0;     // [centroids]

/// Largest root of the characteristic polynomial of a positive definite matrix, by Newton steps
/// from above: monotone, and the same on every machine.
double largestEigenvalue(const Eigen::Matrix3d& m) {
  const double c2 = m.trace();
  const double c1 = m(0, 0) * m(1, 1) + m(1, 1) * m(2, 2) + m(2, 2) * m(0, 0) -
                    m(0, 1) * m(0, 1) - m(1, 2) * m(1, 2) - m(2, 0) * m(2, 0);
  const double c0 = m.determinant();
  double l = c2;
  for (int i = 0; i < 30; ++i) {
    const double value = ((l - c2) * l + c1) * l - c0;
    const double slope = (3 * l - 2 * c2) * l + c1;
    if (!(slope > 0)) break;
    const double step = value / slope;
    l -= step;
    if (!(step > 1e-9 * l)) break;
  }
  return l;
}

Eigen::Matrix3d symmetric(const std::array<float, 6>& m) {
  Eigen::Matrix3d out;
  out << m[0], m[3], m[5], m[3], m[1], m[4], m[5], m[4], m[2];
  return out;
}

VoxelGaussian gaussianOf(const GaussianLevel::Cell& cell, const VoxelIndex& v, double size) {
  const double n = cell.count;
  const Eigen::Vector3d sum(cell.sum[0], cell.sum[1], cell.sum[2]);
  const Eigen::Matrix3d scatter = symmetric(cell.outer) - sum * sum.transpose() / n;
  const double prior = kPriorWeight * kVoxelSigma * kVoxelSigma * size * size;
  const Eigen::Matrix3d covariance =
      (scatter + prior * Eigen::Matrix3d::Identity()) / (n + kPriorWeight) +
      kSensorSigma * kSensorSigma * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d information =
      covariance.inverse() - Eigen::Matrix3d::Identity() / largestEigenvalue(covariance);
  VoxelGaussian gaussian;
  gaussian.mean = (voxelCentre(v, size) + sum / n).cast<float>();
  const auto w = information.cast<float>();
  gaussian.information = {w(0, 0), w(1, 1), w(2, 2), w(0, 1), w(1, 2), w(2, 0)};
  return gaussian;
}

float squaredDistance(const VoxelGaussian& g, const Eigen::Vector3f& point) {
  const Eigen::Vector3f e = point - g.mean;
  const auto& w = g.information;
  return e.x() * (w[0] * e.x() + 2 * (w[3] * e.y() + w[5] * e.z())) +
         e.y() * (w[1] * e.y() + 2 * w[4] * e.z()) + e.z() * w[2] * e.z();
}

}  // namespace

const VoxelGaussian* GaussianLevel::nearest(const Eigen::Vector3f& point, bool all,
                                            float& distance) const {
  static constexpr int kOffsets[7][3] = {{0, 0, 0},  {1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                         {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const VoxelIndex centre = voxelAt(point, 1.0 / voxel_size_);
  const VoxelIndex centre_block = Layout::block(centre);
  const int32_t block = grid_.findBlock(centre_block);
  const VoxelGaussian* best = nullptr;
  distance = std::numeric_limits<float>::infinity();
  for (const auto& offset : kOffsets) {
    const VoxelIndex v{centre.x + offset[0], centre.y + offset[1], centre.z + offset[2]};
    const VoxelIndex v_block = Layout::block(v);
    const int32_t slot = v_block == centre_block ? block : grid_.findBlock(v_block);
    if (slot == BlockTable::kNone) continue;
    const VoxelGaussian* candidate = findInBlock(static_cast<size_t>(slot), v, all);
    if (candidate == nullptr) continue;
    const float d = squaredDistance(*candidate, point);
    if (d < distance) {
      distance = d;
      best = candidate;
    }
  }
  return best;
}

uint32_t GaussianLevel::slotFor(const VoxelIndex& v) {
  const auto next = static_cast<uint32_t>(cells_.size());
  const uint32_t slot = grid_.insert(v, next);
  if (slot == next) {
    cells_.grow();
    voxels_.grow() = v;
    gaussians_.grow();
    while (selected_.size() < grid_.blockCount()) selected_.emplace_back(Bits{});
  }
  return slot;
}

bool GaussianLevel::add(uint32_t slot, const Eigen::Vector3d& centroid, uint32_t scan) {
  Cell& cell = cells_[slot];
  const Eigen::Vector3f d =
      (centroid - voxelCentre(voxels_[slot], voxel_size_)).cast<float>();
  for (size_t i = 0; i < 3; ++i) {
    const auto a = static_cast<Eigen::Index>(i);
    const auto b = static_cast<Eigen::Index>((i + 1) % 3);
    cell.sum[i] += d[a];
    cell.outer[i] += d[a] * d[a];
    cell.outer[i + 3] += d[a] * d[b];
  }
  ++cell.count;
  if (!cell.stale) {
    cell.stale = true;
    stale_.push_back(slot);
  }
  if (cell.last_scan == scan) return false;
  cell.last_scan = scan;
  if (cell.hits < std::numeric_limits<uint16_t>::max()) ++cell.hits;
  return true;
}

void GaussianLevel::update(uint32_t slot) {
  gaussians_[slot] = gaussianOf(cells_[slot], voxels_[slot], voxel_size_);
  cells_[slot].stale = false;
}

void GaussianLevel::updateSelected() {
  const auto keep = std::remove_if(stale_.begin(), stale_.end(), [this](uint32_t slot) {
    if (!cells_[slot].stale) return true;
    if (!isSelected(slot)) return false;
    update(slot);
    return true;
  });
  stale_.erase(keep, stale_.end());
}

void GaussianLevel::updateAll() {
  for (const uint32_t slot : stale_) {
    if (cells_[slot].stale) update(slot);
  }
  stale_.clear();
}

bool GaussianLevel::isSelected(uint32_t slot) const {
  const VoxelIndex& v = voxels_[slot];
  const auto block = static_cast<size_t>(grid_.findBlock(Layout::block(v)));
  const uint8_t row = selected_[block][static_cast<size_t>(Layout::row(v))];
  return ((row >> Layout::column(v)) & 1) != 0;
}

void GaussianLevel::select(uint32_t slot, bool selected) {
  if (isSelected(slot) == selected) return;
  const VoxelIndex& v = voxels_[slot];
  const auto block = static_cast<size_t>(grid_.findBlock(Layout::block(v)));
  uint8_t& row = selected_[block][static_cast<size_t>(Layout::row(v))];
  row = static_cast<uint8_t>(row ^ (1U << Layout::column(v)));
  selected ? ++selected_count_ : --selected_count_;
  if (selected && cells_[slot].stale) update(slot);
}

size_t GaussianLevel::blocksWithSelection() const {
  return static_cast<size_t>(
      std::count_if(selected_.begin(), selected_.end(), [](const Bits& bits) {
        return std::any_of(bits.begin(), bits.end(), [](uint8_t row) { return row != 0; });
      }));
}

size_t GaussianLevel::bytes() const {
  return grid_.bytes() + selected_.size() * sizeof(Bits) + cells_.bytes() + voxels_.bytes() +
         gaussians_.bytes();
}

}  // namespace edgevox
