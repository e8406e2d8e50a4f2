// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "edgevox/config.hpp"

namespace edgevox {

/// The file of a preset's name ("indoor") or the name of a file itself. Presets lie in the
/// package's config folder. Throws ConfigError that names the presets there are.
std::filesystem::path findConfigFile(const std::string& name_or_file);

/// Sets what the YAML text gives; groups are nested as in Parameter::name. Throws ConfigError with
/// `file`, the line and the parameter.
void applyYaml(const std::string& text, const std::string& file, Config& config);
void applyConfigFile(const std::filesystem::path& file, Config& config);

/// Sets one parameter from "name=value". Throws ConfigError.
void applySetting(const std::string& setting, Config& config);

}  // namespace edgevox
