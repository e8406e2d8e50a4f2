// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/voxelizer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>

namespace edgevox {
namespace {

constexpr double kLongestSweep = 2.0;  // [s]; a time further from the stamp is a wrong unit

typedef double Double2 __attribute__((vector_size(16)));
typedef float Float2 __attribute__((vector_size(8)));
typedef int32_t Int2 __attribute__((vector_size(8)));

template <typename T>
T load(const uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

/// Where TimeField::present is false.
struct NoTime {};

template <typename Time>
double timeOffset(const uint8_t* point, const TimeField& field, double stamp) {
  const double value = static_cast<double>(load<Time>(point + field.offset)) * field.unit;
  return field.absolute ? value - stamp : value;
}

/// A point [m]; z[1] is 0.
struct Position {
  Double2 xy;
  Double2 z;

  double squaredNorm() const {
    const Double2 squares = xy * xy;
    return squares[0] + (squares[1] + z[0] * z[0]);
  }
};

template <typename Coordinate>
inline Position loadPosition(const uint8_t* at, const std::array<size_t, 3>& offset) {
  const auto axis = [&](size_t k) { return static_cast<double>(load<Coordinate>(at + offset[k])); };
  return {Double2{axis(0), axis(1)}, Double2{axis(2), 0.0}};
}

/// As floorToInt().
inline Int2 floorToInt2(const Double2& v) {
  const Int2 truncated = __builtin_convertvector(v, Int2);
  const auto above = v < __builtin_convertvector(truncated, Double2);  // -1 where true
  return truncated + __builtin_convertvector(above, Int2);
}

/// From a voxel's lower corner [m].
inline Float2 offsetFrom(const Int2& index, const Double2& at, const Double2& voxel_size) {
  return __builtin_convertvector(at - __builtin_convertvector(index, Double2) * voxel_size, Float2);
}

/// From the sum of offsets from the voxel's lower corner and of times to their means.
inline void setMeans(const Eigen::Vector4f& sum, double voxel_size, ScanVoxel& voxel) {
  const Eigen::Vector4f mean = sum * (1.0F / static_cast<float>(voxel.point_count));
  const VoxelIndex& index = voxel.index;
  const Eigen::Vector3d corner = Eigen::Vector3d(index.x, index.y, index.z) * voxel_size;
  voxel.centroid = (corner + mean.head<3>().cast<double>()).cast<float>();
  voxel.time_offset = mean[3];
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

/// Adds points to points_, cells_ and runs_.
class Voxelizer::Writer {
 public:
  explicit Writer(Voxelizer& to)
      : to_(to),
        points_(to.points_.data()),
        cells_(to.cells_.data()),
        runs_(to.runs_.data()),
        size_{to.voxel_size_, to.voxel_size_},
        inverse_size_{1.0 / to.voxel_size_, 1.0 / to.voxel_size_} {}

  void add(const Position& at, float time) {
    const Int2 xy = floorToInt2(at.xy * inverse_size_);
    const Int2 z = floorToInt2(at.z * inverse_size_);
    const Float2 offset_xy = offsetFrom(xy, at.xy, size_);
    const Float2 offset_z = offsetFrom(z, at.z, size_);
    float* point = points_[count_].data();
    std::memcpy(point, &offset_xy, sizeof(offset_xy));
    point[2] = offset_z[0];
    point[3] = time;
    cells_[count_] = static_cast<uint16_t>(Layout::cell({xy[0], xy[1], z[0]}));
    const auto block_xy = bitsOf(xy >> Layout::kShift);
    const int32_t block_z = z[0] >> Layout::kShift;
    if (block_xy != block_xy_ || block_z != block_z_ || count_ == 0) {
      const uint32_t block = to_.slotOf(Layout::block({xy[0], xy[1], z[0]}));
      ++to_.block_end_[block];
      runs_[run_count_++] = {block, count_};
      block_xy_ = block_xy;
      block_z_ = block_z;
    }
    ++count_;
  }

  uint32_t count() const { return count_; }
  uint32_t runCount() const { return run_count_; }

 private:
  static uint64_t bitsOf(const Int2& v) {
    uint64_t bits;
    std::memcpy(&bits, &v, sizeof(bits));
    return bits;
  }

  Voxelizer& to_;
  Eigen::Vector4f* points_;
  uint16_t* cells_;
  Run* runs_;
  Double2 size_;
  Double2 inverse_size_;
  uint64_t block_xy_ = 0;
  int32_t block_z_ = 0;
  uint32_t count_ = 0;
  uint32_t run_count_ = 0;
};

Voxelizer::Voxelizer(const VoxelizerConfig& config, double map_voxel_size)
    : config_(config),
      voxel_size_(map_voxel_size / 2),
      sums_(Layout::kVoxels),
      slot_of_cell_(Layout::kVoxels, kNoSum),
      slot_hint_(1 << 13) {}

VoxelScan Voxelizer::voxelize(const CloudView& cloud) {
  VoxelScan scan;
  scan.stamp = cloud.stamp;
  scan.frame = cloud.frame;
  scan.number = scans_++;
  scan.voxel_size = voxel_size_;
  scan.points_read = cloud.width * cloud.height;
  table_.clear();
  block_end_.clear();
  points_.resize(scan.points_read);
  cells_.resize(scan.points_read);
  runs_.resize(scan.points_read + 1);

  cloud.xyz_type == Scalar::kFloat64 ? readCloud<double>(cloud, scan)
                                     : readCloud<float>(cloud, scan);
  sortRuns();
  collect(scan);
  return scan;
}

template <typename Coordinate>
void Voxelizer::readCloud(const CloudView& cloud, VoxelScan& scan) {
  if (!cloud.time.present) return readPoints<Coordinate, NoTime>(cloud, scan);
  switch (cloud.time.type) {
    case Scalar::kFloat32:
      return readPoints<Coordinate, float>(cloud, scan);
    case Scalar::kFloat64:
      return readPoints<Coordinate, double>(cloud, scan);
    case Scalar::kUint32:
      return readPoints<Coordinate, uint32_t>(cloud, scan);
  }
}

template <typename Coordinate, typename Time>
void Voxelizer::readPoints(const CloudView& cloud, VoxelScan& scan) {
  const double near = config_.min_range * config_.min_range;
  const double far = config_.max_range * config_.max_range;
  const CloudView view = cloud;  // a copy stays in registers whatever is written
  float time = 0.0F;
  Writer out(*this);
  for (size_t row = 0; row < view.height; ++row) {
    const uint8_t* at = view.data + row * view.row_step;
    const uint8_t* end = at + view.width * view.point_step;
    for (; at != end; at += view.point_step) {
      const auto position = loadPosition<Coordinate>(at, view.xyz_offset);
      const double range = position.squaredNorm();
      if (!(range >= near && range <= far)) {  // NaN fails both
        countDropped({position.xy[0], position.xy[1], position.z[0]}, scan.dropped);
        continue;
      }
      if constexpr (!std::is_same_v<Time, NoTime>) {
        const double offset = timeOffset<Time>(at, view.time, view.stamp);
        const bool good = std::abs(offset) <= kLongestSweep;
        time = good ? static_cast<float>(offset) : time;
        scan.dropped.bad_time += good ? 0 : 1;
      }
      out.add(position, time);
    }
  }
  point_count_ = out.count();
  run_count_ = out.runCount();
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

/// Blocks of one cloud rarely share the low bits of their indices, so that a look at the slot found
/// last for these bits mostly saves the hash.
uint32_t Voxelizer::slotOf(const VoxelIndex& block) {
  uint32_t& hint =
      slot_hint_[static_cast<size_t>((block.z & 7) << 10 | (block.y & 31) << 5 | (block.x & 31))];
  if (hint >= table_.size() || table_.block(hint) != block) {
    hint = static_cast<uint32_t>(table_.findOrInsert(block));
    if (hint == block_end_.size()) block_end_.push_back(0);
  }
  return hint;
}

void Voxelizer::sortRuns() {
  uint32_t begin = 0;
  for (uint32_t& end : block_end_) {
    const uint32_t count = end;
    end = begin;
    begin += count;
  }
  sorted_.resize(run_count_);
  runs_[run_count_].begin = point_count_;
  for (uint32_t i = 0; i < run_count_; ++i) {
    sorted_[block_end_[runs_[i].block]++] = {runs_[i].begin, runs_[i + 1].begin};
  }
}

void Voxelizer::collect(VoxelScan& scan) {
  constexpr size_t kAhead = 16;  // spans whose points are fetched before they are summed
  scan.voxels.reserve(std::max<size_t>(point_count_ / 2, last_voxels_ + last_voxels_ / 8));
  size_t i = 0;
  for (size_t block = 0; block < block_end_.size(); ++block) {
    for (; i < block_end_[block]; ++i) {
      __builtin_prefetch(&points_[sorted_[std::min(i + kAhead, sorted_.size() - 1)].begin]);
      sumPoints(sorted_[i]);
    }
    finishBlock(table_.block(block), scan);
  }
  last_voxels_ = scan.voxels.size();
}

/// Without branches on the data, which processors could not foresee.
void Voxelizer::sumPoints(const Span& span) {
  uint16_t* slot_of_cell = slot_of_cell_.data();
  Sum* sums = sums_.data();
  uint32_t used = used_sums_;
  const uint16_t* cell = cells_.data() + span.begin;
  const Eigen::Vector4f* end = points_.data() + span.end;
  for (const Eigen::Vector4f* point = points_.data() + span.begin; point != end; ++point, ++cell) {
    const uint32_t known = slot_of_cell[*cell];
    const uint32_t is_new = known == kNoSum ? 1 : 0;
    const uint32_t slot = known ^ ((known ^ used) & (0U - is_new));  // is_new ? used : known
    used += is_new;
    slot_of_cell[*cell] = static_cast<uint16_t>(slot);
    Sum& sum = sums[slot];
    sum.sum += *point;
    sum.cell = *cell;
    ++sum.count;
  }
  used_sums_ = used;
}

void Voxelizer::finishBlock(const VoxelIndex& block, VoxelScan& scan) {
  constexpr int kRow = 16;
  const double voxel_size = voxel_size_;
  uint16_t* slot_of_cell = slot_of_cell_.data();
  Sum* end = sums_.data() + used_sums_;
  for (Sum* sum = sums_.data(); sum != end; ++sum) {
    const auto cell = static_cast<int>(sum->cell);
    ScanVoxel& voxel = scan.voxels.emplace_back();
    voxel.index = Layout::voxel(block, cell / kRow, cell % kRow);
    voxel.point_count = sum->count;
    setMeans(sum->sum, voxel_size, voxel);
    slot_of_cell[cell] = kNoSum;
    *sum = {};
  }
  used_sums_ = 0;
}

}  // namespace edgevox
