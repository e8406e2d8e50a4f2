// SPDX-License-Identifier: BSD-3-Clause
#include "core/matching/symmetric6.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace edgevox {

Matrix6 inverseOf(const Matrix6& matrix) { return matrix.ldlt().solve(Matrix6::Identity()); }

Vector6 solutionOf(const Matrix6& matrix, const Vector6& right_side) {
  return matrix.ldlt().solve(right_side);
}

Eigen6 eigenOf(const Matrix6& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

double leastRatio(const Matrix6& a, const Matrix6& b) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> solver(a, b, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0];
}

}  // namespace edgevox
