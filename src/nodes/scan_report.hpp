// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <edgevox/ScanReport.h>
#include <edgevox/VoxelScanStamped.h>

#include <string>

#include "edgevox/mapping/mapper.hpp"
#include "edgevox/mapping/pipeline.hpp"
#include "edgevox/stage_times.hpp"
#include "ros/conversions/scan_transforms.hpp"

namespace edgevox {

StageTimes timesOf(const ScanReport& report);

/// What the offline pipeline would have given for the scan, as far as it is known.
PipelineResult toPipelineResult(const VoxelScanStamped& scan, const ScanResult& result);

ScanReport reportOn(const VoxelScanStamped& scan, const ScanResult& result,
                    const std::string& way_out);
ScanReport reportOn(const VoxelScanStamped& scan, const ScanRefusal& refusal);

}  // namespace edgevox
