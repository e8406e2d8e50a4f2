// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/bag_clouds.hpp"

#include <variant>

#include "edgevox/mapping/pipeline.hpp"
#include "ros/conversions/point_cloud.hpp"

namespace edgevox {

void forEachReadable(BagReader& bag, const VisitCloud& visit, size_t most) {
  bag.forEachCloud([&](size_t index, const BagReader::ReadCloud& read) {
    if (index >= most) return;
    const BagCloud cloud = read();
    if (!cloud.message) return;
    const CloudReading reading = readCloud(*cloud.message, VoxelizerConfig());
    const auto* checked = std::get_if<CheckedCloud>(&reading);
    if (checked != nullptr) visit(index, *cloud.message, checked->view);
  });
  if (!bag.losses().empty()) throw BagError(textsOf(bag.losses()).front());
}

Trajectory trackedPoses(BagReader& bag) {
  Pipeline pipeline((Config()));
  Trajectory trajectory;
  forEachReadable(bag, [&](size_t, const auto&, const CloudView& view) {
    const ScanResult result = pipeline.process(view).scan;
    if (result.located()) trajectory.push_back({view.stamp, result.T_map_sensor});
  });
  return trajectory;
}

}  // namespace edgevox
