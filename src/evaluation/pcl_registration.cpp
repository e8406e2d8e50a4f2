// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/pcl_registration.hpp"

#include <memory>

#include <pcl/registration/gicp.h>
#include <pcl/registration/ndt.h>

#include "evaluation/pcl_points.hpp"

namespace edgevox {
namespace {

using Cloud = PclCloud;
using Gicp = pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ>;
using Ndt = pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ>;
using Points = std::vector<Eigen::Vector3f>;

/// Of the points within `range` of a place, in a frame with its origin there: PCL computes in
/// floats.
Cloud::Ptr targetAround(const Eigen::Vector3f& place, double range, const Points& points) {
  Cloud::Ptr cloud(new Cloud);
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3f from_place = point - place;
    if (static_cast<double>(from_place.norm()) <= range) add(from_place, *cloud);
  }
  return cloud;
}

std::shared_ptr<Gicp> makeGicp() {
  auto gicp = std::make_shared<Gicp>();
  gicp->setMaxCorrespondenceDistance(kGicpCorrespondence);
  return gicp;
}

std::shared_ptr<Ndt> makeNdt() {
  auto ndt = std::make_shared<Ndt>();
  ndt->setResolution(static_cast<float>(kNdtResolution));
  ndt->setStepSize(0.1);
  ndt->setTransformationEpsilon(1e-4);
  ndt->setMaximumIterations(50);
  return ndt;
}

template <typename Method>
CapturedPose align(Method& method, const Pose& guess) {
  Cloud aligned;
  method.align(aligned, guess.matrix().template cast<float>());
  CapturedPose found;
  found.T_map_sensor = poseOf(method.getFinalTransformation());
  found.accepted = method.hasConverged();
  return found;
}

/// `make` gives a method with its settings.
template <typename Make>
RegistrationFor registrationFor(const CaptureScene& scene, const Config& config, const Make& make) {
  const auto points = std::make_shared<const Points>(centroidsOf(scene.map, scene.map.hitVoxels()));
  const double range = config.voxelizer.max_range;
  return [=](const CaptureProbe& probe) -> Registration {
    Pose T_map_place = Pose::Identity();
    T_map_place.translation() = probe.T_map_sensor.translation();
    const Pose T_place_map = T_map_place.inverse();
    const auto method = make();
    method->setInputTarget(
        targetAround(T_map_place.translation().template cast<float>(), range, *points));
    method->setInputSource(cloudOf(probe.scan));
    align(*method, T_place_map * probe.T_map_sensor);  // GICP computes its covariances
    return [=](const Pose& guess, uint64_t) {
      CapturedPose found = align(*method, T_place_map * guess);
      found.T_map_sensor = T_map_place * found.T_map_sensor;
      return found;
    };
  };
}

}  // namespace

RegistrationFor pclGicp(const CaptureScene& scene, const Config& config) {
  return registrationFor(scene, config, makeGicp);
}

RegistrationFor pclNdt(const CaptureScene& scene, const Config& config) {
  return registrationFor(scene, config, makeNdt);
}

}  // namespace edgevox
