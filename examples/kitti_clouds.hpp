// SPDX-License-Identifier: BSD-3-Clause
// Clouds as the velodyne folders of KITTI have them: files *.bin, arrays of x, y, z [m] and
// intensity, float32 in the byte order of this machine.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "edgevox/scan/voxelizer.hpp"

namespace kitti {

namespace fs = std::filesystem;

constexpr size_t kPointBytes = 4 * sizeof(float);

/// In the order of their names.
inline std::vector<fs::path> cloudFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".bin") files.push_back(entry.path());
  }
  if (files.empty()) throw std::runtime_error("'" + folder.string() + "' holds no .bin files");
  std::sort(files.begin(), files.end());
  return files;
}

inline std::vector<uint8_t> contentOf(const fs::path& file) {
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
inline edgevox::CloudView viewOf(const std::vector<uint8_t>& bytes, double stamp) {
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

}  // namespace kitti
