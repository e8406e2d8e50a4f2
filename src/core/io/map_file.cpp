// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/io/map_file.hpp"

#include <openssl/sha.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include "core/compression.hpp"
#include "core/map/map_code.hpp"
#include "edgevox/archive.hpp"
#include "edgevox/io/atomic_file.hpp"

namespace edgevox {
namespace {

// As in PNG: shows transfers that change the ends of lines.
constexpr std::array<uint8_t, 8> kMagic = {0x89, 'E', 'V', 'X', '\r', '\n', 0x1a, '\n'};
constexpr uint32_t kVersion = 2;
constexpr size_t kDigestBytes = SHA256_DIGEST_LENGTH;
using Digest = std::array<uint8_t, kDigestBytes>;

/// The first bytes of a file.
struct Start {
  std::array<uint8_t, 8> magic = kMagic;
  uint32_t version = kVersion;
  uint64_t size = 0;  // of all that follows [bytes]
  Digest digest{};    // of all that follows

  static constexpr size_t kBytes = sizeof(kMagic) + sizeof(version) + sizeof(size) + kDigestBytes;

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.magic, self.version, self.size, self.digest);
  }
};

Digest digestOf(const std::string& bytes, size_t from) {
  Digest digest;
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()) + from, bytes.size() - from,
         digest.data());
  return digest;
}

bool shapesMap(const Parameter& parameter) {
  const std::string group = parameter.name.substr(0, parameter.name.find('/'));
  return group == "voxel_size" || group == "map" || group == "edges";
}

/// The memory is that of the machine; no result depends on the instruction set.
bool mayDiffer(const Parameter& parameter) {
  return parameter.name == "map/memory" || parameter.name == "edges/instruction_set";
}

std::string parametersText(const Config& config) {
  Config copy = config;
  std::string text;
  for (const Parameter& parameter : parametersOf(copy)) {
    if (parameter.name != "threads") text += parameter.name + "=" + valueText(parameter) + "\n";
  }
  return text;
}

/// Parameters that are not known any more are ignored, those that were not known yet have their
/// defaults.
Config configOf(const std::string& text) {
  Config config;
  const std::vector<Parameter> parameters = parametersOf(config);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::string name = line.substr(0, line.find('='));
    const auto found =
        std::find_if(parameters.begin(), parameters.end(),
                     [&](const Parameter& parameter) { return parameter.name == name; });
    if (found == parameters.end() || line.size() == name.size()) continue;
    assign(*found, line.substr(name.size() + 1));
  }
  validate(config);
  return config;
}

template <typename Archive, typename Head>
void archiveHead(Head& head, Archive& bytes) {
  bytes(head.content, head.map_frame, head.scans, head.occupied_voxels, head.edge_voxels,
        head.parameters);
}

std::string contentOf(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  std::string bytes(error ? 0 : size, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (error || !in) {
    throw FileError("cannot read the map '" + file.string() +
                    "': check that it is a file and may be read");
  }
  return bytes;
}

/// The version of a file that is whole. Throws ArchiveError.
uint32_t check(const std::string& bytes) {
  if (bytes.size() < Start::kBytes ||
      !std::equal(kMagic.begin(), kMagic.end(), bytes.begin(),
                  [](uint8_t a, char b) { return a == static_cast<uint8_t>(b); })) {
    throw ArchiveError("it is not a map of edgevox, or its beginning is damaged");
  }
  Start start;
  ArchiveReader reader(bytes);
  reader(start);
  if (start.version > kVersion) {
    throw ArchiveError("it is of version " + std::to_string(start.version) +
                       ", this edgevox reads up to " + std::to_string(kVersion) +
                       ": update edgevox, or save the map again with this one");
  }
  if (start.version > 0 && start.version < kVersion) {
    throw ArchiveError("it is of version " + std::to_string(start.version) +
                       ", which had no planes: make the map again with this edgevox");
  }
  const size_t rest = bytes.size() - Start::kBytes;
  if (start.version == 0 || rest != start.size) {
    throw ArchiveError("it has " + std::to_string(rest) + " bytes of " +
                       std::to_string(start.size) + ": it was cut, or its beginning is damaged");
  }
  if (digestOf(bytes, Start::kBytes) != start.digest) {
    throw ArchiveError("it is damaged: its content does not fit to its checksum");
  }
  return start.version;
}

std::string fileBytes(const MapFileHead& head, const std::string& body) {
  ArchiveWriter rest;
  archiveHead(head, rest);
  rest(body);
  Start start;
  start.size = rest.bytes().size();
  start.digest = digestOf(rest.bytes(), 0);
  ArchiveWriter file;
  file(start);
  return file.take() + rest.take();
}

/// A parameter of the map with two values.
struct Difference {
  std::string name;
  std::string first;
  std::string second;
};

/// The first one in which they differ.
std::optional<Difference> differenceOf(Config a, Config b) {
  const std::vector<Parameter> first = parametersOf(a);
  const std::vector<Parameter> second = parametersOf(b);
  for (size_t i = 0; i < first.size(); ++i) {
    if (!shapesMap(first[i]) || mayDiffer(first[i])) continue;
    const Difference values{first[i].name, valueText(first[i]), valueText(second[i])};
    if (values.first != values.second) return values;
  }
  return std::nullopt;
}

}  // namespace

