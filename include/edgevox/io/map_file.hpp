// SPDX-License-Identifier: BSD-3-Clause
// Map files, `.edgevox`: little-endian, compressed with zstd, checked by SHA-256.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "edgevox/config.hpp"
#include "edgevox/map/match_map.hpp"
#include "edgevox/mapping/mapper.hpp"

namespace edgevox {

/// What a map file holds.
enum class MapContent : uint8_t {
  kCompact = 1,  ///< a MatchMap, quantised: to localize in
  kFull = 2,     ///< a Mapper: mapping goes on as if it had never stopped
};
const char* toString(MapContent content);

/// What is told of a map beside its voxels.
struct MapFileHead {
  MapContent content = MapContent::kCompact;
  std::string map_frame;         ///< frame of the coordinates
  uint64_t scans = 0;            ///< that the map was built from
  uint64_t occupied_voxels = 0;  ///< of the finest size, with min_hits
  uint64_t edge_voxels = 0;
  std::string parameters;  ///< "name=value" a line, of the configuration it was built with
};

/// A file that is damaged, of a newer version or no map at all; the text says which and what to do.
struct MapFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The content of a file of either kind. Labels must be up to date in a compact one.
std::string mapFileBytes(MapContent content, const Mapper& mapper, const Config& config,
                         const std::string& map_frame);
/// The content of a compact file of a complete map that was built from so many scans.
std::string mapFileBytes(const MatchMap& map, const Config& config, const std::string& map_frame,
                         uint64_t scans);

/// A map file in memory, its checksum verified.
class MapFile {
 public:
  /// Throws FileError and MapFileError.
  static MapFile read(const std::filesystem::path& file);
  /// From the content of a file; `name` is for the text of errors.
  MapFile(std::string bytes, std::string name);

  const MapFileHead& head() const { return head_; }
  /// The configuration that the map was built with.
  const Config& config() const { return config_; }
  uint32_t version() const { return version_; }
  /// What scans are matched to, complete and with its labels up to date, of either content. Throws
  /// MapFileError.
  MatchMap matchMap() const;
  /// Puts the mapper in the state that was saved; its Config must have the map's parameters, see
  /// requireSameMap(). Throws MapFileError if the content is not full.
  void restore(Mapper& mapper) const;
  /// Throws ConfigError that names the first parameter of map, edges or voxel size which differs.
  void requireSameMap(const Config& config) const;
  /// Throws ConfigError that names the first such parameter, or the frame, in which two maps
  /// differ.
  void requireSameMap(const MapFile& other) const;

 private:
  template <typename Read>
  auto reading(const Read& read) const;

  std::string name_;
  uint32_t version_ = 0;
  MapFileHead head_;
  Config config_;
  std::string body_;  // one zstd frame if full
};

}  // namespace edgevox
