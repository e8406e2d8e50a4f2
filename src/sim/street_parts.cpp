// SPDX-License-Identifier: BSD-3-Clause
#include "sim/street_parts.hpp"

#include <algorithm>
#include <cmath>

#include "sim/materials.hpp"

namespace edgevox::sim {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

Place along(const Stretch& stretch, double x, double y, double turn = 0.0, double z = 0.0) {
  const Vector3d at = stretch.start.transform() * Vector3d(x, y, z);
  return {at.x(), at.y(), at.z(), stretch.start.heading + turn};
}

// A house whose front runs from `place` along x, facing -y; its front stands back by `back`.
void addHouse(Solids& solids, const Place& place, double width, double depth, Random& random) {
  const int storeys = 2 + static_cast<int>(random.uniform(0.0, 3.0));
  const double height = 3.1 * storeys + 0.6;
  const double back = random.uniform(0.0, 0.5);
  addBox(solids, place, {0.0, back, -0.1}, {width, depth, height}, kBrick);
  addBox(solids, place, {-0.1, back - 0.3, height}, {width + 0.1, depth, height + 0.25}, kPaint);
  addBox(solids, place, {0.0, back - 0.08, 0.0}, {width, back, 0.7}, kConcrete);
  const int axes = std::max(2, static_cast<int>(width / 3.0));
  const int door = static_cast<int>(random.uniform(0.0, axes));
  const bool balconies = random.uniform() < 0.4;
  for (int axis = 0; axis < axes; ++axis) {
    const double x = width * (axis + 0.5) / axes;
    for (int storey = 0; storey < storeys; ++storey) {
      const double z = 0.9 + 3.1 * storey;
      if (storey == 0 && axis == door) {
        addBox(solids, place, {x - 0.8, back - 0.25, 0.0}, {x - 0.6, back, 2.5}, kPaint);
        addBox(solids, place, {x + 0.6, back - 0.25, 0.0}, {x + 0.8, back, 2.5}, kPaint);
        addBox(solids, place, {x - 0.9, back - 0.8, 2.5}, {x + 0.9, back, 2.65}, kPaint);
        continue;
      }
      addBox(solids, place, {x - 0.7, back - 0.15, z}, {x + 0.7, back, z + 0.12}, kPaint);
      addBox(solids, place, {x - 0.7, back - 0.12, z + 1.6}, {x + 0.7, back, z + 1.75}, kPaint);
      if (balconies && storey > 0 && axis % 2 == 0) {
        addBox(solids, place, {x - 1.1, back - 1.1, z - 0.75}, {x + 1.1, back, z - 0.6}, kConcrete);
        addBox(solids, place, {x - 1.1, back - 1.1, z - 0.6}, {x + 1.1, back - 1.02, z + 0.35},
               kMetal);
      }
    }
  }
}

}  // namespace

void addRow(Solids& solids, const Stretch& stretch, bool left, double begin, double end,
            Random& random) {
  double x = begin;
  while (x < end - 5.0) {
    double width = random.uniform(9.0, 16.0);
    if (end - x - width < 9.0) width = end - x;
    const Place place = left ? along(stretch, x, kFacade, 0.0, kKerb)
                             : along(stretch, x + width, -kFacade, kPi, kKerb);
    addHouse(solids, place, width, random.uniform(9.0, 12.0), random);
    x += width;
    if (random.uniform() < 0.3) x += random.uniform(2.0, 5.0);
  }
}

void parkCars(Solids& solids, const Stretch& stretch, double y, Random& random) {
  double x = 16.0 + random.uniform(0.0, 4.0);
  while (x < stretch.length - 16.0) {
    const double length = random.uniform(3.9, 4.7);
    const double turn = (y > 0.0 ? kPi : 0.0) + random.uniform(-0.03, 0.03);
    if (random.uniform() < 0.7) {
      addCar(solids, along(stretch, x, y + random.uniform(-0.05, 0.1), turn), length);
    }
    x += length + random.uniform(0.8, 3.5);
  }
}

void addPoles(Solids& solids, const Stretch& stretch, Random& random) {
  const double kerb = kRoadHalf + 0.6;
  for (double x = 12.0; x < stretch.length - 8.0; x += 24.0) {
    addLamp(solids, along(stretch, x, -kerb, 0.0, kKerb), 6.5);
    addLamp(solids, along(stretch, x + 12.0, kerb, kPi, kKerb), 6.5);
    const double heading = random.uniform(0.0, kPi);
    const double shift = random.uniform(-1.0, 1.0);
    addTree(solids, along(stretch, x + 7.0 + shift, -kerb, heading, kKerb), 3.2);
  }
  for (const double x : {9.0, stretch.length - 9.0}) {
    addSign(solids, along(stretch, x, -kerb, random.uniform(-0.3, 0.3), kKerb));
    addColumn(solids, along(stretch, x, kerb - 0.3, 0.0, kKerb), 0.06, 0.9, kMetal);
  }
}

}  // namespace edgevox::sim
