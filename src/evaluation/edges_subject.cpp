// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "evaluation/subjects.hpp"

namespace edgevox {
namespace {

namespace po = boost::program_options;

po::options_description describe() {
  po::options_description known("Usage: evaluate edges INPUT --output FOLDER [options]\nOptions");
  addRecordingOptions(known);
  return known;
}

}  // namespace

void evaluateEdges(const Arguments& arguments) {
  const auto given = parseArguments(arguments, describe(), "input");
  if (!given) return;
  const Recording recording = makeRecording(recordingOptionsOf(*given));
  std::cout << recording.name << ": " << recording.scans.size() << " scans\n";
}

}  // namespace edgevox
