// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/scan/voxelizer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>

namespace edgevox {
namespace {

// Pairs: numbers of two points.
typedef double Double2 __attribute__((vector_size(16)));
typedef float Float4 __attribute__((vector_size(16)));
typedef float Float2 __attribute__((vector_size(8)));
using Long2 = decltype(Double2() < Double2());  // of comparisons: -1 where true

template <typename T>
T load(const uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

template <typename T>
inline Double2 loadPair(const uint8_t* first, const uint8_t* second) {
  typedef T Pair __attribute__((vector_size(2 * sizeof(T))));
  return __builtin_convertvector((Pair{load<T>(first), load<T>(second)}), Double2);
}

template <typename T>
inline Double2 pairOf(T first, T second) {
  return Double2{static_cast<double>(first), static_cast<double>(second)};
}

inline bool both(const Long2& is) { return (is[0] & is[1]) != 0; }

/// Two points [m].
struct PointPair {
  Double2 x;
  Double2 y;
  Double2 z;

  Double2 squaredNorm() const { return x * x + (y * y + z * z); }
};

/// Where TimeField::present is false.
struct NoTime {};

/// Reads points' times, in seconds from the cloud's stamp.
template <typename Time>
class TimeReader {
 public:
  explicit TimeReader(const CloudView& cloud)
      : offset_(cloud.time.offset),
        unit_{cloud.time.unit, cloud.time.unit},
        start_{cloud.time.start, cloud.time.start} {}

  Double2 read(const uint8_t* first, const uint8_t* second) const {
    return (loadPair<Time>(first + offset_, second + offset_) - start_) * unit_;
  }

 private:
  size_t offset_;
  Double2 unit_;
  Double2 start_;
};

template <>
class TimeReader<NoTime> {
 public:
  explicit TimeReader(const CloudView&) {}
  Double2 read(const uint8_t*, const uint8_t*) const { return Double2{}; }
};

inline Long2 isGoodTime(const Double2& time) {
  constexpr Double2 kLongest = {kLongestTimeOffset, kLongestTimeOffset};
  return (time >= -kLongest) & (time <= kLongest);
}

/// The largest integer not above a number; the low 21 bits of `bits` are it + kIndexLimit.
struct Floor {
  Double2 value;
  Long2 bits;
};

/// The floor of numbers in [-kIndexLimit, kIndexLimit): doubles of 2^52 and more have no bits
/// behind the point, and their lowest bits are those of an integer.
inline Floor floorOf(const Double2& v) {
  constexpr Double2 kWhole = {0x1p52 + kIndexLimit, 0x1p52 + kIndexLimit};
  constexpr Double2 kOne = {1.0, 1.0};
  const Double2 sum = v + kWhole;
  const Double2 nearest = sum - kWhole;
  const Long2 above = nearest > v;
  return {nearest - (above ? kOne : Double2{}), reinterpret_cast<Long2>(sum) + above};
}

/// Sets the means by the sum of offsets from the voxel's lower corner and of times.
inline void setMeans(const Eigen::Vector4f& sum, double voxel_size, ScanVoxel& voxel) {
  const Eigen::Vector4f mean = sum * (1.0F / static_cast<float>(voxel.point_count));
  const VoxelIndex& index = voxel.index;
  const Double2 xy = pairOf(index.x, index.y) * voxel_size;
  const Double2 z = pairOf(index.z, 0) * voxel_size;
  const Float2 centroid_xy = __builtin_convertvector(xy + pairOf(mean[0], mean[1]), Float2);
  const Float2 z_and_time = __builtin_convertvector(z + pairOf(mean[2], mean[3]), Float2);
  voxel.centroid = {centroid_xy[0], centroid_xy[1], z_and_time[0]};
  voxel.time_offset = z_and_time[1];
}

}  // namespace

std::string tooManyVoxelsText(const VoxelizerConfig& config) {
  return "it has more than " + std::to_string(config.max_voxels) +
         " voxels; choose a larger voxel_size or a smaller voxelizer/max_range, or, with memory to "
         "spare, a larger voxelizer/max_voxels";
}

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
      : points_(to.points_.data()),
        cells_(to.cells_.data()),
        runs_(to.runs_.data()),
        size_{to.voxel_size_, to.voxel_size_},
        inverse_size_{1.0 / to.voxel_size_, 1.0 / to.voxel_size_} {}

