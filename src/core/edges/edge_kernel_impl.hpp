// SPDX-License-Identifier: BSD-3-Clause
// Structure tensor of a block's target voxels (Ryde et al. 2013, eq. 5, with Sobel gradients and
// binomial weights), and the decision edge or not. Sums along x are shared between voxels, those
// along y and z are taken at the targets only. All arithmetic is exact, so any instruction set
// and any block size give the same labels.
#pragma once

#include <cstring>

#include "core/edges/edge_kernel.hpp"

namespace edgevox {
namespace kernel {
namespace {

typedef int8_t Int8x8 __attribute__((vector_size(8)));
typedef int8_t Int8x16 __attribute__((vector_size(16)));
typedef int16_t Int16x8 __attribute__((vector_size(16)));
typedef int32_t Int32x8 __attribute__((vector_size(32)));

/// What six voxels of a row add to the gradients (gx, gy, gz, 0) of the four cells amid them.
struct GradientTable {
  alignas(16) int8_t add[3][3][64][16];  // voxel row offset z + 1, y + 1, bits of the voxels

  constexpr GradientTable() : add() {
    constexpr int smooth[3] = {1, 2, 1};
    constexpr int slope[3] = {-1, 0, 1};
    for (int z = 0; z < 3; ++z) {
      for (int y = 0; y < 3; ++y) {
        for (int bits = 0; bits < 64; ++bits) {
          for (int c = 0; c < 4; ++c) {
            int8_t* cell = add[z][y][bits] + 4 * c;
            for (int x = 0; x < 3; ++x) {
              if (((bits >> (c + x)) & 1) == 0) continue;
              cell[0] = static_cast<int8_t>(cell[0] + slope[x] * smooth[y] * smooth[z]);
              cell[1] = static_cast<int8_t>(cell[1] + smooth[x] * slope[y] * smooth[z]);
              cell[2] = static_cast<int8_t>(cell[2] + smooth[x] * smooth[y] * slope[z]);
            }
          }
        }
      }
    }
  }
};
constexpr GradientTable kGradients;

/// Number, sum and sum of squares of the positions -3..3 that are set in 7 bits, and zeros.
struct RowMoments {
  alignas(16) int16_t value[8] = {};
};
struct RowMomentTable {
  RowMoments of[128];

