// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include <Eigen/Core>

namespace edgevox {

/// Binary files, complete or not there at all. Throw FileError.
void writePly(const std::filesystem::path& file, const std::vector<Eigen::Vector3f>& points);
void writePcd(const std::filesystem::path& file, const std::vector<Eigen::Vector3f>& points);

}  // namespace edgevox
