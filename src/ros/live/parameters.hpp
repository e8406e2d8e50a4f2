// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <memory>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/io/map_file.hpp"
#include "ros/conversions/sensor_frames.hpp"

namespace edgevox {

/// Parameters of every nodelet.
struct NodeParameters {
  Config config;
  int queue_size = 10;   ///< scans that wait; of more the oldest is dropped
  std::string map_file;  ///< absolute; the configuration is that of this map where nothing is set
  std::shared_ptr<const MapFile> map;  ///< the content of map_file, if there is one
};

/// Of a nodelet that finds where the sensor is.
struct TrackingParameters : NodeParameters {
  std::string map_frame = "map";  ///< that of map_file where nothing is set
  FrameNames frames;
  bool publish_tf = true;
  double transform_wait = 0.3;  ///< for the transforms of a scan, from its arrival [s]
  int path_length = 5000;       ///< poses
  double map_period = 1.0;      ///< least time between two clouds or updates of the map [s]
};

struct MapperParameters : TrackingParameters {
  std::string output;  ///< folder of save_map, absolute
};

struct LocalizerParameters : TrackingParameters {
  std::string initial_pose;  ///< of the base in the map: see poseOfText(); empty: anywhere
};

/// What a nodelet takes beside the configuration, valid as long as the argument.
std::vector<Parameter> nodeParametersOf(NodeParameters& parameters);
std::vector<Parameter> nodeParametersOf(TrackingParameters& parameters);
std::vector<Parameter> nodeParametersOf(MapperParameters& parameters);
std::vector<Parameter> nodeParametersOf(LocalizerParameters& parameters);

/// Reads all parameters of a nodelet from its private namespace: the only place that does. A name
/// that is not known is a warning. Throws ConfigError with the parameter's full name.
NodeParameters readNodeParameters(const ros::NodeHandle& private_handle);
MapperParameters readMapperParameters(const ros::NodeHandle& private_handle);
LocalizerParameters readLocalizerParameters(const ros::NodeHandle& private_handle);

}  // namespace edgevox
