// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions/box_updates.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace edgevox {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr const char* kNamespace = "blocks";
constexpr int32_t kColourShift = 8;  // part of the heights by which a colour may be out of date

Marker deletionOfAll(const std_msgs::Header& header) {
  Marker marker;
  marker.header = header;
  marker.action = Marker::DELETEALL;
  return marker;
}

}  // namespace

MarkerArray BoxUpdates::next(const BitGrid<16>& voxels, double voxel_size,
                             const std_msgs::Header& header) {
  std::vector<size_t> changed;
  voxels.forEachChangedBlock(last_, [&](size_t slot) {
    changed.push_back(slot);
    if (slot < last_.blockCount()) count(last_, slot, false);
    count(voxels, slot, true);
  });
  const Heights now = heightsOf(layers_);
  MarkerArray array;
  if (first_) array.markers.push_back(deletionOfAll(header));
  if (first_ || !doColoursFit(now)) {
    changed.clear();
    for (size_t slot = 0; slot < voxels.blockCount(); ++slot) {
      const bool was_empty =
          slot >= last_.blockCount() || BlockLayout<16>::isEmpty(last_.block(slot));
      if (!was_empty || !BlockLayout<16>::isEmpty(voxels.block(slot))) changed.push_back(slot);
    }
    coloured_ = now;
  }
  for (const size_t slot : changed) {
    array.markers.push_back(markerOf(voxels, slot, voxel_size, coloured_, header));
  }
  first_ = false;
  last_ = voxels;
  return array;
}

void BoxUpdates::restart() { *this = BoxUpdates(); }

void BoxUpdates::count(const BitGrid<16>& voxels, size_t slot, bool added) {
  BitGrid<16>::forEachInBlock(voxels.blockIndex(slot), voxels.block(slot),
                              [&](const VoxelIndex& v) {
                                size_t& layer = layers_[v.z];
                                added ? ++layer : --layer;
                              });
}

bool BoxUpdates::doColoursFit(const Heights& heights) const {
  const int32_t most = (coloured_.high - coloured_.low) / kColourShift;
  return std::abs(heights.low - coloured_.low) <= most &&
         std::abs(heights.high - coloured_.high) <= most;
}

/// The slot of a block never changes, and so is its id.
Marker BoxUpdates::markerOf(const BitGrid<16>& voxels, size_t slot, double voxel_size,
                            const Heights& heights, const std_msgs::Header& header) {
  std::vector<VoxelIndex> inside;
  BitGrid<16>::forEachInBlock(voxels.blockIndex(slot), voxels.block(slot),
                              [&](const VoxelIndex& v) { inside.push_back(v); });
  Marker marker = toBoxes(inside, voxel_size, heights, header);
  marker.ns = kNamespace;
  marker.id = static_cast<int32_t>(slot);
  return marker;
}

}  // namespace edgevox
