// SPDX-License-Identifier: BSD-3-Clause
// What is asked of symmetric matrices of the six directions of a pose.
#pragma once

#include "edgevox/matching/matcher.hpp"

namespace edgevox {

/// Of a positive definite matrix.
Matrix6 inverseOf(const Matrix6& matrix);
/// x of matrix * x = right_side.
Vector6 solutionOf(const Matrix6& matrix, const Vector6& right_side);

struct Eigen6 {
  Vector6 values;   ///< the least first
  Matrix6 vectors;  ///< columns
};
Eigen6 eigenOf(const Matrix6& matrix);

/// The least of x^T a x / x^T b x over all x; b is positive definite.
double leastRatio(const Matrix6& a, const Matrix6& b);

}  // namespace edgevox
