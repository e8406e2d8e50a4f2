// SPDX-License-Identifier: BSD-3-Clause
// Maps the clouds of a bag without a ROS master.
#include <unistd.h>

#include <exception>
#include <iostream>

#include "tools/map_bag_run.hpp"

int main(int argc, char** argv) {
  try {
    const auto options = edgevox::parseMapBagOptions(argc, argv);
    if (!options) return 0;
    edgevox::Console console(std::cerr, isatty(STDERR_FILENO) != 0);
    std::cout << edgevox::runMapBag(*options, console).table();
    return 0;
  } catch (const edgevox::UsageError& error) {
    std::cerr << "map_bag: " << error.what() << "\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "map_bag: " << error.what() << "\n";
    return 1;
  }
}