const char* toString(MapContent content) {
  return content == MapContent::kFull ? "full" : "compact";
}

std::string mapFileBytes(MapContent content, const Mapper& mapper, const Config& config,
                         const std::string& map_frame) {
  const MapBuilder& map = mapper.map();
  const MapFileHead head{content,
                         map_frame,
                         map.scans(),
                         map.hitVoxelCount(),
                         map.edgeVoxels().voxelCount(),
                         parametersText(config)};
  if (content == MapContent::kCompact) {
    return fileBytes(head, encoded(map.completeMap(), config.map.representation));
  }
  ArchiveWriter body;
  body(mapper);
  return fileBytes(head, compressed(body.bytes()));
}

std::string mapFileBytes(const MatchMap& map, const Config& config, const std::string& map_frame,
                         uint64_t scans) {
  const MapFileHead head{MapContent::kCompact,
                         map_frame,
                         scans,
                         map.hitVoxels().voxelCount(),
                         map.edgeVoxels().voxelCount(),
                         parametersText(config)};
  return fileBytes(head, encoded(map, config.map.representation));
}

/// Errors get the name of the file.
template <typename Read>
auto MapFile::reading(const Read& read) const {
  const auto fail = [this](const std::exception& error) {
    return MapFileError("cannot read the map '" + name_ + "': " + error.what());
  };
  try {
    return read();
  } catch (const ArchiveError& error) {
    throw fail(error);
  } catch (const ConfigError& error) {
    throw fail(error);
  }
}

MapFile MapFile::read(const std::filesystem::path& file) {
  return {contentOf(file), file.string()};
}

MapFile::MapFile(std::string bytes, std::string name) : name_(std::move(name)) {
  reading([&] {
    version_ = check(bytes);
    bytes.erase(0, Start::kBytes);
    ArchiveReader reader(bytes);
    archiveHead(head_, reader);
    reader(body_);
    reader.requireEnd();
    if (head_.content != MapContent::kCompact && head_.content != MapContent::kFull) {
      throw ArchiveError("its content is of an unknown kind");
    }
    config_ = configOf(head_.parameters);
  });
}

MatchMap MapFile::matchMap() const {
  return reading([&] {
    if (head_.content == MapContent::kCompact) return decoded(body_, config_);
    Mapper mapper(config_);
    restore(mapper);
    mapper.finishLabels();
    return mapper.map().completeMap();
  });
}

void MapFile::restore(Mapper& mapper) const {
  if (head_.content != MapContent::kFull) {
    throw MapFileError("the map '" + name_ +
                       "' is compact: scans can be located in it, but mapping cannot go on; save "
                       "a full one for that");
  }
  reading([&] {
    const std::string bytes = decompressed(body_);
    ArchiveReader reader(bytes);
    reader(mapper);
    reader.requireEnd();
  });
}

void MapFile::requireSameMap(const Config& config) const {
  const auto values = differenceOf(config_, config);
  if (!values) return;
  throw ConfigError("the map '" + name_ + "' was built with " + values->name + " = " +
                    values->first + ", which is " + values->second + " now: set it to " +
                    values->first + ", or begin a new map");
}

void MapFile::requireSameMap(const MapFile& other) const {
  const std::string names = "the maps '" + name_ + "' and '" + other.name_ + "'";
  if (head_.map_frame != other.head_.map_frame) {
    throw ConfigError(names + " are in different frames, '" + head_.map_frame + "' and '" +
                      other.head_.map_frame + "': build them in one frame");
  }
  const auto values = differenceOf(config_, other.config_);
  if (!values) return;
  throw ConfigError(names + " were built with different " + values->name + ", " + values->first +
                    " and " + values->second + ": build them with the same");
}

}  // namespace edgevox
