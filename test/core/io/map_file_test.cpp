// SPDX-License-Identifier: BSD-3-Clause
// Map files: mapping that goes on, localization, and files that are not what they should be.
#include "edgevox/io/map_file.hpp"

#include <openssl/sha.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/archive.hpp"
#include "edgevox/io/atomic_file.hpp"
#include "edgevox/mapping/localizer.hpp"
#include "edgevox/statistics.hpp"
#include "support/sweeps.hpp"
#include "support/temp_folder.hpp"

namespace edgevox::test {
namespace {

constexpr size_t kScans = 41;  // not a multiple of map/label_every
constexpr size_t kStop = 23;
constexpr size_t kStartBytes = 8 + 4 + 8 + 32;  // magic, version, size, digest
constexpr size_t kVersionAt = 8;
constexpr size_t kDigestAt = 8 + 4 + 8;

const std::vector<VoxelScan>& scans() {
  static const std::vector<VoxelScan> made = voxelScans(
      simulateWalk(sim::WorldName::Building, "16", 10, static_cast<int>(kScans)).sweeps, Config{});
  return made;
}

Config withRepresentation(Representation representation) {
  Config config;
  config.map.representation = representation;
  return config;
}

void mapScans(size_t first, size_t last, Mapper& mapper) {
  for (size_t i = first; i < last; ++i) ASSERT_TRUE(mapper.process(scans()[i]).located()) << i;
}

std::string stateOf(const Mapper& mapper) {
  ArchiveWriter bytes;
  bytes(mapper);
  return bytes.take();
}

class Saved : public ::testing::TestWithParam<Representation> {};

/// Writes and reads a map after kStop scans; gives the one that was not stopped.
Mapper stopAndGoOn(const Config& config) {
  Mapper whole(config);
  mapScans(0, kStop, whole);
  const std::string bytes = mapFileBytes(MapContent::kFull, whole, config, "map");
  const size_t frozen = whole.map().frozenRegions();
  mapScans(kStop, kScans, whole);

  const MapFile file(bytes, "test");
  EXPECT_EQ(kStop, file.head().scans);
  Mapper resumed(config);
  file.requireSameMap(config);
  file.restore(resumed);
  EXPECT_EQ(frozen, resumed.map().frozenRegions());
  EXPECT_TRUE(bytes == mapFileBytes(MapContent::kFull, resumed, config, "map"));
  mapScans(kStop, kScans, resumed);
  EXPECT_TRUE(stateOf(whole) == stateOf(resumed));
  return whole;
}

TEST_P(Saved, FullMapsGoOnAsIfTheyHadNeverStopped) { stopAndGoOn(withRepresentation(GetParam())); }

/// Places that no scan has just touched freeze at once, but those next to the sensor.
Config freezingAtOnce(Representation representation) {
  Config config = withRepresentation(representation);
  config.voxelizer.max_range = 1.0;
  config.map.freeze_after = 1;
  config.map.label_every = 2;
  return config;
}

TEST_P(Saved, FrozenPlacesGoOnAsIfTheyHadNeverStopped) {
  Config config = freezingAtOnce(GetParam());
  config.map.clear_after = 3;
  const Mapper mapper = stopAndGoOn(config);
  EXPECT_LT(0U, mapper.map().frozenRegions());
  EXPECT_LT(0U, mapper.map().thawedRegions());
}

TEST_P(Saved, FrozenPlacesAreInMapsOfBothKinds) {
  const Config config = freezingAtOnce(GetParam());
  Mapper mapper(config);
  size_t scan = 0;
  while (scan < kStop || (scan < kScans && mapper.map().frozenVoxels() == 0)) {
    mapper.process(scans()[scan++]);
  }
  mapper.finishLabels();
  ASSERT_LT(0U, mapper.map().frozenVoxels());
  for (const MapContent content : {MapContent::kCompact, MapContent::kFull}) {
    const MapFile file(mapFileBytes(content, mapper, config, "map"), "test");
    const MatchMap map = file.matchMap();
    EXPECT_EQ(mapper.map().hitVoxelCount(), file.head().occupied_voxels);
    EXPECT_EQ(mapper.map().hitVoxelCount(), map.hitVoxels().voxelCount());
    EXPECT_EQ(mapper.map().edgeVoxels().voxelCount(), map.edges().size());
  }
}

/// Poses in a map that stays as it is.
std::vector<double> errorsIn(const MapFile& file, const std::vector<Pose>& poses) {
  Localizer localizer(file.config(), file.matchMap());
  std::vector<double> errors;
  for (size_t i = 0; i < poses.size(); ++i) {
    const ScanResult result = localizer.process(scans()[i]);
    EXPECT_TRUE(result.located()) << i;
    errors.push_back(differenceOf(poses[i], result.T_map_sensor).metres);
  }
  return errors;
}

TEST_P(Saved, ScansAreLocatedInMapsOfBothKinds) {
  const Config config = withRepresentation(GetParam());
  Mapper mapper(config);
  std::vector<Pose> poses;
  for (const VoxelScan& scan : scans()) poses.push_back(mapper.process(scan).T_map_sensor);
  mapper.finishLabels();
  const double allowed = GetParam() == Representation::kEdges ? 0.03 : 0.01;  // [m]
  for (const MapContent content : {MapContent::kCompact, MapContent::kFull}) {
    const std::string bytes = mapFileBytes(content, mapper, config, "map");
    const auto errors = errorsIn(MapFile(bytes, "test"), poses);
    RecordProperty(std::string(toString(content)) + "_bytes", static_cast<int>(bytes.size()));
    RecordProperty(std::string(toString(content)) + "_median_mm",
                   std::to_string(1e3 * quantile(errors, 0.5)));
    EXPECT_LT(quantile(errors, 0.5), allowed) << toString(content);
  }
}

INSTANTIATE_TEST_SUITE_P(Representations, Saved,
                         ::testing::Values(Representation::kSparse, Representation::kAll,
                                           Representation::kRandom, Representation::kEdges));

std::string fileOf(MapContent content) {
  static const Mapper mapper = [] {
    Mapper made{Config{}};
    for (size_t i = 0; i < kStop; ++i) made.process(scans()[i]);
    made.finishLabels();
    return made;
  }();
  return mapFileBytes(content, mapper, Config{}, "world");
}

const std::string& compactFile() {
  static const std::string bytes = fileOf(MapContent::kCompact);
  return bytes;
}
const std::string& fullFile() {
  static const std::string bytes = fileOf(MapContent::kFull);
  return bytes;
}

std::string errorOf(const std::string& bytes) {
  try {
    MapFile(bytes, "the.file");
  } catch (const MapFileError& error) {
    return error.what();
  }
  return "";
}

/// Reads all of a file; whether that succeeds.
bool isRead(const std::string& bytes) {
  try {
    const MapFile file(bytes, "damaged");
    file.matchMap();
    return true;
  } catch (const MapFileError&) {
    return false;
  }
}

TEST(MapFile, TellsWhatItHolds) {
  const MapFile file(compactFile(), "test");
  EXPECT_EQ(MapContent::kCompact, file.head().content);
  EXPECT_EQ("world", file.head().map_frame);
  EXPECT_EQ(kStop, file.head().scans);
  EXPECT_EQ(file.head().occupied_voxels, file.matchMap().hitVoxels().voxelCount());
  EXPECT_EQ(file.head().edge_voxels, file.matchMap().edges().size());
  EXPECT_EQ(yamlText(Config{}), yamlText(file.config()));
}

TEST(MapFile, IsWrittenAndReadAsAFile) {
  const TempFolder folder;
  writeFile(folder / "map.edgevox", compactFile());
  EXPECT_EQ(kStop, MapFile::read(folder / "map.edgevox").head().scans);
  EXPECT_THROW(MapFile::read(folder / "other.edgevox"), FileError);
  EXPECT_THROW(MapFile::read(folder.path()), FileError);
}

TEST(MapFile, ForeignNewerOlderAndCutFilesAreToldApart) {
  const auto holds = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos && text.find("the.file") != std::string::npos;
  };
  EXPECT_TRUE(holds(errorOf("ply\nformat ascii 1.0\n"), "not a map of edgevox"));
  EXPECT_TRUE(holds(errorOf(""), "not a map of edgevox"));
  std::string newer = compactFile();
  newer[kVersionAt] = 9;
  EXPECT_TRUE(holds(errorOf(newer), "version 9")) << errorOf(newer);
  EXPECT_TRUE(holds(errorOf(newer), "update edgevox"));
  std::string older = compactFile();
  older[kVersionAt] = 1;
  EXPECT_TRUE(holds(errorOf(older), "version 1")) << errorOf(older);
  EXPECT_TRUE(holds(errorOf(older), "which had no planes: make the map again"));
  EXPECT_TRUE(holds(errorOf(compactFile().substr(0, 2000)), "cut"));
  std::string damaged = compactFile();
  damaged[damaged.size() / 2] ^= 1;
  EXPECT_TRUE(holds(errorOf(damaged), "checksum")) << errorOf(damaged);
}

TEST(MapFile, MappingDoesNotGoOnInACompactOne) {
  Mapper mapper{Config{}};
  EXPECT_THROW(MapFile(compactFile(), "test").restore(mapper), MapFileError);
  EXPECT_TRUE(mapper.map().empty());
}

TEST(MapFile, OtherParametersOfTheMapAreRefusedByName) {
  const MapFile file(fullFile(), "test");
  Config config;
  config.threads = 3;
  config.map.memory = 100;
  config.matcher.max_restarts = 3;
  EXPECT_NO_THROW(file.requireSameMap(config));
  config.map.anchors = 9;
  try {
    file.requireSameMap(config);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string::npos, std::string(error.what()).find("map/anchors"));
  }
}