  constexpr RowMomentTable() : of() {
    for (int bits = 0; bits < 128; ++bits) {
      int16_t* value = of[bits].value;
      for (int i = 0; i < 7; ++i) {
        if (((bits >> i) & 1) == 0) continue;
        ++value[0];
        value[1] = static_cast<int16_t>(value[1] + (i - 3));
        value[2] = static_cast<int16_t>(value[2] + (i - 3) * (i - 3));
      }
    }
  }
};
constexpr RowMomentTable kRowMoments;

template <typename Vector, typename T>
inline Vector load(const T* at) {
  Vector v;
  std::memcpy(&v, at, sizeof(v));
  return v;
}

template <typename Vector, typename T>
inline void store(T* at, const Vector& v) {
  std::memcpy(at, &v, sizeof(v));
}

#ifdef __clang__
#define EDGEVOX_SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
#define EDGEVOX_SHUFFLE(a, b, ...) __builtin_shuffle(a, b, Int16x8{__VA_ARGS__})
#endif

/// Turns the gradients (gx, gy, gz, 0) of two cells into their products
/// (xx, yy, zz, 0, xy, yz, zx, 0).
inline void multiplyGradients(const int8_t* gradients, int16_t (*products)[8]) {
  const Int16x8 g = __builtin_convertvector(load<Int8x8>(gradients), Int16x8);
  const Int16x8 turned = EDGEVOX_SHUFFLE(g, g, 1, 2, 0, 3, 5, 6, 4, 7);
  const Int16x8 squares = g * g;
  const Int16x8 mixed = g * turned;
  store(products[0], EDGEVOX_SHUFFLE(squares, mixed, 0, 1, 2, 3, 8, 9, 10, 11));
  store(products[1], EDGEVOX_SHUFFLE(squares, mixed, 4, 5, 6, 7, 12, 13, 14, 15));
}
#undef EDGEVOX_SHUFFLE

/// Symmetric 3x3 matrix; the order of the components of a tensor everywhere below.
struct Tensor {
  int64_t xx, yy, zz, xy, yz, zx;
};

struct CharacteristicPolynomial {
  int64_t c2, c1, c0;  // l^3 - c2 l^2 + c1 l - c0
};

inline CharacteristicPolynomial characteristic(const Tensor& m) {
  const int64_t minor_x = m.yy * m.zz - m.yz * m.yz;
  const int64_t minor_y = m.xx * m.zz - m.zx * m.zx;
  const int64_t minor_z = m.xx * m.yy - m.xy * m.xy;
  return {m.xx + m.yy + m.zz, minor_x + minor_y + minor_z,
          m.xx * minor_x - m.xy * (m.xy * m.zz - m.yz * m.zx) + m.zx * (m.xy * m.yz - m.yy * m.zx)};
}

/// Counts positive eigenvalues by Descartes' rule, exact because all roots are real.
inline bool isEdge(const Tensor& tensor, const Thresholds& thresholds) {
  const int64_t trace = tensor.xx + tensor.yy + tensor.zz;
  const int64_t relative = (thresholds.rho * trace) >> kRatioBits;
  const int64_t t = relative > thresholds.magnitude ? relative : thresholds.magnitude;
  const auto p = characteristic(
      {tensor.xx - t, tensor.yy - t, tensor.zz - t, tensor.xy, tensor.yz, tensor.zx});
  const bool exactly_two = (p.c0 < 0) & !((p.c2 <= 0) & (p.c1 >= 0));
  const bool others_positive = (p.c0 >= 0) & (p.c2 > 0) & (p.c1 > 0);
  return exactly_two | (others_positive & !thresholds.exclude_corners);
}

/// Whether all eigenvalues are below t: tensor - t I is negative definite. The largest is at least
/// as large as any of the diagonal, which settles most voxels.
inline bool isSparse(const Tensor& tensor, int64_t t) {
  if ((tensor.xx >= t) | (tensor.yy >= t) | (tensor.zz >= t)) return false;
  const auto p = characteristic(
      {tensor.xx - t, tensor.yy - t, tensor.zz - t, tensor.xy, tensor.yz, tensor.zx});
  return (p.c1 > 0) & (p.c0 < 0);
}

template <int kSide>
class BlockLabeller {
 public:
  BlockLabeller(const uint64_t* occupied, const uint32_t* targets) : occupied_(occupied) {
    std::memset(zero_, 0, sizeof(zero_));
    std::memset(target_, 0, sizeof(target_));
    for (int z = 0; z < kSide; ++z) {
      uint32_t any = 0;
      for (int y = 0; y < kSide; ++y) any |= targets[z * kSide + y];
      if (any == 0) continue;
      target_planes_ |= uint64_t{1} << (z + 2 * kReach);
      std::memcpy(target_[z + 2 * kReach] + 2 * kReach, targets + z * kSide,
                  kSide * sizeof(uint32_t));
    }
  }

  size_t label(uint32_t* edges, const Thresholds& thresholds) {
    size_t sparse = 0;
    std::memset(edges, 0, kSide * kSide * sizeof(uint32_t));
    for (int z = -kReach; z < kSide + kReach; ++z) {
      if (((target_planes_ >> (z + kReach)) & 31) != 0) sumRowsOfSlab(z);
      const int ready = z - kReach;
      if (ready < 0 || !hasTargets(ready)) continue;
      sparse += labelSlab(ready, edges + ready * kSide, thresholds);
    }
    return sparse;
  }

 private:
  static constexpr int kReach = 2;                   // of the tensor's weights
  static constexpr int kCells = kSide + 2 * kReach;  // cells with a gradient, an axis
  static constexpr int kRows = kSide + 2 * kHalo;    // rows of occupancy, an axis
  static constexpr int kSlabs = 2 * kReach + 1;

  using SumRow = int16_t[kSide][8];

  bool hasTargets(int z) const { return ((target_planes_ >> (z + 2 * kReach)) & 1) != 0; }

  const uint64_t* occupiedRow(int y, int z) const {
    return occupied_ + (z + kHalo) * kRows + y + kHalo;
  }

