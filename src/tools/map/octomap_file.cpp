// SPDX-License-Identifier: BSD-3-Clause
#include "tools/map/octomap_file.hpp"

#include <octomap/OcTree.h>

#include <sstream>

#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/number_text.hpp"

namespace edgevox {
namespace {

constexpr int32_t kOrigin = 32768;  // the key of index 0

/// Voxels of both lie alike: from index times size on.
octomap::OcTreeKey keyOf(const VoxelIndex& v) {
  const auto key = [](int32_t i) {
    if (i < -kOrigin || i >= kOrigin) {
      throw FileError(
          "the map reaches beyond 32768 voxels from its origin, which OctoMap cannot "
          "hold: build it with larger voxels");
    }
    return static_cast<octomap::key_type>(i + kOrigin);
  };
  return {key(v.x), key(v.y), key(v.z)};
}

}  // namespace

std::string octomapBytes(const BitGrid<16>& occupied, double voxel_size) {
  octomap::OcTree tree(voxel_size);
  const float value = tree.getClampingThresMaxLog();
  constexpr bool kLazy = true;  // inner nodes follow below
  occupied.forEach([&](const VoxelIndex& v) { tree.setNodeValue(keyOf(v), value, kLazy); });
  tree.updateInnerOccupancy();
  tree.prune();
  // As tree.writeBinary() does, which prints to stderr.
  std::ostringstream bytes;
  bytes << "# Octomap OcTree binary file\nid " << tree.getTreeType() << "\nsize " << tree.size()
        << "\nres " << shortText(voxel_size, 9) << "\ndata\n";
  tree.writeBinaryData(bytes);
  return bytes.str();
}

}  // namespace edgevox
