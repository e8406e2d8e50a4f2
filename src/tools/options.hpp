// SPDX-License-Identifier: BSD-3-Clause
// What the command lines of the tools have in common.
#pragma once

#include <boost/program_options.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace edgevox {

using Arguments = std::vector<std::string>;  ///< without the name of the program

/// A command line that is wrong; the text says how.
struct UsageError : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Runs `tool`, which gives the exit code. What it throws goes to stderr after the tool's name:
/// std::invalid_argument, as UsageError, ConfigError and unknown names are, gives exit code 2 and
/// is followed by where to find help; any other exception gives 1.
int runTool(const std::string& name, int argc, const char* const* argv,
            const std::function<int(const Arguments&)>& tool);

/// Options below their description, `usage`; the first is --help.
boost::program_options::options_description withHelp(const std::string& usage);

/// The arguments by the names of their options, which may not be shortened. The first one without a
/// name is `positional`, where there is such. Nothing if help was asked for, which is printed.
/// Throws UsageError.
std::optional<boost::program_options::variables_map> parseOptions(
    const Arguments& arguments, const boost::program_options::options_description& known,
    const char* positional = nullptr);
/// The same with several arguments that need no name, in this order.
std::optional<boost::program_options::variables_map> parseOptions(
    const Arguments& arguments, const boost::program_options::options_description& known,
    const std::vector<std::string>& positional);

/// Values of options declared as std::string, as a list of them and as double; empty if the option
/// is not given.
std::string textOf(const boost::program_options::variables_map& given, const char* name);
std::vector<std::string> textsOf(const boost::program_options::variables_map& given,
                                 const char* name);
std::optional<double> numberOf(const boost::program_options::variables_map& given,
                               const char* name);
/// Value of an option declared as int64_t with a default. Throws UsageError if it is below `least`.
size_t countOf(const boost::program_options::variables_map& given, const char* name, int64_t least);

}  // namespace edgevox