  /// Voxels of rows (y + dy, z + dz), |dy|, |dz| <= kReach, that are targets.
  void sumsNeeded(int z, uint32_t* needed) const {
    uint32_t in_z[kCells + 2 * kReach];
    for (int y = 0; y < kCells + 2 * kReach; ++y) {
      const auto row = [&](int dz) { return target_[z + 2 * kReach + dz][y]; };
      in_z[y] = row(-2) | row(-1) | row(0) | row(1) | row(2);
    }
    for (int y = 0; y < kCells; ++y) {
      needed[y] = in_z[y] | in_z[y + 1] | in_z[y + 2] | in_z[y + 3] | in_z[y + 4];
    }
  }

  /// Products of gradients summed along x where a target of the five slabs around z needs them.
  void sumRowsOfSlab(int z) {
    const int slab = (z + kReach) % kSlabs;
    uint32_t needed[kCells];
    sumsNeeded(z, needed);
    for (int y = -kReach; y < kSide + kReach; ++y) {
      const int16_t(*&row)[8] = sum_row_[slab][y + kReach];
      row = zero_;
      if (needed[y + kReach] == 0) continue;
      if (!multiplyRow(y, z)) continue;
      SumRow& sums = sum_[slab][y + kReach];
      sumAlongX(needed[y + kReach], sums);
      row = sums;
    }
  }

  /// Products of the gradients of the row's cells; false if all are 0. The nine rows of voxels are
  /// taken whether empty or not: which of them are cannot be foreseen by a processor.
  bool multiplyRow(int y, int z) {
    uint64_t row[9];
    uint64_t any = 0;
    for (int i = 0; i < 9; ++i) {
      row[i] = *occupiedRow(y + i % 3 - 1, z + i / 3 - 1);
      any |= row[i];
    }
    if (any == 0) return false;
    for (int c = 0; c < kCells; c += 4) {
      Int8x16 sum = {};
      for (int i = 0; i < 9; ++i) {
        sum += load<Int8x16>(kGradients.add[i / 3][i % 3][(row[i] >> c) & 63]);
      }
      alignas(16) int8_t gradients[16];
      store(gradients, sum);
      multiplyGradients(gradients, product_ + c);
      multiplyGradients(gradients + 8, product_ + c + 2);
    }
    return true;
  }

  /// Weights 1 4 6 4 1; at most 16 * 256.
  void sumAlongX(uint32_t needed, SumRow& sums) const {
    for (; needed != 0; needed &= needed - 1) {
      const int x = __builtin_ctz(needed);
      const auto product = [&](int c) { return load<Int16x8>(product_[x + c]); };
      const Int16x8 middle = product(2);
      store(sums[x],
            (product(0) + product(4)) + ((product(1) + middle + product(3)) << 2) + (middle << 1));
    }
  }

  size_t labelSlab(int z, uint32_t* edges, const Thresholds& thresholds) const {
    size_t sparse = 0;
    for (int y = 0; y < kSide; ++y) {
      uint32_t found = 0;
      for (uint32_t bits = target_[z + 2 * kReach][y + 2 * kReach]; bits != 0; bits &= bits - 1) {
        const int x = __builtin_ctz(bits);
        const Tensor tensor = tensorAt(x, y, z);
        sparse += static_cast<size_t>(isSparse(tensor, thresholds.sparse));
        const bool edge = isEdge(tensor, thresholds) &&
                          (thresholds.support == 0 || isSupported(x, y, z, thresholds.support));
        found |= static_cast<uint32_t>(edge) << x;
      }
      edges[y] = found;
    }
    return sparse;
  }

  /// Sums along y and z, rows of equal weight first: four of them stay below 2^15.
  Tensor tensorAt(int x, int y, int z) const {
    const auto row = [&](int dy, int dz) {
      return load<Int16x8>(sum_row_[(z + kReach + dz) % kSlabs][y + kReach + dy][x]);
    };
    const auto cross = [&](int d) { return row(d, 0) + row(-d, 0) + row(0, d) + row(0, -d); };
    const auto square = [&](int d) { return row(d, d) + row(d, -d) + row(-d, d) + row(-d, -d); };
    const Int16x8 four_y = row(2, 1) + row(2, -1) + row(-2, 1) + row(-2, -1);
    const Int16x8 four_z = row(1, 2) + row(1, -2) + row(-1, 2) + row(-1, -2);
    const Int32x8 one = __builtin_convertvector(square(2), Int32x8);
    const Int32x8 four =
        __builtin_convertvector(four_y, Int32x8) + __builtin_convertvector(four_z, Int32x8);
    const Int32x8 six = __builtin_convertvector(cross(2), Int32x8);
    const Int32x8 sixteen = __builtin_convertvector(square(1), Int32x8);
    const Int32x8 twenty_four = __builtin_convertvector(cross(1), Int32x8);
    const Int32x8 thirty_six = __builtin_convertvector(row(0, 0), Int32x8);
    const Int32x8 sum = one + ((four + six + thirty_six) << 2) + (six << 1) +
                        ((sixteen + twenty_four) << 4) + (twenty_four << 3) + (thirty_six << 5);
    return {sum[0] >> 4, sum[1] >> 4, sum[2] >> 4, sum[4] >> 4, sum[5] >> 4, sum[6] >> 4};
  }

