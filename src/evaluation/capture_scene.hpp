// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/map/map_builder.hpp"
#include "evaluation/capture.hpp"
#include "evaluation/scan_stream.hpp"

namespace edgevox {

/// A map of every second scan of a recording at the true poses, and probes from those between.
struct CaptureScene {
  std::string name;  ///< to print
  MapBuilder map;    ///< labelled, all surfaces ready; nothing is frozen
  std::vector<CaptureProbe> probes;
};

/// Of the first `most` scans; those without a true pose are left out. The probes are at least 32
/// and less than 64, spread evenly over the recording, or all scans that the map does not have.
/// Throws std::invalid_argument if there are none, and what the stream throws.
CaptureScene makeScene(const std::string& name, const ScanStream& scans, size_t most,
                       const Config& config);

}  // namespace edgevox
