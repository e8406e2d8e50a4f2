// SPDX-License-Identifier: BSD-3-Clause
#include "tools/map/map_points.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "edgevox/io/atomic_file.hpp"

namespace edgevox {
namespace {

namespace po = boost::program_options;

/// x, y, z and the direction of each edge, little-endian floats.
std::string packed(const std::vector<EdgeVoxel>& edges) {
  static_assert(sizeof(Eigen::Vector3f) == 12, "vectors are packed");
  std::string bytes;
  for (const EdgeVoxel& edge : edges) {
    bytes.append(reinterpret_cast<const char*>(edge.centroid.data()), sizeof edge.centroid);
    bytes.append(reinterpret_cast<const char*>(edge.direction.data()), sizeof edge.direction);
  }
  return bytes;
}

}  // namespace

void addBandOptions(po::options_description& known) {
  auto add = known.add_options();
  add("from", po::value<double>(), "lowest height in the map frame [m]");
  add("to", po::value<double>(), "height in the map frame below which all lies [m]");
}

HeightBand bandOf(const po::variables_map& given) {
  HeightBand band;
  band.from = numberOf(given, "from").value_or(band.from);
  band.to = numberOf(given, "to").value_or(band.to);
  if (!(band.from < band.to)) throw UsageError("--from must be below --to");
  return band;
}

std::vector<EdgeVoxel> edgesIn(const MatchMap& map, const HeightBand& band) {
  std::vector<EdgeVoxel> edges;
  for (const EdgeVoxel& edge : map.edges()) {
    if (band.holds(static_cast<double>(edge.centroid.z()))) edges.push_back(edge);
  }
  return edges;
}

std::vector<VoxelIndex> allVoxels(const BitGrid<16>& grid) {
  std::vector<VoxelIndex> voxels;
  grid.forEach([&](const VoxelIndex& v) { voxels.push_back(v); });
  return voxels;
}

std::vector<Eigen::Vector3f> centresOf(std::vector<VoxelIndex> voxels, double voxel_size,
                                       const HeightBand& band) {
  std::sort(voxels.begin(), voxels.end());
  std::vector<Eigen::Vector3f> centres;
  for (const VoxelIndex& v : voxels) {
    const Eigen::Vector3d centre = voxelCentre(v, voxel_size);
    if (band.holds(centre.z())) centres.push_back(centre.cast<float>());
  }
  return centres;
}

void writeEdgesPly(const std::filesystem::path& file, const std::vector<EdgeVoxel>& edges) {
  std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(edges.size()) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
    header += std::string("property float ") + name + "\n";
  }
  writeFile(file, header + "end_header\n" + packed(edges));
}

void writeEdgesPcd(const std::filesystem::path& file, const std::vector<EdgeVoxel>& edges) {
  const std::string count = std::to_string(edges.size());
  writeFile(file,
            "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
            "FIELDS x y z normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\n"
            "COUNT 1 1 1 1 1 1\nWIDTH " +
                count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n" +
                packed(edges));
}

}  // namespace edgevox
