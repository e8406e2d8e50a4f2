// SPDX-License-Identifier: BSD-3-Clause
// Folders of 3DTK's format uos: scanNNN.3d with scanNNN.pose.
#pragma once

#include <filesystem>
#include <vector>

#include "evaluation/posed_files.hpp"

namespace edgevox {

/// Stamps are the numbers of the scans. Throws FileError and std::invalid_argument.
std::vector<PosedFile> uosScans(const ScanFolder& folder);

/// Text of "x y z" [cm] a line, other columns are left out: x to the right, y up, z forward. Here x
/// is forward, y to the left, z up [m]. Lines with '#' and a header are left out. Throws FileError.
RecordedScan readUos(const std::filesystem::path& file);

}  // namespace edgevox
