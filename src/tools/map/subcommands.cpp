// SPDX-License-Identifier: BSD-3-Clause
#include "tools/map/subcommands.hpp"

#include <iostream>
#include <string>

namespace edgevox {
namespace {

struct Subcommand {
  const char* name;
  void (*run)(const Arguments&);
  const char* summary;
};

constexpr Subcommand kSubcommands[] = {
    {"info", mapInfo, "what a map holds"},
    {"convert", mapConvert, "to a compact map, PLY, PCD, OctoMap or a map of map_server"},
    {"diff", mapDiff, "what one map has and another has not"},
    {"merge", mapMerge, "two maps of one frame in one"},
    {"draw", mapDraw, "a picture from above"},
};

void printHelp() {
  std::cout << "Usage: map SUBCOMMAND [options], or map SUBCOMMAND --help\nSubcommands:\n";
  for (const Subcommand& subcommand : kSubcommands) {
    std::cout << "  " << subcommand.name << "\t" << subcommand.summary << "\n";
  }
}

const Subcommand& subcommandOf(const std::string& name) {
  std::string names;
  for (const Subcommand& subcommand : kSubcommands) {
    if (name == subcommand.name) return subcommand;
    names += (names.empty() ? "" : ", ") + std::string(subcommand.name);
  }
  throw UsageError("'" + name + "' is not known: " + names);
}

}  // namespace

int runMapTool(const Arguments& arguments) {
  if (arguments.empty()) throw UsageError("name a subcommand");
  if (arguments[0] == "--help" || arguments[0] == "-h") {
    printHelp();
  } else {
    subcommandOf(arguments[0]).run({arguments.begin() + 1, arguments.end()});
  }
  return 0;
}

}  // namespace edgevox
