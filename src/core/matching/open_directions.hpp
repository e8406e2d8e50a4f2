// SPDX-License-Identifier: BSD-3-Clause
// What the geometry around says of the directions of a pose.
#pragma once

#include "core/matching/correspondences.hpp"
#include "edgevox/matching/matcher.hpp"

namespace edgevox {

/// The directions that the geometry around leaves open, where a rotation is as long as the way of a
/// point at `range`.
class OpenDirections {
 public:
  /// `geometry`: see Correspondences::geometry().
  OpenDirections(const Matrix6& geometry, double range);

  const Degeneracy& degeneracy() const { return degeneracy_; }

  /// The equations without what they say of the open directions.
  NormalEquations without(const NormalEquations& equations) const;
  /// What an information says of the open directions.
  Matrix6 within(const Matrix6& information) const;

 private:
  Matrix6 inUnits(const Matrix6& projection) const;

  Vector6 metres_;  // of the unit of each component
  Matrix6 closed_ = Matrix6::Identity();
  Degeneracy degeneracy_;
};

/// See MatchResult::agreement; of geometry() and fittingGeometry().
double agreementOf(const Matrix6& geometry, const Matrix6& fitting);

}  // namespace edgevox