  /// The first `count` of two.
  void add(const PointPair& at, const Float2& time, int count) {
    const Floor x = floorOf(at.x * inverse_size_);
    const Floor y = floorOf(at.y * inverse_size_);
    const Floor z = floorOf(at.z * inverse_size_);
    const Long2 voxel = (x.bits & kIndexBits) | y.bits << 21 | z.bits << 42;
    const Float2 dx = __builtin_convertvector(at.x - x.value * size_, Float2);
    const Float2 dy = __builtin_convertvector(at.y - y.value * size_, Float2);
    const Float2 dz = __builtin_convertvector(at.z - z.value * size_, Float2);
    const auto xy = reinterpret_cast<Double2>(Float4{dx[0], dy[0], dx[1], dy[1]});
    const auto zt = reinterpret_cast<Double2>(Float4{dz[0], time[0], dz[1], time[1]});
    add(Double2{xy[0], zt[0]}, voxel[0]);
    if (count == 2) add(Double2{xy[1], zt[1]}, voxel[1]);
  }

  uint32_t count() const { return static_cast<uint32_t>(count_); }
  uint32_t runCount() const { return static_cast<uint32_t>(run_count_); }

 private:
  static constexpr int64_t kIndexBits = 2 * kIndexLimit - 1;
  static constexpr uint64_t kCellBits = 0xfULL | 0xfULL << 21 | 0xfULL << 42;

  /// A point as in points_, by the bits, and packedIndex() of its voxel. Without branches on the
  /// data: the next run overwrites the one that has not begun.
  void add(const Double2& point, int64_t packed_voxel) {
    const auto voxel = static_cast<uint64_t>(packed_voxel);
    const uint64_t cell = voxel & kCellBits;
    const uint64_t corner = voxel & ~kCellBits;
    std::memcpy(points_[count_].data(), &point, sizeof(point));
    cells_[count_] = static_cast<uint16_t>(cell | cell >> 17 | cell >> 34);
    runs_[run_count_].corner = corner;
    runs_[run_count_].begin = static_cast<uint32_t>(count_);
    run_count_ += corner != last_corner_ ? 1 : 0;
    last_corner_ = corner;
    ++count_;
  }

  Eigen::Vector4f* points_;
  uint16_t* cells_;
  Run* runs_;
  Double2 size_;
  Double2 inverse_size_;
  uint64_t last_corner_ = ~uint64_t{0};  // none has all bits
  size_t count_ = 0;
  size_t run_count_ = 0;
};

/// Reads two points at a time, and one by one those that are dropped or have a bad time.
template <typename Coordinate, typename Time>
class Voxelizer::Reader {
 public:
  Reader(Voxelizer& to, const CloudView& cloud, DroppedPoints& dropped)
      : to_(to), out_(to), times_(cloud), offset_(cloud.xyz_offset), dropped_(dropped) {
    const double near = to.config_.min_range * to.config_.min_range;
    const double far = to.farthest() * to.farthest();
    near_ = Double2{near, near};
    far_ = Double2{far, far};
  }

  void read(const CloudView& cloud) {
    const size_t step = cloud.point_step;
    for (size_t row = 0; row < cloud.height; ++row) {
      const uint8_t* at = cloud.data + row * cloud.row_step;
      const uint8_t* end = at + cloud.width / 2 * 2 * step;
      for (; at != end; at += 2 * step) readTwo(at, at + step);
      if (cloud.width % 2 != 0) readOne(at);
    }
    to_.point_count_ = out_.count();
    to_.run_count_ = out_.runCount();
  }

 private:
  PointPair points(const uint8_t* first, const uint8_t* second) const {
    const auto axis = [&](size_t k) {
      return loadPair<Coordinate>(first + offset_[k], second + offset_[k]);
    };
    return {axis(0), axis(1), axis(2)};
  }

  Long2 inRange(const PointPair& at) const {
    const Double2 range = at.squaredNorm();
    return (range >= near_) & (range <= far_);  // NaN fails both
  }

  void readTwo(const uint8_t* first, const uint8_t* second) {
    const PointPair at = points(first, second);
    const Double2 time = times_.read(first, second);
    if (both(inRange(at) & isGoodTime(time))) {
      const Float2 rounded = __builtin_convertvector(time, Float2);
      out_.add(at, rounded, 2);
    } else {
      readOne(first);
      readOne(second);
    }
  }

  void readOne(const uint8_t* point) {
    const PointPair at = points(point, point);
    if (!both(inRange(at))) {
      to_.countDropped({at.x[0], at.y[0], at.z[0]}, dropped_);
      return;
    }
    const Double2 time = times_.read(point, point);
    if (!both(isGoodTime(time))) {
      ++dropped_.bad_time;
      return;
    }
    out_.add(at, __builtin_convertvector(time, Float2), 1);
  }

