// SPDX-License-Identifier: BSD-3-Clause
#include <pcl/registration/icp.h>

#include "evaluation/paper_method.hpp"
#include "evaluation/pcl_points.hpp"

namespace edgevox {
namespace {

/// In the sensor's frame, as PCL computes in floats.
class IcpMethod final : public PaperMethod {
 public:
  PaperPose align(const PaperScan& scan, const Pose& guess) override {
    pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
    icp.setMaxCorrespondenceDistance(kIcpCorrespondence);
    icp.setMaximumIterations(kIcpSteps);
    icp.setTransformationEpsilon(1e-8);
    icp.setInputTarget(last_);
    icp.setInputSource(cloudOf(scan.voxels));
    PclCloud aligned;
    icp.align(aligned, (T_map_last_.inverse() * guess).matrix().cast<float>());
    return {T_map_last_ * poseOf(icp.getFinalTransformation()), icp.hasConverged(), {}};
  }
  void insert(const PaperScan& scan, const Pose& T_map_sensor) override {
    last_ = cloudOf(scan.voxels);
    T_map_last_ = T_map_sensor;
  }
  bool isScanToScan() const override { return true; }

 private:
  PclCloud::Ptr last_;
  Pose T_map_last_ = Pose::Identity();
};

}  // namespace

std::unique_ptr<PaperMethod> makeIcp() { return std::make_unique<IcpMethod>(); }

}  // namespace edgevox
