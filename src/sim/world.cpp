// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

namespace edgevox::sim {
namespace {

constexpr std::int32_t kLeafSize = 2;
constexpr int kMaxDepth = 96;
constexpr int kHeuristicDepth = 48;  // halved from there on, so that kMaxDepth holds
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Order = std::vector<std::int32_t>;

struct Split {
  int axis = 0;
  std::int32_t middle = 0;
  double cost = kInfinity;
};

void sortByCentre(Order& order, std::int32_t begin, std::int32_t end, int axis,
                  const std::vector<Aabb>& boxes) {
  std::sort(order.begin() + begin, order.begin() + end, [&](std::int32_t a, std::int32_t b) {
    const double ca = boxes[a].min[axis] + boxes[a].max[axis];
    const double cb = boxes[b].min[axis] + boxes[b].max[axis];
    return ca != cb ? ca < cb : a < b;
  });
}

// Surface area heuristic over all split positions of one axis; leaves `order` sorted by it.
Split bestSplitOnAxis(Order& order, std::int32_t begin, std::int32_t end, int axis,
                      const std::vector<Aabb>& boxes) {
  sortByCentre(order, begin, end, axis, boxes);
  std::vector<double> right_area(end - begin + 1, 0.0);
  Aabb right;
  for (std::int32_t i = end - 1; i > begin; --i) {
    right.extend(boxes[order[i]]);
    right_area[i - begin] = right.surfaceArea();
  }
  Split best;
  best.axis = axis;
  Aabb left;
  for (std::int32_t i = begin + 1; i < end; ++i) {
    left.extend(boxes[order[i - 1]]);
    const double cost = left.surfaceArea() * (i - begin) + right_area[i - begin] * (end - i);
    if (cost < best.cost) {
      best.cost = cost;
      best.middle = i;
    }
  }
  return best;
}

// Range at which the ray enters the box, infinity if it misses it before `max_range`.
double enterBox(const Aabb& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& inverse,
                double max_range) {
  double enter = 0.0;
  double leave = max_range;
  for (int i = 0; i < 3; ++i) {
    const double a = (box.min[i] - origin[i]) * inverse[i];
    const double b = (box.max[i] - origin[i]) * inverse[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : kInfinity;
}

double squaredDistance(const Aabb& box, const Eigen::Vector3d& point) {
  return (box.min - point).cwiseMax(point - box.max).cwiseMax(0.0).squaredNorm();
}

}  // namespace

World::World(std::vector<Solid> solids) : solids_(std::move(solids)), order_(solids_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  boxes_.reserve(solids_.size());
  for (const Solid& solid : solids_) boxes_.push_back(solid.aabb());
  if (!solids_.empty()) build(0, static_cast<std::int32_t>(solids_.size()), 0);
}

Aabb World::bounds() const { return nodes_.empty() ? Aabb{} : nodes_.front().box; }

void World::build(std::int32_t begin, std::int32_t end, int depth) {
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  for (std::int32_t i = begin; i < end; ++i) nodes_[self].box.extend(boxes_[order_[i]]);
  if (end - begin <= kLeafSize) {
    nodes_[self].first = begin;
    nodes_[self].count = end - begin;
    return;
  }
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    const Split split = bestSplitOnAxis(order_, begin, end, axis, boxes_);
    if (split.cost < best.cost) best = split;
  }
  if (depth > kHeuristicDepth) best.middle = begin + (end - begin) / 2;
  sortByCentre(order_, begin, end, best.axis, boxes_);
  build(begin, best.middle, depth + 1);
  nodes_[self].first = static_cast<std::int32_t>(nodes_.size());
  build(best.middle, end, depth + 1);
}

std::optional<Hit> World::castRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                  double max_range) const {
  if (nodes_.empty()) return std::nullopt;
  const Eigen::Vector3d inverse = direction.unaryExpr(&safeInverse);
  Hit hit;
  hit.range = max_range;
  std::array<std::pair<std::int32_t, double>, kMaxDepth> stack;
  int size = 0;
  stack[size++] = {0, enterBox(nodes_[0].box, origin, inverse, max_range)};
  while (size > 0) {
    const auto [index, enter] = stack[--size];
    if (enter > hit.range) continue;
    const Node& node = nodes_[index];
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
      const auto surface = solids_[order_[i]].castRay(origin, direction);
      if (surface && surface->range <= hit.range) {
        hit = {surface->range, surface->normal, order_[i]};
      }
    }
    if (node.count > 0) continue;
    std::pair<std::int32_t, double> near{index + 1, 0.0};
    std::pair<std::int32_t, double> far{node.first, 0.0};
    near.second = enterBox(nodes_[near.first].box, origin, inverse, hit.range);
    far.second = enterBox(nodes_[far.first].box, origin, inverse, hit.range);
    if (far.second < near.second) std::swap(near, far);
    if (far.second < kInfinity) stack[size++] = far;
    if (near.second < kInfinity) stack[size++] = near;
  }
  return hit.solid >= 0 ? std::optional<Hit>(hit) : std::nullopt;
}

void World::findSolids(const Aabb& box, std::vector<int>& found) const {
  found.clear();
  if (nodes_.empty()) return;
  std::array<std::int32_t, kMaxDepth> stack;
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::int32_t index = stack[--size];
    const Node& node = nodes_[index];
    if (!node.box.overlaps(box)) continue;
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
      if (boxes_[order_[i]].overlaps(box)) found.push_back(order_[i]);
    }
    if (node.count > 0) continue;
    stack[size++] = index + 1;
    stack[size++] = node.first;
  }
  std::sort(found.begin(), found.end());
}

bool World::contains(const Eigen::Vector3d& point) const {
  std::vector<int> near;
  findSolids({point, point}, near);
  return std::any_of(near.begin(), near.end(),
                     [&](int index) { return solids_[index].contains(point); });
}

double World::clearance(const Eigen::Vector3d& point, double limit) const {
  double nearest = limit;
  std::vector<std::int32_t> stack;
  if (!nodes_.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const std::int32_t index = stack.back();
    stack.pop_back();
    const Node& node = nodes_[index];
    const double reach = std::max(nearest, 0.0);
    if (squaredDistance(node.box, point) > reach * reach) continue;
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
      nearest = std::min(nearest, solids_[order_[i]].signedDistance(point));
    }
    if (node.count > 0) continue;
    stack.push_back(index + 1);
    stack.push_back(node.first);
  }
  return nearest;
}

}  // namespace edgevox::sim
