// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <tuple>
#include <vector>

#include "core/matching/shift_pyramid.hpp"
#include "edgevox/grid/voxel.hpp"
#include "edgevox/matching/global_search.hpp"

namespace edgevox {

/// The translations [shift, shift + 2^height) in cells, at one of several rotations.
struct SearchNode {
  int bound = 0;  // hits of each of them, at most
  int height = 0;
  size_t rotation = 0;
  VoxelIndex shift;

  /// More hits first; then in a fixed order.
  friend bool operator<(const SearchNode& a, const SearchNode& b) {
    return std::tie(b.bound, a.rotation, a.shift) < std::tie(a.bound, b.rotation, b.shift);
  }
};

/// Branch and bound for the translations, of all rotations, at which most points of a scan hit.
/// What is found does not depend on the number of threads: translations are left out for having
/// less than a share of the hits of a known one, and in the end of the best one.
class BranchAndBound {
 public:
  /// `points`: of the scan in cells, at each rotation. `least`: hits of what is looked for.
  BranchAndBound(const ShiftPyramid& pyramid, const std::vector<std::vector<VoxelIndex>>& points,
                 double share, int least, const SearchControl& control);

  /// The translations in a box with at least `share` of the most hits and `least`, by hits;
  /// none if the search is cancelled.
  std::vector<SearchNode> find(const VoxelBox& shifts);

 private:
  int threshold() const;
  std::vector<SearchNode> roots() const;
  void descend(const SearchNode& node, std::vector<SearchNode>& leaves);

  const ShiftPyramid& pyramid_;
  const std::vector<std::vector<VoxelIndex>>& points_;
  double share_;
  int least_;
  SearchControl control_;
  VoxelBox shifts_;
  std::atomic<int> most_{0};  // hits found so far
};

}  // namespace edgevox
