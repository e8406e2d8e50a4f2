// SPDX-License-Identifier: BSD-3-Clause
// Maps a folder of clouds, without ROS or PCL, and writes the sensor's trajectory.
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/io/trajectory_io.hpp"
#include "edgevox/mapping/pipeline.hpp"
#include "kitti_clouds.hpp"

namespace {

namespace fs = std::filesystem;

constexpr const char* kUsage =
    "Usage: map_folder FOLDER TRAJECTORY [VOXEL_SIZE [RATE]]\n"
    "Maps the clouds FOLDER/*.bin, in the order of their names, and writes the poses of the\n"
    "sensor in the frame of the first cloud to TRAJECTORY (TUM format: stamp tx ty tz qx qy qz\n"
    "qw). A cloud is an array of x, y, z [m] and intensity, float32 in the byte order of this\n"
    "machine, as the velodyne folders of KITTI have it.\n"
    "  VOXEL_SIZE  of the map [m] (0.2)\n"
    "  RATE        clouds a second (10): the files hold no stamps\n";

double numberFrom(const std::string& text, const std::string& name) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value > 0.0)) {
    throw std::runtime_error(name + " is '" + text + "'; it must be a number above 0");
  }
  return value;
}

void run(const fs::path& folder, const fs::path& output, double voxel_size, double rate) {
  edgevox::Config config;
  config.voxel_size = voxel_size;
  edgevox::Pipeline pipeline(config);
  edgevox::Trajectory trajectory;
  std::map<std::string, int> counts;  // by what became of a cloud
  const std::vector<fs::path> files = kitti::cloudFiles(folder);
  for (size_t i = 0; i < files.size(); ++i) {
    const std::vector<uint8_t> bytes = kitti::contentOf(files[i]);
    const double stamp = static_cast<double>(i) / rate;
    const edgevox::ScanResult scan = pipeline.process(kitti::viewOf(bytes, stamp)).scan;
    ++counts[toString(scan.status)];
    if (scan.located()) {
      trajectory.push_back({scan.stamp, scan.T_map_sensor});
    } else {
      std::cout << files[i].filename().string() << ": " << toString(scan.status) << "\n";
    }
  }
  pipeline.mapper().finishLabels();
  writeTum(output, trajectory);

  std::cout << files.size() << " clouds:";
  for (const auto& [status, count] : counts) std::cout << " " << count << " " << status;
  std::cout << "\nmap: " << pipeline.map().hitVoxelCount() << " occupied voxels, "
            << pipeline.map().edgeVoxels().voxelCount() << " of them edges\n";
  if (const auto warning = pipeline.densityMonitor().warning()) {
    std::cout << textOf(*warning) << "\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 2 || words.size() > 4) {
    std::cerr << kUsage;
    return 2;
  }
  try {
    run(words[0], words[1], words.size() > 2 ? numberFrom(words[2], "VOXEL_SIZE") : 0.2,
        words.size() > 3 ? numberFrom(words[3], "RATE") : 10.0);
  } catch (const std::exception& error) {
    std::cerr << "map_folder: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
