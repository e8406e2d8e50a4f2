// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "edgevox/block_grid.hpp"
#include "edgevox/config.hpp"
#include "edgevox/voxel.hpp"

namespace edgevox {

enum class Scalar { kFloat32, kFloat64, kUint32 };

/// Where a point keeps its time; seconds = value * unit, counted from the cloud's stamp, or from
/// the epoch if `absolute`.
struct TimeField {
  bool present = false;
  size_t offset = 0;
  Scalar type = Scalar::kFloat32;
  double unit = 1.0;
  bool absolute = false;
};

/// A cloud as it lies in memory, in host byte order; does not own `data`. The maker guarantees
/// that every offset stays inside its point and every row inside `data`.
struct CloudView {
  double stamp = 0.0;  ///< [s]
  std::string frame;
  const uint8_t* data = nullptr;
  size_t width = 0;   ///< points in a row
  size_t height = 0;  ///< rows
  size_t point_step = 0;
  size_t row_step = 0;
  std::array<size_t, 3> xyz_offset{{0, 4, 8}};
  Scalar xyz_type = Scalar::kFloat32;  ///< kFloat32 or kFloat64, metres
  TimeField time;
};

/// View of tightly packed points, without times.
CloudView viewOf(const std::vector<Eigen::Vector3f>& points, double stamp, std::string frame);

/// Turns clouds into occupied voxels of half the map's voxel size. Voxels of a block follow one
/// another, blocks in order of their first point, voxels likewise, so that all later stages walk
/// through memory. Keeps its memory from cloud to cloud. Points that are not finite or out of
/// range are dropped and counted.
class Voxelizer {
 public:
  /// `map_voxel_size` [m]
  Voxelizer(const VoxelizerConfig& config, double map_voxel_size);

  VoxelScan voxelize(const CloudView& cloud);

  double voxelSize() const { return voxel_size_; }

 private:
  using Layout = BlockLayout<16>;

  /// A point of the cloud on its way to its voxel.
  struct Point {
    uint32_t block;
    uint32_t cell;
    Eigen::Vector3f offset;  ///< from the voxel's lower corner [m]
    float time;              ///< from the stamp [s]
  };

  template <typename Coordinate, bool kHasTime>
  void readPoints(const CloudView& cloud, VoxelScan& scan);
  void countDropped(const Eigen::Vector3d& point, DroppedPoints& dropped) const;
  void sortByBlock();
  void collect(VoxelScan& scan);

  VoxelizerConfig config_;
  double voxel_size_;
  uint64_t scans_ = 0;
  BlockTable table_;
  std::vector<uint32_t> block_end_;  // number of points of a block, then the end in sorted_
  std::vector<Point> points_;
  std::vector<Point> sorted_;
  std::vector<uint16_t> slot_of_cell_;  // within one block, from 1; 0 is none
};

}  // namespace edgevox
