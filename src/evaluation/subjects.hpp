// SPDX-License-Identifier: BSD-3-Clause
// The subjects of evaluate. Each has its own options and its own file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "evaluation/recording.hpp"
#include "evaluation/table.hpp"
#include "tools/options.hpp"

namespace edgevox {

/// The arguments are those that follow the subject's name. Each throws std::invalid_argument if
/// they are wrong.
void evaluateRun(const Arguments& arguments);
void evaluateEdges(const Arguments& arguments);
void evaluateMap(const Arguments& arguments);
void evaluateTrust(const Arguments& arguments);
void evaluateLocalize(const Arguments& arguments);
void evaluatePaper(const Arguments& arguments);

/// Options of all subjects that work on a recording, and what they say.
void addRecordingOptions(boost::program_options::options_description& known);
RecordingOptions recordingOptionsOf(const boost::program_options::variables_map& given);

/// The options for a configuration, the configuration given, valid, and its name to print;
/// `config`: what is not given. Throws ConfigError, FileError.
void addConfigOptions(boost::program_options::options_description& known);
Config configOf(const boost::program_options::variables_map& given, std::string& name,
                Config config = {});

/// Writes the table to FOLDER/NAME.csv and what is said about it to FOLDER/NAME.md, prints the
/// latter and has the Python script draw FOLDER/NAME.png. Throws FileError.
void writeResults(const std::filesystem::path& folder, const std::string& name,
                  const std::string& script, const Table& table, const std::string& markdown);

}  // namespace edgevox
