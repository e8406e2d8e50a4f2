// SPDX-License-Identifier: BSD-3-Clause
#include "ros/live/parameters.hpp"

#include <ros/console.h>
#include <ros/param.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <algorithm>
#include <array>
#include <limits>

#include "edgevox/io/number_text.hpp"
#include "edgevox/io/pose_text.hpp"

namespace edgevox {
namespace {

using XmlRpc::XmlRpcValue;

// Read by libraries from the same namespace.
constexpr std::array<const char*, 2> kOthers = {"diagnostic_period", "num_worker_threads"};

std::string textOf(XmlRpcValue& value, const std::string& full_name) {
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value) ? "true" : "false";
    case XmlRpcValue::TypeInt:
      return std::to_string(static_cast<int>(value));
    case XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    case XmlRpcValue::TypeDouble:
      return shortText(static_cast<double>(value), std::numeric_limits<double>::max_digits10);
    default:
      throw ConfigError("parameter '" + full_name + "' is a list or a date; give one value");
  }
}

/// Gives the values below a namespace to the parameters with their names.
class Assigner {
 public:
  Assigner(std::string space, const std::vector<Parameter>& parameters)
      : space_(std::move(space)), parameters_(parameters) {}

  void assignAll(XmlRpcValue& tree, const std::string& prefix) const {
    for (auto& [key, value] : tree) {
      const std::string name = prefix + key;
      if (value.getType() == XmlRpcValue::TypeStruct) {
        assignAll(value, name + "/");
      } else {
        assignOne(name, value);
      }
    }
  }

 private:
  void assignOne(const std::string& name, XmlRpcValue& value) const {
    const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                    [&](const Parameter& p) { return p.name == name; });
    if (found == parameters_.end()) return warn(name);
    const std::string text = textOf(value, space_ + name);
    try {
      assign(*found, text);
    } catch (const ConfigError& error) {
      throw ConfigError(std::string(error.what()) + " (" + space_ + name + ")");
    }
  }

  void warn(const std::string& name) const {
    if (std::find(kOthers.begin(), kOthers.end(), name) != kOthers.end()) return;
    ROS_WARN_STREAM("parameter '" << space_ << name << "' is not known and not used; did you mean '"
                                  << nearestName(parameters_, name) << "'?");
  }

  std::string space_;  // with a slash at its end
  const std::vector<Parameter>& parameters_;
};

/// The frame of the map where the nodelet has one.
void takeFrame(NodeParameters&, const std::string&) {}
void takeFrame(TrackingParameters& parameters, const std::string& map_frame) {
  parameters.map_frame = map_frame;
}

void requireAbsolute(const std::string& full_name, const std::string& path) {
  if (path.empty() || path.front() == '/') return;
  throw ConfigError("parameter '" + full_name + "' is '" + path +
                    "'; it must be absolute, beginning with /");
}

/// Gives errors the name of the parameter that they are of.
template <typename Task>
void about(const std::string& full_name, const Task& task) {
  try {
    task();
  } catch (const std::exception& error) {
    throw ConfigError("parameter '" + full_name + "': " + error.what());
  }
}

template <typename Parameters>
void readMap(const std::string& file, Parameters& parameters) {
  parameters.map = std::make_shared<const MapFile>(MapFile::read(file));
  parameters.config = parameters.map->config();
  takeFrame(parameters, parameters.map->head().map_frame);
}

template <typename Parameters>
Parameters readAll(const ros::NodeHandle& private_handle) {
  Parameters result;
  const std::string space = private_handle.getNamespace() + "/";
  const std::string map_name = space + "map_file";
  std::string map_file;
  if (XmlRpcValue value; ros::param::get(map_name, value)) map_file = textOf(value, map_name);
  requireAbsolute(map_name, map_file);
  if (!map_file.empty()) about(map_name, [&] { readMap(map_file, result); });
  std::vector<Parameter> parameters = parametersOf(result.config);
  for (const Parameter& p : nodeParametersOf(result)) parameters.push_back(p);
  XmlRpcValue tree;
  if (ros::param::get(private_handle.getNamespace(), tree) &&
      tree.getType() == XmlRpcValue::TypeStruct) {
    Assigner(space, parameters).assignAll(tree, "");
  }
  validate(result.config);
  if (result.map) about(map_name, [&] { result.map->requireSameMap(result.config); });
  return result;
}

