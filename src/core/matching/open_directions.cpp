// SPDX-License-Identifier: BSD-3-Clause
#include "core/matching/open_directions.hpp"

#include "core/matching/symmetric6.hpp"

namespace edgevox {
namespace {

constexpr double kDegenerate = 0.0015;  // mean square across what is matched, at most

}  // namespace

OpenDirections::OpenDirections(const Matrix6& geometry, double range) : metres_(Vector6::Ones()) {
  metres_.tail<3>().setConstant(1.0 / range);
  const Eigen6 eigen = eigenOf(geometry);
  degeneracy_.weakest = eigen.vectors.col(0);
  for (int i = 0; i < 6 && !(eigen.values[i] > kDegenerate); ++i) {
    const Vector6 v = eigen.vectors.col(i);
    closed_ -= v * v.transpose();
    ++degeneracy_.directions;
  }
}

NormalEquations OpenDirections::without(const NormalEquations& equations) const {
  if (degeneracy_.directions == 0) return equations;
  const Matrix6 kept = inUnits(closed_);
  NormalEquations rest = equations;
  rest.h = kept * equations.h * kept.transpose();
  rest.b = kept * equations.b;
  return rest;
}

Matrix6 OpenDirections::within(const Matrix6& information) const {
  const Matrix6 kept = inUnits(Matrix6::Identity() - closed_);
  return kept * information * kept.transpose();
}

Matrix6 OpenDirections::inUnits(const Matrix6& projection) const {
  return metres_.cwiseInverse().asDiagonal() * projection * metres_.asDiagonal();
}

/// An open direction counts as one that fits.
double agreementOf(const Matrix6& geometry, const Matrix6& fitting) {
  const Matrix6 open = kDegenerate * Matrix6::Identity();
  return leastRatio(fitting + open, geometry + open);
}

}  // namespace edgevox
