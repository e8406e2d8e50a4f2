// SPDX-License-Identifier: BSD-3-Clause
#include "tools/dispatch.hpp"

#include <algorithm>
#include <cctype>
#include <iostream>

namespace edgevox {
namespace {

char upper(char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); }

void printHelp(const std::string& tool, const std::string& kind,
               const std::vector<Subcommand>& subcommands) {
  std::string placeholder = kind;
  std::transform(kind.begin(), kind.end(), placeholder.begin(), upper);
  std::string title = kind + "s";
  title.front() = upper(title.front());
  std::cout << "Usage: " << tool << " " << placeholder << " [options], or " << tool << " "
            << placeholder << " --help\n"
            << title << ":\n";
  for (const Subcommand& subcommand : subcommands) {
    std::cout << "  " << subcommand.name << "\t" << subcommand.summary << "\n";
  }
}

const Subcommand& named(const std::string& name, const std::vector<Subcommand>& subcommands) {
  std::string names;
  for (const Subcommand& subcommand : subcommands) {
    if (name == subcommand.name) return subcommand;
    names += (names.empty() ? "" : ", ") + std::string(subcommand.name);
  }
  throw UsageError("'" + name + "' is not known: " + names);
}

}  // namespace

int dispatch(const std::string& tool, const std::string& kind,
             const std::vector<Subcommand>& subcommands, const Arguments& arguments) {
  if (arguments.empty()) throw UsageError("name a " + kind);
  if (arguments[0] == "--help" || arguments[0] == "-h") {
    printHelp(tool, kind, subcommands);
  } else {
    named(arguments[0], subcommands).run({arguments.begin() + 1, arguments.end()});
  }
  return 0;
}

}  // namespace edgevox
