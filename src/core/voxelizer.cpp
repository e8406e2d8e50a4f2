// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/voxelizer.hpp"

#include <cmath>
#include <cstring>
#include <utility>

namespace edgevox {
namespace {

constexpr double kLongestSweep = 2.0;  // [s]; a time further from the stamp is a wrong unit

template <typename T>
T load(const uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

double timeOffset(const uint8_t* point, const CloudView& cloud) {
  const uint8_t* at = point + cloud.time.offset;
  double value = 0.0;
  switch (cloud.time.type) {
    case Scalar::kFloat32:
      value = static_cast<double>(load<float>(at));
      break;
    case Scalar::kFloat64:
      value = load<double>(at);
      break;
    case Scalar::kUint32:
      value = static_cast<double>(load<uint32_t>(at));
      break;
  }
  value *= cloud.time.unit;
  return cloud.time.absolute ? value - cloud.stamp : value;
}

/// From the sum of offsets from the voxel's lower corner to the mean.
void finish(ScanVoxel& voxel, double voxel_size) {
  const float scale = 1.0F / static_cast<float>(voxel.point_count);
  const Eigen::Vector3d corner =
      Eigen::Vector3d(voxel.index.x, voxel.index.y, voxel.index.z) * voxel_size;
  voxel.centroid = (corner + (voxel.centroid * scale).cast<double>()).cast<float>();
  voxel.time_offset *= scale;
}

}  // namespace

CloudView viewOf(const std::vector<Eigen::Vector3f>& points, double stamp, std::string frame) {
  CloudView view;
  view.stamp = stamp;
  view.frame = std::move(frame);
  view.data = reinterpret_cast<const uint8_t*>(points.data());
  view.width = points.size();
  view.height = 1;
  view.point_step = sizeof(Eigen::Vector3f);
  view.row_step = points.size() * sizeof(Eigen::Vector3f);
  return view;
}

Voxelizer::Voxelizer(const VoxelizerConfig& config, double map_voxel_size)
    : config_(config), voxel_size_(map_voxel_size / 2), slot_of_cell_(Layout::kVoxels) {}

VoxelScan Voxelizer::voxelize(const CloudView& cloud) {
  VoxelScan scan;
  scan.stamp = cloud.stamp;
  scan.frame = cloud.frame;
  scan.number = scans_++;
  scan.voxel_size = voxel_size_;
  scan.points_read = cloud.width * cloud.height;
  table_.clear();
  block_end_.clear();
  points_.clear();
  points_.reserve(scan.points_read);

  const bool wide = cloud.xyz_type == Scalar::kFloat64;
  if (cloud.time.present) {
    wide ? readPoints<double, true>(cloud, scan) : readPoints<float, true>(cloud, scan);
  } else {
    wide ? readPoints<double, false>(cloud, scan) : readPoints<float, false>(cloud, scan);
  }
  sortByBlock();
  collect(scan);
  return scan;
}

template <typename Coordinate, bool kHasTime>
void Voxelizer::readPoints(const CloudView& cloud, VoxelScan& scan) {
  const double inverse_size = 1.0 / voxel_size_;
  const double near = config_.min_range * config_.min_range;
  const double far = config_.max_range * config_.max_range;
  const auto [x_at, y_at, z_at] = cloud.xyz_offset;
  VoxelIndex last_block;
  uint32_t block_slot = 0;
  float time = 0.0F;
  for (size_t row = 0; row < cloud.height; ++row) {
    const uint8_t* at = cloud.data + row * cloud.row_step;
    for (size_t i = 0; i < cloud.width; ++i, at += cloud.point_step) {
      const Eigen::Vector3d point(load<Coordinate>(at + x_at), load<Coordinate>(at + y_at),
                                  load<Coordinate>(at + z_at));
      const double range = point.squaredNorm();
      if (!(range >= near && range <= far)) {  // NaN fails both
        countDropped(point, scan.dropped);
        continue;
      }
      const VoxelIndex index = voxelAt(point, inverse_size);
      const VoxelIndex block = Layout::block(index);
      if (points_.empty() || block != last_block) {
        block_slot = static_cast<uint32_t>(table_.findOrInsert(block));
        last_block = block;
        if (block_slot == block_end_.size()) block_end_.push_back(0);
      }
      ++block_end_[block_slot];
      const Eigen::Vector3d corner = Eigen::Vector3d(index.x, index.y, index.z) * voxel_size_;
      points_.push_back({block_slot, static_cast<uint32_t>(Layout::cell(index)),
                         (point - corner).template cast<float>(), 0.0F});
      if (kHasTime) {
        const double offset = timeOffset(at, cloud);
        if (std::abs(offset) <= kLongestSweep) {
          time = static_cast<float>(offset);
        } else {
          ++scan.dropped.bad_time;
        }
        points_.back().time = time;
      }
    }
  }
}

void Voxelizer::countDropped(const Eigen::Vector3d& point, DroppedPoints& dropped) const {
  if (!point.allFinite()) {
    ++dropped.not_finite;
  } else if (point.squaredNorm() < config_.min_range * config_.min_range) {
    ++dropped.too_near;
  } else {
    ++dropped.too_far;
  }
}

void Voxelizer::sortByBlock() {
  uint32_t begin = 0;
  for (uint32_t& end : block_end_) {
    const uint32_t count = end;
    end = begin;
    begin += count;
  }
  sorted_.resize(points_.size());
  for (const Point& point : points_) sorted_[block_end_[point.block]++] = point;
}

void Voxelizer::collect(VoxelScan& scan) {
  scan.voxels.reserve(sorted_.size() / 2);
  size_t i = 0;
  for (size_t block = 0; block < block_end_.size(); ++block) {
    const size_t first = scan.voxels.size();
    for (; i < block_end_[block]; ++i) {
      const Point& point = sorted_[i];
      uint16_t& slot = slot_of_cell_[point.cell];
      if (slot == 0) {
        const auto cell = static_cast<int>(point.cell);
        scan.voxels.emplace_back().index = Layout::voxel(table_.block(block), cell / 16, cell % 16);
        slot = static_cast<uint16_t>(scan.voxels.size() - first);
      }
      ScanVoxel& voxel = scan.voxels[first + slot - 1];
      voxel.centroid += point.offset;
      voxel.time_offset += point.time;
      ++voxel.point_count;
    }
    for (size_t v = first; v < scan.voxels.size(); ++v) {
      slot_of_cell_[static_cast<size_t>(Layout::cell(scan.voxels[v].index))] = 0;
      finish(scan.voxels[v], voxel_size_);
    }
  }
}

}  // namespace edgevox
