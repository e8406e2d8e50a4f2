// SPDX-License-Identifier: BSD-3-Clause
#include <pcl/registration/icp.h>

#include "evaluation/octree_leaves.hpp"
#include "evaluation/paper_method.hpp"
#include "evaluation/pcl_points.hpp"

namespace edgevox {
namespace {

/// In the sensor's frame, as PCL computes in floats.
class IcpMethod final : public PaperMethod {
 public:
  explicit IcpMethod(PaperVoxels voxels) : voxels_(voxels) {}

  PaperPose align(const PaperScan& scan, const Pose& guess) override {
    pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
    icp.setMaxCorrespondenceDistance(kIcpCorrespondence);
    icp.setMaximumIterations(kIcpSteps);
    icp.setTransformationEpsilon(1e-8);
    icp.setInputTarget(last_);
    icp.setInputSource(cloudOf(chosenVoxels(scan, voxels_)));
    PclCloud aligned;
    icp.align(aligned, (T_map_last_.inverse() * guess).matrix().cast<float>());
    return {T_map_last_ * poseOf(icp.getFinalTransformation()), icp.hasConverged()};
  }
  void insert(const PaperScan& scan, const Pose& T_map_sensor) override {
    last_ = cloudOf(chosenVoxels(scan, voxels_));
    T_map_last_ = T_map_sensor;
  }
  bool isScanToScan() const override { return true; }

 private:
  PaperVoxels voxels_;
  PclCloud::Ptr last_;
  Pose T_map_last_ = Pose::Identity();
};

/// The centres of the leaves that pcl::octree has for the points, in place of the voxels.
VoxelScan leavesOf(const VoxelScan& scan) {
  std::vector<Eigen::Vector3f> points;
  for (const ScanVoxel& voxel : scan.voxels) points.push_back(voxel.centroid);
  VoxelScan leaves = scan;
  leaves.voxel_size = 2 * scan.voxel_size;
  leaves.voxels.clear();
  for (const Eigen::Vector3f& centre : octreeLeafCentres(points, leaves.voxel_size)) {
    ScanVoxel leaf;
    leaf.index = voxelAt(centre.cast<double>(), 1.0 / leaves.voxel_size);
    leaf.centroid = centre;
    leaf.point_count = 1;
    leaves.voxels.push_back(leaf);
  }
  return leaves;
}

}  // namespace

VoxelScan chosenVoxels(const PaperScan& scan, PaperVoxels voxels) {
  switch (voxels) {
    case PaperVoxels::kAll:
      return scan.voxels;
    case PaperVoxels::kEdges:
      return edgeVoxels(scan.scan);
    case PaperVoxels::kOctreeLeaves:
      return leavesOf(scan.scan);
  }
  return {};
}

std::unique_ptr<PaperMethod> makeIcp(PaperVoxels voxels) {
  return std::make_unique<IcpMethod>(voxels);
}

}  // namespace edgevox
