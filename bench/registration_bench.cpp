// SPDX-License-Identifier: BSD-3-Clause
// A scan to the one before with PCL, from the same prediction that the pipeline starts from.
#include <pcl/registration/gicp.h>
#include <pcl/registration/ndt.h>

#include "benchmarks.hpp"
#include "pcl_clouds.hpp"
#include "sequence.hpp"

namespace edgevox::bench {
namespace {

using benchmark::State;
using Gicp = pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ>;
using Ndt = pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ>;

/// Registration at PCL's defaults. With `leaf` > 0 both clouds go through VoxelGrid before,
/// which is not timed.
template <typename Registration>
void align(State& state, const std::string& name, double leaf) {
  const Sequence& s = sequence(name);
  const auto cloudOf = [&](size_t i) {
    const PclCloud::Ptr cloud = pclCloud(s.clouds[i].view, s.config.voxelizer);
    return leaf > 0 ? filtered(cloud, static_cast<float>(leaf)) : cloud;
  };
  const size_t i = s.sample();
  const PclCloud::Ptr source = cloudOf(i);
  const PclCloud::Ptr target = cloudOf(i - 1);
  const Pose T_map_target = s.poses[i - 1];
  const Pose guess = T_map_target.inverse() * s.predicted(i);
  Eigen::Matrix4f found = Eigen::Matrix4f::Identity();
  for (auto _ : state) {
    Registration registration;
    registration.setInputTarget(target);
    registration.setInputSource(source);
    PclCloud aligned;
    registration.align(aligned, guess.matrix().cast<float>());
    found = registration.getFinalTransformation();
  }
  const Pose pipelines = T_map_target.inverse() * s.poses[i];
  const Eigen::Vector3d apart =
      found.topRightCorner<3, 1>().cast<double>() - pipelines.translation();
  state.counters["points"] = static_cast<double>(source->size());
  state.counters["mm_from_pipeline"] = 1e3 * apart.norm();
}

template <typename Registration>
void alignFiltered(State& state, const std::string& name) {
  align<Registration>(state, name, sequence(name).config.voxel_size);
}

template <typename Registration>
void alignRaw(State& state, const std::string& name) {
  align<Registration>(state, name, 0.0);
}

}  // namespace

void addRegistrationBenchmarks(const std::string& sequence_name) {
  add("pcl_ndt", sequence_name, alignFiltered<Ndt>);
  add("pcl_gicp", sequence_name, alignFiltered<Gicp>);
  add("pcl_gicp_raw", sequence_name, alignRaw<Gicp>);
}

}  // namespace edgevox::bench
