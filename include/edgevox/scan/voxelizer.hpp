// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/grid/block_grid.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/scan/voxel_scan.hpp"

namespace edgevox {

enum class Scalar { kFloat32, kFloat64, kUint32 };

constexpr double kLongestTimeOffset = 2.0;  ///< of a point from the stamp [s]

/// Where a point keeps its time: (value - start) * unit seconds after the cloud's stamp.
struct TimeField {
  bool present = false;
  size_t offset = 0;
  Scalar type = Scalar::kFloat32;
  double unit = 1.0;
  double start = 0.0;
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

/// Says that a scan has more voxels than VoxelizerConfig::max_voxels, and what to do.
std::string tooManyVoxelsText(const VoxelizerConfig& config);

/// View of tightly packed points, without times.
CloudView viewOf(const std::vector<Eigen::Vector3f>& points, double stamp, std::string frame);

/// Turns clouds into occupied voxels of half the map's voxel size. Voxels of a block follow one
/// another, blocks in order of their first point, voxels likewise, so that all later stages walk
/// through memory. Keeps its memory from cloud to cloud. Points that are not finite, out of
/// range or kIndexLimit voxels away, or whose times are not within kLongestTimeOffset of the stamp,
/// are dropped and counted. A cloud of more points or voxels than
/// the configuration allows is given up, see VoxelScan::too_large.
class Voxelizer {
 public:
  /// `map_voxel_size` [m]
  Voxelizer(const VoxelizerConfig& config, double map_voxel_size);

  VoxelScan voxelize(const CloudView& cloud);

  double voxelSize() const { return voxel_size_; }

 private:
  using Layout = BlockLayout<16>;

  static constexpr uint16_t kNoSum = 0xffff;

  /// Points in sequence that fell into one block; it ends where the next one begins.
  struct Run {
    uint64_t corner;  ///< packedIndex() of the block's lowest voxel
    uint32_t begin;
    uint32_t block;  ///< in blocks_
  };

  struct Block {
    uint64_t corner;  ///< as of its runs
    uint32_t end;     ///< number of its runs, then their end in sorted_
  };

  /// A part of points_.
  struct Span {
    uint32_t begin;
    uint32_t end;
  };

  /// The points of a voxel.
  struct Sum {
    Eigen::Vector4f sum = Eigen::Vector4f::Zero();  ///< as in points_
    uint32_t cell = 0;
    uint32_t count = 0;
  };

  class Writer;
  template <typename Coordinate, typename Time>
  class Reader;

  template <typename Coordinate>
  void readCloud(const CloudView& cloud, VoxelScan& scan);
  template <typename Coordinate, typename Time>
  void readPoints(const CloudView& cloud, VoxelScan& scan);
  double farthest() const;  ///< [m]
  void countDropped(const Eigen::Vector3d& point, DroppedPoints& dropped) const;
  uint32_t slotOf(uint64_t corner);
  /// Sorts the runs by block; false if there are more blocks.
  bool sortRuns(size_t max_blocks);
  void collect(size_t max_voxels, VoxelScan& scan);
  void sumPoints(const Span& span);
  void finishBlock(const VoxelIndex& block, VoxelScan& scan);

  VoxelizerConfig config_;
  double voxel_size_;
  uint64_t scans_ = 0;
  BlockTable table_;
  std::vector<Eigen::Vector4f> points_;  // offset from the voxel's lower corner [m], time [s]
  std::vector<uint16_t> cells_;          // of the same, within their blocks
  uint32_t point_count_ = 0;
  size_t last_voxels_ = 0;  // of the last scan
  uint32_t run_count_ = 0;
  std::vector<Run> runs_;
  std::vector<Span> sorted_;            // by block
  std::vector<Block> blocks_;           // by slot in table_
  std::vector<Sum> sums_;               // of one block, a cell at most one
  uint32_t used_sums_ = 0;              // the others are 0
  std::vector<uint16_t> slot_of_cell_;  // in sums_, or kNoSum
  std::vector<uint32_t> slot_hint_;     // of a block, by low bits of its index; may be wrong
};

}  // namespace edgevox
