// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <thread>
#include <utility>

#include "edgevox/io/atomic_file.hpp"
#include "evaluation/capture_report.hpp"
#include "evaluation/list_option.hpp"
#include "evaluation/simulated_truth.hpp"
#include "evaluation/subjects.hpp"
#include "evaluation/trust_matrix.hpp"
#include "evaluation/trust_report.hpp"
#include "run/run_files.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

constexpr const char* kNoWorlds = "none";

po::options_description describe() {
  po::options_description known = withHelp(
      "Usage: evaluate trust --output FOLDER [options]\n"
      "Maps many recordings, each with every scan, every third, and so on, and counts the scans\n"
      "that are right, wrong without being told, and lost. Writes FOLDER/trust.md, trust.csv and\n"
      "trust.png and prints the first. The whole matrix takes hours; narrow it by the options.\n"
      "Options");
  auto add = known.add_options();
  add("worlds", po::value<std::string>()->default_value("building,street,corridor"),
      "to simulate: building, building+movers, street, corridor, city; or 'none'");
  add("beams", po::value<std::string>()->default_value("16,32,64"), "of the simulated lidars");
  add("seeds", po::value<std::string>()->default_value("1-9"),
      "of the simulated worlds: a list, with ranges");
  add("strides", po::value<std::string>()->default_value("1,3,5,8"),
      "map every n-th scan, for each n of this list");
  add("bag", po::value<std::vector<std::string>>()->multitoken()->composing(),
      "FILE[=TUM] ..., bags with one topic of clouds, and the trajectories of their sensors; "
      "without one, a bag is compared with what the default configuration finds from all clouds; "
      "or FOLDER[=POSES], scans in files");
  add("most", po::value<int64_t>()->default_value(std::numeric_limits<int64_t>::max(), "all"),
      "take so many scans of a recording at most, counted before strides");
  add("jobs,j",
      po::value<int64_t>()->default_value(std::max(1U, std::thread::hardware_concurrency()),
                                          "the processors"),
      "recordings, or probes of --capture, at a time; no count depends on it");
  add("capture",
      "also measure from how wrong a guess the pose of a scan is found, beside PCL's GICP and NDT; "
      "writes FOLDER/capture.md and capture.csv");
  add("capture-inputs", po::value<std::vector<std::string>>()->multitoken(),
      "WORLD:SENSOR[:SEED], FILE[=TUM] or FOLDER[=POSES] ..., for --capture (default: building:32 "
      "and the first --bag)");
  add("trials", po::value<int64_t>()->default_value(500), "at least, of a row of --capture");
  addConfigOptions(known);
  add("output,o", po::value<std::string>()->required(), "folder for the results; made if need be");
  return known;
}

std::vector<size_t> numbersGiven(const po::variables_map& given, const char* name, size_t least) {
  return numbersOf(given[name].as<std::string>(), name, least);
}

void addSimulated(const po::variables_map& given, std::vector<TrustRecording>& recordings) {
  const auto worlds = given["worlds"].as<std::string>();
  if (worlds == kNoWorlds) return;
  const auto sensors = wordsOf(given["beams"].as<std::string>(), "beams");
  const auto seeds = numbersGiven(given, "seeds", 0);
  for (const std::string& world : wordsOf(worlds, "worlds")) {
    for (const std::string& sensor : sensors) {
      for (const size_t seed : seeds) {
        const std::string name = world + ":" + sensor + ":" + std::to_string(seed);
        recordings.push_back({name, world, sensor, seed, simulatedStream(name)});
      }
    }
  }
}

struct Input {
  std::string name;
  ScanStream scans;
};

/// Of a simulated world, FILE[=TUM] or FOLDER[=POSES].
Input inputOf(const std::string& text) {
  const size_t equals = fs::exists(text) ? std::string::npos : text.rfind('=');
  const std::string recording = text.substr(0, equals);
  const std::string poses = equals == std::string::npos ? "" : text.substr(equals + 1);
  const std::string name = isSimulated(recording) ? recording : recordingName(recording);
  if (!Table::isText(name)) throw UsageError("no name for a table: '" + name + "'; rename it");
  return {name, streamOf(recording, poses)};
}

std::vector<TrustRecording> recordingsOf(const po::variables_map& given) {
  std::vector<TrustRecording> recordings;
  addSimulated(given, recordings);
  for (const std::string& text : textsOf(given, "bag")) {
    Input bag = inputOf(text);
    recordings.push_back({bag.name, "", "", 0, std::move(bag.scans)});
  }
  return recordings;
}

std::vector<Input> captureInputsOf(const po::variables_map& given) {
  if (given.count("capture") == 0) return {};
  std::vector<std::string> texts = textsOf(given, "capture-inputs");
  if (texts.empty()) {
    texts = {"building:32"};
    const auto bags = textsOf(given, "bag");
    if (!bags.empty()) texts.push_back(bags.front());
  }
  std::vector<Input> inputs;
  for (const std::string& text : texts) inputs.push_back(inputOf(text));
  return inputs;
}

TrustOptions trustOptionsOf(const po::variables_map& given) {
  TrustOptions options;
  options.config = configOf(given, options.config_name);
  options.strides = numbersGiven(given, "strides", 1);
  options.most = countOf(given, "most", 1);
  options.threads = static_cast<int>(std::min<size_t>(countOf(given, "jobs", 1), 1000));
  return options;
}

CaptureOptions captureOptionsOf(const po::variables_map& given, const TrustOptions& trust) {
  CaptureOptions options;
  options.trials = countOf(given, "trials", 1);
  options.threads = trust.threads;
  options.config = trust.config;
  options.config_name = trust.config_name;
  return options;
}

void note(const std::string& text) { std::cerr << "evaluate: " << text << "\n"; }

void countScans(const std::vector<TrustRecording>& recordings, const TrustOptions& options,
                const fs::path& folder) {
  const auto cells = runMatrix(recordings, options, note);
  writeResults(folder, "trust", "plot_trust", trustTable(recordings, cells),
               trustMarkdown(recordings, cells, options));
}

void measureCapture(const std::vector<Input>& inputs, const CaptureOptions& options, size_t most,
                    const fs::path& folder) {
  CaptureTable table(options);
  for (const Input& input : inputs) {
    note("map of " + input.name);
    table.add(makeScene(input.name, input.scans, most, options.config), note);
  }
  writeFile(folder / "capture.csv", table.table().csv());
  writeFile(folder / "capture.md", table.markdown());
  std::cout << table.markdown();
}

}  // namespace

void evaluateTrust(const Arguments& arguments) {
  const auto given = parseOptions(arguments, describe());
  if (!given) return;
  const TrustOptions options = trustOptionsOf(*given);
  const CaptureOptions capture_options = captureOptionsOf(*given, options);
  const std::vector<TrustRecording> recordings = recordingsOf(*given);
  const std::vector<Input> capture_inputs = captureInputsOf(*given);
  if (recordings.empty() && capture_inputs.empty()) {
    throw UsageError("name --worlds, a --bag or --capture");
  }
  const fs::path folder = (*given)["output"].as<std::string>();
  makeFolder(folder);
  if (!recordings.empty()) countScans(recordings, options, folder);
  if (!capture_inputs.empty()) {
    measureCapture(capture_inputs, capture_options, options.most, folder);
  }
}

}  // namespace edgevox
