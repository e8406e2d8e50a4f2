// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>

#include "tools/map_bag_options.hpp"

namespace edgevox::test {

/// What map_bag writes to options.output.
void mapOffline(const MapBagOptions& options);

YAML::Node summaryOf(const std::filesystem::path& folder);

/// The files that hold no times are equal, byte for byte.
void expectSameFiles(const std::filesystem::path& online, const std::filesystem::path& offline);

/// Nothing was dropped, and every scan fared as with map_bag.
void expectSameRun(const std::filesystem::path& online, const std::filesystem::path& offline);

}  // namespace edgevox::test
