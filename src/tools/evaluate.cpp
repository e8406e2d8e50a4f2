// SPDX-License-Identifier: BSD-3-Clause
// Measures runs, edges and maps against what is known of them.
#include <iostream>
#include <string>

#include "evaluation/subjects.hpp"
#include "tools/options.hpp"

namespace {

struct Subject {
  const char* name;
  void (*evaluate)(const edgevox::Arguments&);
  const char* summary;
};

constexpr Subject kSubjects[] = {
    {"run", edgevox::evaluateRun, "the trajectory of a run against a reference"},
    {"edges", edgevox::evaluateEdges, "the extraction of edges from scans and into the map"},
    {"map", edgevox::evaluateMap, "error and capture against the size of the map"},
};

void printHelp() {
  std::cout << "Usage: evaluate SUBJECT [options], or evaluate SUBJECT --help\nSubjects:\n";
  for (const Subject& subject : kSubjects) {
    std::cout << "  " << subject.name << "\t" << subject.summary << "\n";
  }
}

const Subject& subjectOf(const std::string& name) {
  std::string names;
  for (const Subject& subject : kSubjects) {
    if (name == subject.name) return subject;
    names += (names.empty() ? "" : ", ") + std::string(subject.name);
  }
  throw edgevox::UsageError("'" + name + "' is not known: " + names);
}

int run(const edgevox::Arguments& arguments) {
  if (arguments.empty()) throw edgevox::UsageError("name a subject");
  if (arguments[0] == "--help" || arguments[0] == "-h") {
    printHelp();
  } else {
    subjectOf(arguments[0]).evaluate({arguments.begin() + 1, arguments.end()});
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return edgevox::runTool("evaluate", argc, argv, run); }
