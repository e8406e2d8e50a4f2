// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/LU>

namespace edgevox {

/// Smallest and largest root of the characteristic polynomial of a positive definite matrix, by
/// Newton steps from outside: monotone, and the same on every machine.
struct ExtremeEigenvalues {
  double least;
  double greatest;

  explicit ExtremeEigenvalues(const Eigen::Matrix3d& m) {
    const double c2 = m.trace();
    const double c1 = m(0, 0) * m(1, 1) + m(1, 1) * m(2, 2) + m(2, 2) * m(0, 0) -
                      m(0, 1) * m(0, 1) - m(1, 2) * m(1, 2) - m(2, 0) * m(2, 0);
    const double c0 = m.determinant();
    least = rootFrom(0.0, c2, c1, c0);
    greatest = rootFrom(c2, c2, c1, c0);
  }

 private:
  static double rootFrom(double l, double c2, double c1, double c0) {
    for (int i = 0; i < 40; ++i) {
      const double value = ((l - c2) * l + c1) * l - c0;
      const double slope = (3 * l - 2 * c2) * l + c1;
      if (!(slope > 0)) break;
      const double step = value / slope;
      l -= step;
      if (!(std::abs(step) > 1e-9 * l)) break;
    }
    return l;
  }
};

}  // namespace edgevox
