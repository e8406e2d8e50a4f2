// SPDX-License-Identifier: BSD-3-Clause
// Tools whose first argument says what to do.
#pragma once

#include <string>
#include <vector>

#include "tools/options.hpp"

namespace edgevox {

struct Subcommand {
  const char* name;
  void (*run)(const Arguments&);  ///< with the arguments that follow the name
  const char* summary;
};

/// Runs the one that the first argument names, or prints them all for --help; gives the exit code.
/// `kind`: the word for them, as "subject". Throws UsageError if there is no such one, and what it
/// throws.
int dispatch(const std::string& tool, const std::string& kind,
             const std::vector<Subcommand>& subcommands, const Arguments& arguments);

}  // namespace edgevox
