// SPDX-License-Identifier: BSD-3-Clause
#include "core/matching/branch_and_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/parallel.hpp"

namespace edgevox {
BranchAndBound::BranchAndBound(const ShiftPyramid& pyramid,
                               const std::vector<std::vector<VoxelIndex>>& points, double share,
                               int least, const SearchControl& control)
    : pyramid_(pyramid), points_(points), share_(share), least_(least), control_(control) {}

int BranchAndBound::threshold() const {
  return std::max(least_, static_cast<int>(std::ceil(share_ * most_.load())));
}

std::vector<SearchNode> BranchAndBound::roots() const {
  std::vector<std::vector<SearchNode>> of_rotation(points_.size());
  parallelFor(points_.size(), control_.threads, [&](size_t rotation) {
    const int height = pyramid_.height();
    const int size = 1 << height;
    SearchNode node{0, height, rotation, {}};
    VoxelIndex& v = node.shift;
    for (v.z = shifts_.first.z; v.z <= shifts_.last.z; v.z += size) {
      for (v.y = shifts_.first.y; v.y <= shifts_.last.y; v.y += size) {
        for (v.x = shifts_.first.x; v.x <= shifts_.last.x; v.x += size) {
          node.bound = pyramid_.hits(height, points_[rotation], v, least_);
          if (node.bound >= least_) of_rotation[rotation].push_back(node);
        }
      }
    }
  });
  std::vector<SearchNode> roots;
  for (const auto& of : of_rotation) roots.insert(roots.end(), of.begin(), of.end());
  std::sort(roots.begin(), roots.end());
  return roots;
}

/// Depth first, the children with most hits first.
void BranchAndBound::descend(const SearchNode& node, std::vector<SearchNode>& leaves) {
  if (node.bound < threshold() || control_.isCancelled()) return;
  if (node.height == 0) {
    if (!shifts_.holds(node.shift)) return;
    leaves.push_back(node);
    int most = most_.load();
    while (most < node.bound && !most_.compare_exchange_weak(most, node.bound)) {
    }
    return;
  }
  std::array<SearchNode, kChildren> children;
  for (int i = 0; i < kChildren; ++i) {
    SearchNode& child = children[static_cast<size_t>(i)];
    child = node;
    const int half = 1 << --child.height;
    const VoxelIndex corner = childOf({}, i);
    child.shift.x += corner.x * half;
    child.shift.y += corner.y * half;
    child.shift.z += corner.z * half;
    child.bound = pyramid_.hits(child.height, points_[node.rotation], child.shift, threshold());
  }
  std::sort(children.begin(), children.end());
  for (const SearchNode& child : children) descend(child, leaves);
}

std::vector<SearchNode> BranchAndBound::find(const VoxelBox& shifts) {
  shifts_ = shifts;
  const std::vector<SearchNode> roots = this->roots();
  if (roots.empty()) return {};
  std::vector<std::vector<SearchNode>> found(roots.size());
  std::atomic<size_t> next{0};
  const auto look = [&](size_t i) {
    descend(roots[i], found[i]);
    if (control_.percent != nullptr) {
      *control_.percent = static_cast<int>(100 * (i + 1) / roots.size());
    }
  };
  look(next++);  // alone: what it finds spares most of the others
  const size_t workers = std::min(roots.size(), static_cast<size_t>(std::max(1, control_.threads)));
  parallelFor(workers, control_.threads, [&](size_t) {
    for (size_t i = next++; i < roots.size(); i = next++) look(i);
  });
  std::vector<SearchNode> leaves;
  if (control_.isCancelled()) return leaves;
  for (const auto& of : found) {
    std::copy_if(of.begin(), of.end(), std::back_inserter(leaves),
                 [&](const SearchNode& leaf) { return leaf.bound >= threshold(); });
  }
  std::sort(leaves.begin(), leaves.end());
  return leaves;
}

}  // namespace edgevox
