// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/solid.hpp"

namespace edgevox::sim {

struct Hit {
  double range = 0.0;                                 ///< m along the ray
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< outward, unit length, world frame
  int solid = -1;                                     ///< index into World::solids()
};

/// An immutable union of solids in the world frame (z up, m) under a bounding volume hierarchy.
/// All queries are const and safe from several threads.
class World {
 public:
  explicit World(std::vector<Solid> solids);

  const std::vector<Solid>& solids() const { return solids_; }

  /// Bounds of all solids, m.
  Aabb bounds() const;

  /// The nearest surface along the unit `direction` up to `max_range` m. A solid that holds the
  /// origin is not hit.
  std::optional<Hit> castRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_range) const;

  /// Indices of the solids whose bounds meet `box`, ascending; replaces the content of `found`.
  void findSolids(const Aabb& box, std::vector<int>& found) const;

  /// True inside or on any solid.
  bool contains(const Eigen::Vector3d& point) const;

  /// Distance in m from `point` to the nearest solid, at most `limit`; negative inside a solid.
  double clearance(const Eigen::Vector3d& point, double limit) const;

 private:
  // A leaf holds order_[first, first + count); an inner node's children are the next node and
  // nodes_[first], with count 0.
  struct Node {
    Aabb box;
    std::int32_t first = 0;
    std::int32_t count = 0;
  };

  void build(std::int32_t begin, std::int32_t end, int depth);

  std::vector<Solid> solids_;
  std::vector<Aabb> boxes_;  // of solids_
  std::vector<std::int32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace edgevox::sim