TEST(MapFile, FlipsAndCutsAreNoticed) {
  std::mt19937 random(11);
  for (int i = 0; i < 10000; ++i) {
    std::string bytes = i % 2 == 0 ? compactFile() : fullFile();
    const size_t at = random() % bytes.size();
    if (i % 5 == 4) {
      bytes.resize(at);
    } else {
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
    }
    ASSERT_FALSE(isRead(bytes)) << "case " << i;
  }
}

/// As somebody would who wants a damaged file to be read.
void mendChecksum(std::string& bytes) {
  const auto* rest = reinterpret_cast<const unsigned char*>(bytes.data()) + kStartBytes;
  SHA256(rest, bytes.size() - kStartBytes,
         reinterpret_cast<unsigned char*>(bytes.data()) + kDigestAt);
}

TEST(MapFile, DamageUnderARightChecksumIsSurvived) {
  std::mt19937 random(12);
  int read = 0;
  for (int i = 0; i < 600; ++i) {
    std::string bytes = compactFile();
    for (int k = 0; k < 3; ++k) {
      const size_t at = kStartBytes + random() % (bytes.size() - kStartBytes);
      bytes[at] = static_cast<char>(random());
    }
    mendChecksum(bytes);
    read += isRead(bytes) ? 1 : 0;
  }
  RecordProperty("read", read);
}

}  // namespace
}  // namespace edgevox::test