  /// Moments of the seven rows (y + dy, z) around a voxel: those of order 0, 1, 2 in dy.
  struct PlaneMoments {
    Int16x8 sum, first, second;  // each of (count, sum along x, sum of squares along x, 0)
  };

  static PlaneMoments planeMoments(const uint64_t* rows, int x) {
    const auto row = [&](int dy) {
      return load<Int16x8>(kRowMoments.of[(rows[dy] >> x) & 127].value);
    };
    const Int16x8 a1 = row(1), b1 = row(-1);
    const Int16x8 a2 = row(2), b2 = row(-2);
    const Int16x8 a3 = row(3), b3 = row(-3);
    const Int16x8 both1 = a1 + b1, both2 = a2 + b2, both3 = a3 + b3;
    return {row(0) + both1 + both2 + both3,
            (a1 - b1) + ((a2 - b2) << 1) + ((a3 - b3) << 1) + (a3 - b3),
            both1 + (both2 << 2) + (both3 << 3) + both3};
  }

  /// Whether the positions of the occupied voxels of the 7^3 cube spread in all directions:
  /// n^2 (covariance - support I) has three positive leading minors.
  bool isSupported(int x, int y, int z, int64_t support) const {
    PlaneMoments all = {};
    Int16x8 sum_z = {}, first_z = {}, second_z = {};
    for (int dz = -3; dz <= 3; ++dz) {
      const PlaneMoments plane = planeMoments(occupiedRow(y, z + dz), x);
      const auto d = static_cast<int16_t>(dz);
      all = {all.sum + plane.sum, all.first + plane.first, all.second + plane.second};
      sum_z += plane.sum * d;
      first_z += plane.first * d;
      second_z += plane.sum * static_cast<int16_t>(dz * dz);
    }
    const int64_t n = all.sum[0], sx = all.sum[1], sy = all.first[0], sz = sum_z[0];
    const int64_t xx = all.sum[2], yy = all.second[0], zz = second_z[0];
    const int64_t xy = all.first[1], yz = first_z[0], zx = sum_z[1];
    const int64_t t = (support * n * n) >> kSupportBits;
    const Tensor m = {n * xx - sx * sx - t, n * yy - sy * sy - t, n * zz - sz * sz - t,
                      n * xy - sx * sy,     n * yz - sy * sz,     n * zx - sz * sx};
    const int64_t minor_z = m.xx * m.yy - m.xy * m.xy;
    return m.xx > 0 && minor_z > 0 && characteristic(m).c0 > 0;
  }

  const uint64_t* occupied_;
  uint64_t target_planes_ = 0;  // bit z + 2 kReach
  uint32_t target_[kSide + 4 * kReach][kSide + 4 * kReach];
  alignas(16) int16_t product_[kCells][8];  // cells from x = -2 on
  alignas(16) SumRow sum_[kSlabs][kCells];
  alignas(16) SumRow zero_;
  const int16_t (*sum_row_[kSlabs][kCells])[8];  // into sum_, or zero_
};

template <int kSide>
size_t labelBlock(const uint64_t* occupied, const uint32_t* targets, uint32_t* edges,
                  const Thresholds& thresholds) {
  return BlockLabeller<kSide>(occupied, targets).label(edges, thresholds);
}

LabelBlock labelBlockFor(int block_edge) {
  return block_edge == 8 ? labelBlock<8> : block_edge == 16 ? labelBlock<16> : labelBlock<32>;
}

}  // namespace
}  // namespace kernel
}  // namespace edgevox
