// SPDX-License-Identifier: BSD-3-Clause
// Maps half of a folder's clouds, saves the map, loads it and locates the other half in it.
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/io/atomic_file.hpp"
#include "edgevox/io/map_file.hpp"
#include "edgevox/io/trajectory_io.hpp"
#include "edgevox/mapping/pipeline.hpp"
#include "kitti_clouds.hpp"

namespace {

namespace fs = std::filesystem;

constexpr const char* kUsage =
    "Usage: localize_folder FOLDER MAP TRAJECTORY\n"
    "Of the clouds FOLDER/*.bin, in the order of their names and at 10 Hz, builds a map from "
    "those\n"
    "with an even number, saves it to MAP (.edgevox), loads it again, locates those with an odd\n"
    "number in it, and writes their poses to TRAJECTORY (TUM format).\n";

constexpr double kRate = 10.0;  // [Hz]

void saveMap(const std::vector<fs::path>& clouds, const fs::path& file) {
  const edgevox::Config config;
  edgevox::Pipeline pipeline(config);
  for (size_t i = 0; i < clouds.size(); i += 2) {
    const std::vector<uint8_t> bytes = kitti::contentOf(clouds[i]);
    pipeline.process(kitti::viewOf(bytes, static_cast<double>(i) / kRate));
  }
  pipeline.mapper().finishLabels();  // a compact map holds its edges
  edgevox::writeFile(file,
                     mapFileBytes(edgevox::MapContent::kCompact, pipeline.mapper(), config, "map"));
}

edgevox::Trajectory localize(const std::vector<fs::path>& clouds, const fs::path& file) {
  const edgevox::MapFile map = edgevox::MapFile::read(file);
  std::cout << "map of " << map.head().scans << " scans: " << map.head().occupied_voxels
            << " occupied voxels, " << map.head().edge_voxels << " of them edges, "
            << fs::file_size(file) << " bytes\n";
  edgevox::Pipeline pipeline(map.config());
  pipeline.localizeIn(map.matchMap());  // the first cloud is looked for everywhere
  edgevox::Trajectory trajectory;
  for (size_t i = 1; i < clouds.size(); i += 2) {
    const std::vector<uint8_t> bytes = kitti::contentOf(clouds[i]);
    const edgevox::ScanResult scan =
        pipeline.process(kitti::viewOf(bytes, static_cast<double>(i) / kRate)).scan;
    if (scan.located()) trajectory.push_back({scan.stamp, scan.T_map_sensor});
  }
  return trajectory;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() != 3) {
    std::cerr << kUsage;
    return 2;
  }
  try {
    const std::vector<fs::path> clouds = kitti::cloudFiles(words[0]);
    saveMap(clouds, words[1]);
    const edgevox::Trajectory trajectory = localize(clouds, words[1]);
    writeTum(words[2], trajectory);
    std::cout << trajectory.size() << " of " << clouds.size() / 2 << " clouds located\n";
  } catch (const std::exception& error) {
    std::cerr << "localize_folder: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