  Voxelizer& to_;
  Writer out_;
  TimeReader<Time> times_;
  std::array<size_t, 3> offset_;
  DroppedPoints& dropped_;
  Double2 near_;
  Double2 far_;
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
  const auto max_voxels = static_cast<size_t>(config_.max_voxels);
  if (scan.points_read > static_cast<size_t>(config_.max_points)) {
    scan.too_large = "it has " + std::to_string(scan.points_read) + " points, more than " +
                     std::to_string(config_.max_points) +
                     "; thin the clouds in the driver or, with memory to spare, choose a larger "
                     "voxelizer/max_points";
    return scan;
  }
  table_.clear();
  blocks_.clear();
  points_.resize(scan.points_read);
  cells_.resize(scan.points_read);
  runs_.resize(scan.points_read + 1);

  cloud.xyz_type == Scalar::kFloat64 ? readCloud<double>(cloud, scan)
                                     : readCloud<float>(cloud, scan);
  if (sortRuns(max_voxels)) collect(max_voxels, scan);
  if (scan.voxels.empty() && blocks_.size() > 0) scan.too_large = tooManyVoxelsText(config_);
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
  Reader<Coordinate, Time>(*this, cloud, scan.dropped).read(cloud);
}

double Voxelizer::farthest() const {
  return std::min(config_.max_range, (kIndexLimit - 1) * voxel_size_);
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
uint32_t Voxelizer::slotOf(uint64_t corner) {
  const uint64_t bits = (corner >> 4 & 31) | (corner >> 25 & 31) << 5 | (corner >> 46 & 7) << 10;
  uint32_t& hint = slot_hint_[bits];
  if (hint >= blocks_.size() || blocks_[hint].corner != corner) {
    hint = static_cast<uint32_t>(table_.findOrInsert(Layout::block(unpackedIndex(corner))));
    if (hint == blocks_.size()) blocks_.push_back({corner, 0});
  }
  return hint;
}

bool Voxelizer::sortRuns(size_t max_blocks) {
  for (uint32_t i = 0; i < run_count_; ++i) {
    runs_[i].block = slotOf(runs_[i].corner);
    if (blocks_.size() > max_blocks) return false;
    ++blocks_[runs_[i].block].end;
  }
  uint32_t begin = 0;
  for (Block& block : blocks_) {
    const uint32_t count = block.end;
    block.end = begin;
    begin += count;
  }
  sorted_.resize(run_count_);
  runs_[run_count_].begin = point_count_;
  for (uint32_t i = 0; i < run_count_; ++i) {
    sorted_[blocks_[runs_[i].block].end++] = {runs_[i].begin, runs_[i + 1].begin};
  }
  return true;
}

/// Leaves no voxels if there are more than allowed.
void Voxelizer::collect(size_t max_voxels, VoxelScan& scan) {
  constexpr size_t kAhead = 16;  // spans whose points are fetched before they are summed
  scan.voxels.reserve(std::max<size_t>(point_count_ / 2, last_voxels_ + last_voxels_ / 8));
  size_t i = 0;
  for (size_t block = 0; block < blocks_.size(); ++block) {
    for (; i < blocks_[block].end; ++i) {
      __builtin_prefetch(&points_[sorted_[std::min(i + kAhead, sorted_.size() - 1)].begin]);
      sumPoints(sorted_[i]);
    }
    finishBlock(table_.block(block), scan);
    if (scan.voxels.size() <= max_voxels) continue;
    scan.voxels = {};
    break;
  }
  last_voxels_ = scan.voxels.size();
}

/// Sums without branches on the data, which processors could not foresee.
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
  constexpr uint32_t kRow = 16;
  const double voxel_size = voxel_size_;
  uint16_t* slot_of_cell = slot_of_cell_.data();
  Sum* end = sums_.data() + used_sums_;
  for (Sum* sum = sums_.data(); sum != end; ++sum) {
    const uint32_t cell = sum->cell;
    ScanVoxel& voxel = scan.voxels.emplace_back();
    voxel.index =
        Layout::voxel(block, static_cast<int>(cell / kRow), static_cast<int>(cell % kRow));
    voxel.point_count = sum->count;
    setMeans(sum->sum, voxel_size, voxel);
    slot_of_cell[cell] = kNoSum;
    *sum = {};
  }
  used_sums_ = 0;
}

}  // namespace edgevox
