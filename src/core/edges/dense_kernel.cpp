// SPDX-License-Identifier: BSD-3-Clause
#include "core/edges/dense_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace edgevox {
namespace kernel {
namespace {

/// A cube of kSide + 2 kDenseHalo cells a side, x fastest.
template <int kSide, typename Real>
class DenseBlock {
 public:
  static constexpr int kSpan = kSide + 2 * kDenseHalo;
  static constexpr int kCells = kSpan * kSpan * kSpan;
  static constexpr int kStride[3] = {1, kSpan, kSpan* kSpan};
  using Field = std::vector<Real>;

  void setTaps(const DenseTaps& taps) {
    slope_ = cast(taps.slope);
    smooth_ = cast(taps.smooth);
    weight_ = cast(taps.weight);
  }

  /// Six fields xx, yy, zz, xy, yz, zx, valid kDenseHalo cells from the border.
  const std::array<Field, 6>& tensor(const uint64_t* occupied) {
    fill(occupied);
    for (size_t axis = 0; axis < 3; ++axis) gradient_[axis] = gradientAlong(axis);
    for (size_t i = 0; i < 6; ++i) {
      const Field& a = gradient_[i % 3];
      const Field& b = gradient_[i < 3 ? i : (i + 1) % 3];
      std::transform(a.begin(), a.end(), b.begin(), product_.begin(), std::multiplies<Real>());
      tensor_[i] = weighted();
    }
    return tensor_;
  }

 private:
  using Taps = std::array<Real, 5>;

  static Taps cast(const std::array<double, 5>& taps) {
    Taps out;
    std::transform(taps.begin(), taps.end(), out.begin(),
                   [](double tap) { return static_cast<Real>(tap); });
    return out;
  }

  void fill(const uint64_t* occupied) {
    for (int row = 0; row < kSpan * kSpan; ++row) {
      for (int x = 0; x < kSpan; ++x) {
        occupancy_[static_cast<size_t>(row * kSpan + x)] =
            static_cast<Real>((occupied[row] >> x) & 1);
      }
    }
  }

  const Field& gradientAlong(size_t axis) {
    correlate(occupancy_, a_, 0, axis == 0 ? slope_ : smooth_);
    correlate(a_, b_, 1, axis == 1 ? slope_ : smooth_);
    correlate(b_, a_, 2, axis == 2 ? slope_ : smooth_);
    return a_;
  }

  const Field& weighted() {
    correlate(product_, a_, 0, weight_);
    correlate(a_, b_, 1, weight_);
    correlate(b_, a_, 2, weight_);
    return a_;
  }

  /// Cells closer than two to the ends of the memory are left at zero.
  static void correlate(const Field& in, Field& out, size_t axis, const Taps& taps) {
    const int stride = kStride[axis];
    const Real* from = in.data();
    Real* to = out.data();
    for (int i = 2 * stride; i < kCells - 2 * stride; ++i) {
      to[i] = taps[0] * from[i - 2 * stride] + taps[1] * from[i - stride] + taps[2] * from[i] +
              taps[3] * from[i + stride] + taps[4] * from[i + 2 * stride];
    }
  }

  Taps slope_{}, smooth_{}, weight_{};
  Field occupancy_ = Field(kCells), a_ = Field(kCells), b_ = Field(kCells),
        product_ = Field(kCells);
  std::array<Field, 3> gradient_;
  std::array<Field, 6> tensor_;
};

/// l^3 - c2 l^2 + c1 l - c0 of tensor - t I.
struct CharacteristicPolynomial {
  double c2, c1, c0;

  CharacteristicPolynomial(const std::array<double, 6>& m, double t) {
    const double xx = m[0] - t, yy = m[1] - t, zz = m[2] - t, xy = m[3], yz = m[4], zx = m[5];
    const double minor_x = yy * zz - yz * yz;
    c2 = xx + yy + zz;
    c1 = minor_x + (xx * zz - zx * zx) + (xx * yy - xy * xy);
    c0 = xx * minor_x - xy * (xy * zz - yz * zx) + zx * (xy * yz - yy * zx);
  }
};

/// Descartes' rule, as in the integer kernel.
bool isEdge(const std::array<double, 6>& m, const DenseThresholds& thresholds) {
  const double t = std::max(thresholds.magnitude, thresholds.rho * (m[0] + m[1] + m[2]));
  const CharacteristicPolynomial p(m, t);
  if (p.c0 < 0) return !(p.c2 <= 0 && p.c1 >= 0);
  return !thresholds.exclude_corners && p.c2 > 0 && p.c1 > 0;
}

bool isSparse(const std::array<double, 6>& m, double t) {
  const CharacteristicPolynomial p(m, t);
  return t > 0 && p.c2 < 0 && p.c1 > 0 && p.c0 < 0;
}

}  // namespace

DenseTaps paperTaps() {
  DenseTaps taps{};
  for (int i = -2; i <= 2; ++i) {
    const auto k = static_cast<size_t>(i + 2);
    taps.slope[k] = -i * std::exp(-i * i);
    taps.smooth[k] = std::exp(-i * i);
    taps.weight[k] = std::exp(-i * i / 2.0);
  }
  return taps;
}

DenseTaps integerTaps() { return {{0, -1, 0, 1, 0}, {0, 1, 2, 1, 0}, {1, 4, 6, 4, 1}}; }

template <int kSide, typename Real>
size_t labelBlockDense(const uint64_t* occupied, const uint32_t* targets, uint32_t* edges,
                       const DenseTaps& taps, const DenseThresholds& thresholds) {
  size_t sparse = 0;
  using Dense = DenseBlock<kSide, Real>;
  static thread_local Dense dense;  // 700 KB and more, kept from block to block
  dense.setTaps(taps);
  const auto& tensor = dense.tensor(occupied);
  for (int row = 0; row < kSide * kSide; ++row) {
    const int y = row % kSide + kDenseHalo;
    const int z = row / kSide + kDenseHalo;
    edges[row] = 0;
    for (uint32_t bits = targets[row]; bits != 0; bits &= bits - 1) {
      const int x = __builtin_ctz(bits);
      const auto cell =
          static_cast<size_t>(x + kDenseHalo + Dense::kStride[1] * y + Dense::kStride[2] * z);
      std::array<double, 6> m;
      for (size_t i = 0; i < 6; ++i) m[i] = static_cast<double>(tensor[i][cell]);
      edges[row] |= static_cast<uint32_t>(isEdge(m, thresholds)) << x;
      sparse += isSparse(m, thresholds.sparse) ? 1 : 0;
    }
  }
  return sparse;
}

#define EDGEVOX_DENSE(edge, real)                                                          \
  template size_t labelBlockDense<edge, real>(const uint64_t*, const uint32_t*, uint32_t*, \
                                              const DenseTaps&, const DenseThresholds&);
EDGEVOX_DENSE(8, double)
EDGEVOX_DENSE(16, double)
EDGEVOX_DENSE(32, double)
EDGEVOX_DENSE(16, float)
#undef EDGEVOX_DENSE

}  // namespace kernel
}  // namespace edgevox
