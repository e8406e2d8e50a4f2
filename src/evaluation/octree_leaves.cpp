// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/octree_leaves.hpp"

#include <pcl/octree/octree_pointcloud_occupancy.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <utility>

namespace edgevox {
namespace {

using Octree = pcl::octree::OctreePointCloudOccupancy<pcl::PointXYZ>;

Octree octreeOf(const std::vector<Eigen::Vector3f>& points, double leaf_size) {
  Octree octree(leaf_size);
  for (const Eigen::Vector3f& p : points) octree.setOccupiedVoxelAtPoint({p.x(), p.y(), p.z()});
  return octree;
}

/// The parents of which all eight children are there, ascending.
std::vector<VoxelIndex> fullParents(const std::vector<VoxelIndex>& children) {
  std::vector<VoxelIndex> parents;
  for (const VoxelIndex& child : children) parents.push_back(coarser(child, 1));
  std::sort(parents.begin(), parents.end());
  std::vector<VoxelIndex> full;
  for (size_t first = 0, end = 0; first < parents.size(); first = end) {
    while (end < parents.size() && parents[end] == parents[first]) ++end;
    if (end - first == 8) full.push_back(parents[first]);
  }
  return full;
}

}  // namespace

std::vector<VoxelIndex> octreeLeaves(const std::vector<Eigen::Vector3f>& points, double leaf_size) {
  Octree octree = octreeOf(points, leaf_size);
  std::vector<VoxelIndex> leaves;
  for (auto leaf = octree.leaf_depth_begin(); leaf != octree.leaf_depth_end(); ++leaf) {
    const auto& key = leaf.getCurrentOctreeKey();
    leaves.push_back(
        {static_cast<int32_t>(key.x), static_cast<int32_t>(key.y), static_cast<int32_t>(key.z)});
  }
  return leaves;
}

std::vector<Eigen::Vector3f> octreeLeafCentres(const std::vector<Eigen::Vector3f>& points,
                                               double leaf_size) {
  const Octree octree = octreeOf(points, leaf_size);
  Octree::AlignedPointTVector centres;
  octree.getOccupiedVoxelCenters(centres);
  std::vector<Eigen::Vector3f> found;
  for (const pcl::PointXYZ& centre : centres) found.emplace_back(centre.x, centre.y, centre.z);
  return found;
}

size_t mergedLeafCount(std::vector<VoxelIndex> leaves) {
  size_t count = leaves.size();
  while (!leaves.empty()) {
    leaves = fullParents(leaves);
    count -= 7 * leaves.size();
  }
  return count;
}

}  // namespace edgevox
