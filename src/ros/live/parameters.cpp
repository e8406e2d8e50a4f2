// SPDX-License-Identifier: BSD-3-Clause
#include "ros/live/parameters.hpp"

#include <ros/console.h>
#include <ros/param.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <algorithm>
#include <array>
#include <limits>

#include "edgevox/io/number_text.hpp"

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

template <typename Parameters>
Parameters readAll(const ros::NodeHandle& private_handle) {
  Parameters result;
  std::vector<Parameter> parameters = parametersOf(result.config);
  for (const Parameter& p : nodeParametersOf(result)) parameters.push_back(p);
  const std::string& space = private_handle.getNamespace();
  XmlRpcValue tree;
  if (ros::param::get(space, tree) && tree.getType() == XmlRpcValue::TypeStruct) {
    Assigner(space + "/", parameters).assignAll(tree, "");
  }
  validate(result.config);
  return result;
}

}  // namespace

std::vector<Parameter> nodeParametersOf(NodeParameters& p) {
  return {{"queue_size", &p.queue_size, 1, 1000, "",
           "scans that wait for the nodelet; of more, the oldest is dropped and counted"}};
}

std::vector<Parameter> nodeParametersOf(MapperParameters& p) {
  std::vector<Parameter> all = nodeParametersOf(static_cast<NodeParameters&>(p));
  const std::vector<Parameter> own = {
      {"map_frame", &p.map_frame, 0, 0, "", "name of the map's frame"},
      {"odom_frame", &p.frames.odom, 0, 0, "",
       "smooth odometry frame on TF: scans are predicted from it and map -> odom is published; "
       "empty: constant velocity"},
      {"base_frame", &p.frames.base, 0, 0, "",
       "the robot's frame, whose pose `odom` and the trajectory hold; empty: the clouds' own"},
      {"publish_tf", &p.publish_tf, 0, 0, "", "whether the pose goes to TF"},
      {"output", &p.output, 0, 0, "", "folder that `save_map` writes to, absolute"},
      {"transform_wait", &p.transform_wait, 0, 10, "s",
       "how long after its arrival a scan may wait for its transforms"},
      {"path_length", &p.path_length, 1, 1000000, "", "poses in `path`; the oldest go first"},
      {"map_period", &p.map_period, 0.1, 3600, "s",
       "least time between two clouds or updates of the map"},
  };
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

NodeParameters readNodeParameters(const ros::NodeHandle& private_handle) {
  return readAll<NodeParameters>(private_handle);
}

MapperParameters readMapperParameters(const ros::NodeHandle& private_handle) {
  auto parameters = readAll<MapperParameters>(private_handle);
  if (parameters.map_frame.empty() || parameters.map_frame == parameters.frames.odom ||
      parameters.map_frame == parameters.frames.base) {
    throw ConfigError("parameter '" + private_handle.getNamespace() + "/map_frame' is '" +
                      parameters.map_frame +
                      "'; it must be a name, and not that of odom_frame or base_frame");
  }
  if (!parameters.output.empty() && parameters.output.front() != '/') {
    throw ConfigError("parameter '" + private_handle.getNamespace() + "/output' is '" +
                      parameters.output + "'; it must be absolute, beginning with /");
  }
  return parameters;
}

}  // namespace edgevox