void checkFrames(const std::string& space, const TrackingParameters& parameters) {
  if (!parameters.map_frame.empty() && parameters.map_frame != parameters.frames.odom &&
      parameters.map_frame != parameters.frames.base) {
    return;
  }
  throw ConfigError("parameter '" + space + "/map_frame' is '" + parameters.map_frame +
                    "'; it must be a name, and not that of odom_frame or base_frame");
}

std::vector<Parameter> joined(std::vector<Parameter> all, const std::vector<Parameter>& own) {
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

}  // namespace

std::vector<Parameter> nodeParametersOf(NodeParameters& p) {
  return {{"queue_size", &p.queue_size, 1, 1000, "",
           "scans that wait for the nodelet; of more, the oldest is dropped and counted"},
          {"map_file", &p.map_file, 0, 0, "",
           "a saved map, absolute: to localize in, or to go on with; its configuration and frame "
           "are the defaults of all others"}};
}

std::vector<Parameter> nodeParametersOf(TrackingParameters& p) {
  return joined(
      nodeParametersOf(static_cast<NodeParameters&>(p)),
      {
          {"map_frame", &p.map_frame, 0, 0, "", "name of the map's frame"},
          {"odom_frame", &p.frames.odom, 0, 0, "",
           "smooth odometry frame on TF: scans are predicted from it and map -> odom is "
           "published; empty: constant velocity"},
          {"base_frame", &p.frames.base, 0, 0, "",
           "the robot's frame, whose pose `odom` and the trajectory hold; empty: the clouds' own"},
          {"publish_tf", &p.publish_tf, 0, 0, "", "whether the pose goes to TF"},
          {"transform_wait", &p.transform_wait, 0, 10, "s",
           "how long after its arrival a scan may wait for its transforms"},
          {"path_length", &p.path_length, 1, 1000000, "", "poses in `path`; the oldest go first"},
          {"map_period", &p.map_period, 0.1, 3600, "s",
           "least time between two clouds or updates of the map"},
      });
}

std::vector<Parameter> nodeParametersOf(MapperParameters& p) {
  return joined(nodeParametersOf(static_cast<TrackingParameters&>(p)),
                {{"output", &p.output, 0, 0, "",
                  "of the mapper: folder that `save_map` writes to, absolute"}});
}

std::vector<Parameter> nodeParametersOf(LocalizerParameters& p) {
  return joined(nodeParametersOf(static_cast<TrackingParameters&>(p)),
                {{"initial_pose", &p.initial_pose, 0, 0, "",
                  "of the localizer: where the base is at the start, as x,y,z,yaw in metres and "
                  "degrees; empty: anywhere in the map"}});
}

NodeParameters readNodeParameters(const ros::NodeHandle& private_handle) {
  auto parameters = readAll<NodeParameters>(private_handle);
  parameters.map.reset();  // only its configuration is of use
  return parameters;
}

MapperParameters readMapperParameters(const ros::NodeHandle& private_handle) {
  auto parameters = readAll<MapperParameters>(private_handle);
  const std::string& space = private_handle.getNamespace();
  checkFrames(space, parameters);
  requireAbsolute(space + "/output", parameters.output);
  return parameters;
}

LocalizerParameters readLocalizerParameters(const ros::NodeHandle& private_handle) {
  auto parameters = readAll<LocalizerParameters>(private_handle);
  const std::string& space = private_handle.getNamespace();
  checkFrames(space, parameters);
  const auto pose = poseOfText(parameters.initial_pose);
  const bool usable = pose && inGridRange(*pose, parameters.config.voxel_size);
  if (!parameters.initial_pose.empty() && !usable) {
    throw ConfigError("parameter '" + space + "/initial_pose' is '" + parameters.initial_pose +
                      "'; it must be x,y,z,yaw in metres and degrees, in the map");
  }
  return parameters;
}

}  // namespace edgevox
