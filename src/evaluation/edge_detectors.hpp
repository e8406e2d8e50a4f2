// SPDX-License-Identifier: BSD-3-Clause
// What else could tell edges from other voxels, to be compared with the structure tensor. Each
// gives every voxel of a scan a response, the larger the more of an edge, by what is within 3
// voxels on each axis; the published tensor sees 4.
#pragma once

#include <cstddef>
#include <vector>

#include "edgevox/scan/voxel_scan.hpp"

namespace edgevox {

/// In the order of the scan's voxels; 0 where there is nothing to tell from.
using Responses = std::vector<double>;

/// The middle eigenvalue of the structure tensor as published, which is what its threshold is of.
Responses structureTensor(const VoxelScan& scan);

/// Of the centroids around, the least eigenvalue of their covariance over the sum of all three
/// (Pauly, Gross, Kobbelt, *Efficient Simplification of Point-Sampled Surfaces*).
Responses surfaceVariation(const VoxelScan& scan);

/// Of the occupancy, by sigmas of 1 and 1.6 voxels: how far from the median of the scan, which is
/// that of a plane.
Responses differenceOfGaussians(const VoxelScan& scan);

/// The length of the vector of three Haar-like features: occupied voxels on one side of the voxel
/// less those on the other, along each axis.
Responses haarLike(const VoxelScan& scan);

/// PCL's Harris 3D, by the normals of the centroids.
Responses harris3d(const VoxelScan& scan);

struct EdgeDetector {
  const char* name;
  Responses (*respond)(const VoxelScan& scan);
};
constexpr EdgeDetector kEdgeDetectors[] = {
    {"structure tensor", structureTensor},
    {"PCA of points", surfaceVariation},
    {"difference of Gaussians", differenceOfGaussians},
    {"Haar-like", haarLike},
    {"Harris 3D", harris3d},
};

/// Labels a scan anew: edges are, of its voxels in the map's size, the `count` of the largest
/// response, of equal ones the first.
void markStrongest(const EdgeDetector& detector, size_t count, VoxelScan& scan);

}  // namespace edgevox
