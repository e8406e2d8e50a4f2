// SPDX-License-Identifier: BSD-3-Clause
// Tells, converts, compares, joins and draws map files. Needs no ROS master.
#include "tools/map/subcommands.hpp"
#include "tools/options.hpp"

int main(int argc, char** argv) { return edgevox::runTool("map", argc, argv, edgevox::runMapTool); }
