// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace edgevox::test {

/// Keeps markers as rviz does.
class MarkerDisplay {
 public:
  using Point = std::tuple<double, double, double>;

  void show(const visualization_msgs::MarkerArray& array) {
    for (const auto& marker : array.markers) {
      const auto key = std::make_pair(marker.ns, marker.id);
      if (marker.action == visualization_msgs::Marker::DELETEALL) {
        markers_.clear();
      } else if (marker.action == visualization_msgs::Marker::DELETE) {
        markers_.erase(key);
      } else {
        markers_[key] = marker;
      }
    }
  }

  /// Of all boxes, with the sum of their red and green: what brightens with the height.
  std::map<Point, float> points() const {
    std::map<Point, float> points;
    for (const auto& [key, marker] : markers_) {
      for (size_t i = 0; i < marker.points.size(); ++i) {
        const auto& p = marker.points[i];
        points[{p.x, p.y, p.z}] = marker.colors.at(i).r + marker.colors.at(i).g;
      }
    }
    return points;
  }
  size_t markerCount() const { return markers_.size(); }

 private:
  std::map<std::pair<std::string, int32_t>, visualization_msgs::Marker> markers_;
};

}  // namespace edgevox::test
