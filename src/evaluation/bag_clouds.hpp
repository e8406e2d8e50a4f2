// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <cstddef>
#include <functional>
#include <limits>

#include "edgevox/io/trajectory_io.hpp"
#include "edgevox/scan/voxelizer.hpp"
#include "tools/bag_reader.hpp"

namespace edgevox {

using VisitCloud =
    std::function<void(size_t index, const sensor_msgs::PointCloud2& message, const CloudView&)>;

/// Calls visit for those of the first `most` clouds of a bag that can be used. Throws BagError for
/// a damaged bag.
void forEachReadable(BagReader& bag, const VisitCloud& visit,
                     size_t most = std::numeric_limits<size_t>::max());

/// What Pipeline finds with the default configuration from all clouds of the bag.
Trajectory trackedPoses(BagReader& bag);

}  // namespace edgevox
