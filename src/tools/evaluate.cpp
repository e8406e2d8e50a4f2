// SPDX-License-Identifier: BSD-3-Clause
// Measures runs, edges and maps against what is known of them.
#include <boost/program_options.hpp>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

#include "evaluation/subjects.hpp"

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
  throw std::invalid_argument("'" + name + "' is not known: " + names);
}

void run(const edgevox::Arguments& arguments) {
  if (arguments.empty()) throw std::invalid_argument("name a subject");
  if (arguments[0] == "--help" || arguments[0] == "-h") return printHelp();
  subjectOf(arguments[0]).evaluate({arguments.begin() + 1, arguments.end()});
}

int refuse(const std::exception& error) {
  std::cerr << "evaluate: " << error.what() << "; see evaluate --help\n";
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run({argv + 1, argv + argc});
    return 0;
  } catch (const boost::program_options::error& error) {
    return refuse(error);
  } catch (const std::invalid_argument& error) {
    return refuse(error);
  } catch (const std::exception& error) {
    std::cerr << "evaluate: " << error.what() << "\n";
    return 1;
  }
}
