// SPDX-License-Identifier: BSD-3-Clause
// Maps a folder of clouds, without ROS or PCL, and writes the sensor's trajectory.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "edgevox/config.hpp"
#include "edgevox/io/trajectory_io.hpp"
#include "edgevox/mapping/pipeline.hpp"

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

constexpr size_t kPointBytes = 4 * sizeof(float);

double numberFrom(const std::string& text, const std::string& name) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value > 0.0)) {
    throw std::runtime_error(name + " is '" + text + "'; it must be a number above 0");
  }
  return value;
}

std::vector<fs::path> cloudFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".bin") files.push_back(entry.path());
  }
  if (files.empty()) throw std::runtime_error("'" + folder.string() + "' holds no .bin files");
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<uint8_t> contentOf(const fs::path& file) {
  std::vector<uint8_t> bytes(fs::file_size(file));
  if (bytes.size() % kPointBytes != 0) {
    throw std::runtime_error("'" + file.string() + "' has " + std::to_string(bytes.size()) +
                             " bytes, no multiple of the 16 of a point: it is cut short or no "
                             "array of x, y, z, intensity in float32");
  }
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw std::runtime_error("'" + file.string() + "' cannot be read");
  return bytes;
}

/// All points are taken as seen at the stamp: what a sensor that stands, or a KITTI cloud, which is
/// free of the motion within its sweep, needs. Sensors with a time in each point set view.time.
edgevox::CloudView viewOf(const std::vector<uint8_t>& bytes, double stamp) {
  edgevox::CloudView view;
  view.stamp = stamp;
  view.frame = "lidar";
  view.data = bytes.data();
  view.width = bytes.size() / kPointBytes;
  view.height = 1;
  view.point_step = kPointBytes;
  view.row_step = bytes.size();
  return view;
}

void run(const fs::path& folder, const fs::path& output, double voxel_size, double rate) {
  edgevox::Config config;
  config.voxel_size = voxel_size;
  edgevox::Pipeline pipeline(config);
  edgevox::Trajectory trajectory;
  std::map<std::string, int> counts;  // by what became of a cloud
  const std::vector<fs::path> files = cloudFiles(folder);
  for (size_t i = 0; i < files.size(); ++i) {
    const std::vector<uint8_t> bytes = contentOf(files[i]);
    const double stamp = static_cast<double>(i) / rate;
    const edgevox::ScanResult scan = pipeline.process(viewOf(bytes, stamp)).scan;
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
  std::cout << "\nmap: " << pipeline.map().hitVoxels().voxelCount() << " occupied voxels, "
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
