// SPDX-License-Identifier: BSD-3-Clause
// A MatchMap quantised and compressed: the body of a compact map file.
#pragma once

#include <string>

#include "edgevox/config.hpp"
#include "edgevox/map/match_map.hpp"

namespace edgevox {

/// Of a map with its edges and hit voxels.
std::string encoded(const MatchMap& map, Representation representation);
/// Of a map that was built with `config`. Throws ArchiveError if the bytes are not what encoded()
/// gives.
MatchMap decoded(const std::string& bytes, const Config& config);

}  // namespace edgevox
