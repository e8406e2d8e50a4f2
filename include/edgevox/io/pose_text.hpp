// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "edgevox/grid/voxel.hpp"

namespace edgevox {

/// The level pose of "x,y,z,yaw" [m, degrees]; none if the text is something else.
std::optional<Pose> poseOfText(const std::string& text);

}  // namespace edgevox
