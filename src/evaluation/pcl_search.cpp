// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/pcl_search.hpp"

#include <algorithm>
#include <cstdlib>

#include <pcl/features/fpfh.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/registration/ia_ransac.h>
#include <pcl/registration/icp.h>
#include <pcl/search/kdtree.h>

#include "evaluation/pcl_points.hpp"

namespace edgevox {
namespace {

using Point = pcl::PointXYZ;
using Feature = pcl::FPFHSignature33;
using Cloud = PclCloud;
using Features = pcl::PointCloud<Feature>;

constexpr float kLeastSampleDistance = 1.0F;  // of SAC-IA [m]
constexpr double kCorrespondence = 1.0;       // largest distance [m]
constexpr int kIcpIterations = 50;

}  // namespace

struct PclSearch::Described {
  Cloud::Ptr points{new Cloud};
  Features::Ptr features{new Features};

  explicit Described(const Cloud::Ptr& all, const Eigen::Vector3f& viewpoint) {
    pcl::VoxelGrid<Point> filter;
    filter.setInputCloud(all);
    const auto leaf = static_cast<float>(kPclLeaf);
    filter.setLeafSize(leaf, leaf, leaf);
    filter.filter(*points);
    const pcl::search::KdTree<Point>::Ptr tree(new pcl::search::KdTree<Point>);
    const pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
    pcl::NormalEstimation<Point, pcl::Normal> normal;
    normal.setInputCloud(points);
    normal.setSearchMethod(tree);
    normal.setRadiusSearch(kNormalRadius);
    normal.setViewPoint(viewpoint.x(), viewpoint.y(), viewpoint.z());
    normal.compute(*normals);
    pcl::FPFHEstimation<Point, pcl::Normal, Feature> fpfh;
    fpfh.setInputCloud(points);
    fpfh.setInputNormals(normals);
    fpfh.setSearchMethod(tree);
    fpfh.setRadiusSearch(kFpfhRadius);
    fpfh.compute(*features);
  }
};

PclSearch::PclSearch(const MatchMap& map) {
  const Cloud::Ptr all(new Cloud);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  map.hitVoxels().forEach([&](const VoxelIndex& v) {
    const Eigen::Vector3f centre = voxelCentre(v, map.voxelSize(0)).cast<float>();
    sum += centre;
    add(centre, *all);
  });
  map_ =
      std::make_unique<Described>(all, sum / static_cast<float>(std::max<size_t>(1, all->size())));
}

PclSearch::~PclSearch() = default;

Pose PclSearch::find(const VoxelScan& scan) const {
  const Described source(cloudOf(scan), Eigen::Vector3f::Zero());
  std::srand(1);  // by which SAC-IA draws its samples
  pcl::SampleConsensusInitialAlignment<Point, Point, Feature> sac;
  sac.setInputSource(source.points);
  sac.setSourceFeatures(source.features);
  sac.setInputTarget(map_->points);
  sac.setTargetFeatures(map_->features);
  sac.setMinSampleDistance(kLeastSampleDistance);
  sac.setMaxCorrespondenceDistance(kCorrespondence);
  sac.setMaximumIterations(kSacIterations);
  Cloud aligned;
  sac.align(aligned);
  pcl::IterativeClosestPoint<Point, Point> icp;
  icp.setInputSource(source.points);
  icp.setInputTarget(map_->points);
  icp.setMaxCorrespondenceDistance(kCorrespondence);
  icp.setMaximumIterations(kIcpIterations);
  icp.align(aligned, sac.getFinalTransformation());
  return poseOf(icp.getFinalTransformation());
}

}  // namespace edgevox
