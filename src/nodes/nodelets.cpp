// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <exception>
#include <memory>

#include "nodes/edge_extractor_node.hpp"
#include "nodes/localizer_node.hpp"
#include "nodes/mapper_node.hpp"
#include "nodes/voxelizer_node.hpp"

namespace edgevox {

/// Owns a node for as long as the nodelet is loaded. A wrong parameter keeps it from being loaded.
/// Its callbacks may run at the same time, so that a service does not hold up the scans.
template <typename Node>
class NodeletOf : public nodelet::Nodelet {
  void onInit() override {
    try {
      node_ = std::make_unique<Node>(getMTNodeHandle(), getMTPrivateNodeHandle(), getName());
    } catch (const std::exception& error) {
      NODELET_FATAL_STREAM(error.what());
      throw;
    }
  }

  std::unique_ptr<Node> node_;
};

using VoxelizerNodelet = NodeletOf<VoxelizerNode>;
using EdgeExtractorNodelet = NodeletOf<EdgeExtractorNode>;
using MapperNodelet = NodeletOf<MapperNode>;
using LocalizerNodelet = NodeletOf<LocalizerNode>;

}  // namespace edgevox

PLUGINLIB_EXPORT_CLASS(edgevox::VoxelizerNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(edgevox::EdgeExtractorNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(edgevox::MapperNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(edgevox::LocalizerNodelet, nodelet::Nodelet)
