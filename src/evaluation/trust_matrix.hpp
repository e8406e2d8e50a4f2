// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "evaluation/scan_stream.hpp"
#include "evaluation/trust_tally.hpp"

namespace edgevox {

struct TrustRecording {
  std::string name;    ///< to print
  std::string world;   ///< empty: a bag
  std::string sensor;  ///< of a simulated one
  size_t seed = 0;     ///< of a simulated one
  ScanStream scans;
};

struct TrustOptions {
  std::vector<size_t> strides = {1, 3, 5, 8};
  size_t most = std::numeric_limits<size_t>::max();  ///< scans of a recording, before strides
  int threads = 1;                                   ///< recordings at a time
  Config config;
  std::string config_name = "the defaults";  ///< to print
};

/// Every stride-th scan of a recording, mapped from an empty map.
struct TrustCell {
  size_t recording = 0;  ///< position
  size_t stride = 1;
  TrustCounts counts;
};

/// All strides of each recording in their order; does not depend on the number of threads. Each
/// scan is made and voxelized once. `note` is told of recordings that are done, by one thread at a
/// time. Throws what the streams throw.
std::vector<TrustCell> runMatrix(const std::vector<TrustRecording>& recordings,
                                 const TrustOptions& options,
                                 const std::function<void(const std::string&)>& note);

}  // namespace edgevox
