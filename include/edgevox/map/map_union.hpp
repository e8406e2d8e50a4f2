// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "edgevox/config.hpp"
#include "edgevox/map/match_map.hpp"

namespace edgevox {

/// Two complete maps of one frame, representation and voxel size in one: what is occupied, an edge
/// or selected for matching in either. Where both have a surface, or the centroid of an edge, that
/// of `a` stays. Edges are not labelled anew; their directions are those in the occupancy of both.
/// With the representation `edges`, a voxel beside an edge of the other map alone, whose centroid
/// no map keeps, has its centre. Throws std::invalid_argument if sizes or levels differ.
MatchMap unionOf(const MatchMap& a, const MatchMap& b, Representation representation);

}  // namespace edgevox
