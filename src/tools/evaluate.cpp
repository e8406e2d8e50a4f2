// SPDX-License-Identifier: BSD-3-Clause
// Measures runs, edges and maps against what is known of them.
#include "evaluation/subjects.hpp"
#include "tools/dispatch.hpp"
#include "tools/options.hpp"

namespace {

int run(const edgevox::Arguments& arguments) {
  return edgevox::dispatch(
      "evaluate", "subject",
      {{"run", edgevox::evaluateRun, "the trajectory of a run against a reference"},
       {"edges", edgevox::evaluateEdges, "the extraction of edges from scans and into the map"},
       {"map", edgevox::evaluateMap, "error and capture against the size of the map"},
       {"trust", edgevox::evaluateTrust,
        "how many scans are right, wrong and lost, in many recordings"},
       {"localize", edgevox::evaluateLocalize, "how many scans are found in a map without a guess"},
       {"paper", edgevox::evaluatePaper, "the comparison of Ryde, Delmerico and Corso 2013"}},
      arguments);
}

}  // namespace

int main(int argc, char** argv) { return edgevox::runTool("evaluate", argc, argv, run); }
