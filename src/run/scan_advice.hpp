// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "edgevox/tracking/scan_result.hpp"

namespace edgevox {

/// Why a scan has no pose and what to do about it; empty if it has one. `way_out`: what helps a
/// sensor that is lost for good.
std::string adviceOn(const ScanResult& result, const std::string& way_out);

}  // namespace edgevox
