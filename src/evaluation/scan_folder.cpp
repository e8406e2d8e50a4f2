// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/scan_folder.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/kitti_folder.hpp"
#include "evaluation/pcl_folder.hpp"
#include "evaluation/posed_files.hpp"
#include "evaluation/uos_folder.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDigits = "0123456789";

bool isNumber(const std::string& text) {
  return !text.empty() && text.find_first_not_of(kDigits) == std::string::npos;
}

bool isUos(const fs::path& file) {
  const std::string stem = file.stem();
  return file.extension() == ".3d" && stem.rfind("scan", 0) == 0 && isNumber(stem.substr(4));
}
bool isKitti(const fs::path& file) { return file.extension() == ".bin" && isNumber(file.stem()); }
bool isPcd(const fs::path& file) { return file.extension() == ".pcd"; }
bool isPly(const fs::path& file) { return file.extension() == ".ply"; }

struct Format {
  const char* scans;      ///< their names, to print
  const char* subfolder;  ///< in which they lie
  bool (*is_scan)(const fs::path& file);
  std::vector<PosedFile> (*list)(const ScanFolder& folder);
  RecordedScan (*read)(const fs::path& file);
};

constexpr std::array<Format, 5> kFormats = {{
    {"scanNNN.3d", "", isUos, uosScans, readUos},
    {"velodyne/NNNNNN.bin", "velodyne", isKitti, kittiScans, readKitti},
    {"NNNNNN.bin", "", isKitti, kittiScans, readKitti},
    {"*.pcd", "", isPcd, pclScans, readPcd},
    {"*.ply", "", isPly, pclScans, readPly},
}};

/// Sorts as the name, but digits by the number they are.
std::string sortKey(const fs::path& file) {
  const std::string name = file.filename();
  std::string key;
  for (size_t at = 0; at < name.size();) {
    const size_t end = std::min(name.find_first_not_of(kDigits, at), name.size());
    if (end == at) {
      key += name[at++];
      continue;
    }
    at = std::min(name.find_first_not_of('0', at), end);
    key += static_cast<char>(end - at) + name.substr(at, end - at);
    at = end;
  }
  return key;
}

std::vector<fs::path> scansOf(const Format& format, const fs::path& folder) {
  std::vector<std::pair<std::string, fs::path>> keyed;
  const fs::path place = folder / format.subfolder;
  if (fs::is_directory(folder) && !fs::is_directory(place)) return {};
  for (const fs::directory_entry& entry : fs::directory_iterator(place)) {
    const fs::path& file = entry.path();
    if (format.is_scan(file) && entry.is_regular_file()) keyed.emplace_back(sortKey(file), file);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<fs::path> files;
  for (auto& file : keyed) files.push_back(std::move(file.second));
  return files;
}

std::string namesOf(const std::vector<const Format*>& formats) {
  std::string names;
  for (const Format* format : formats)
    names += (names.empty() ? "" : ", ") + std::string(format->scans);
  return names;
}

/// The format of the folder, whose scans it finds.
const Format& formatOf(ScanFolder& folder) {
  std::vector<const Format*> all;
  std::vector<const Format*> found;
  for (const Format& format : kFormats) {
    all.push_back(&format);
    std::vector<fs::path> scans = scansOf(format, folder.folder);
    if (scans.empty()) continue;
    found.push_back(&format);
    folder.scans = std::move(scans);
  }
  const std::string name = "'" + folder.folder.string() + "' ";
  if (found.empty()) throw std::invalid_argument(name + "holds no scans: " + namesOf(all));
  if (found.size() == 1) return *found.front();
  throw std::invalid_argument(name + "holds scans of several formats: " + namesOf(found) +
                              "; give a folder with those of one");
}

RecordedScan readScan(const Format& format, const PosedFile& posed) {
  RecordedScan scan = format.read(posed.file);
  if (scan.bytes.empty()) refuse(posed.file, "holds no points; fetch it again or take it out");
  scan.view.stamp = posed.stamp;
  return scan;
}

}  // namespace

ScanStream folderStream(const fs::path& folder, const fs::path& poses) {
  try {
    ScanFolder given{folder, poses, {}};
    const Format& format = formatOf(given);
    const auto files = std::make_shared<const std::vector<PosedFile>>(format.list(given));
    return [=](size_t most, const VisitScan& visit) {
      for (size_t i = 0; i < std::min(most, files->size()); ++i) {
        const RecordedScan scan = readScan(format, (*files)[i]);
        visit(scan.view, (*files)[i].truth);
      }
    };
  } catch (const fs::filesystem_error& error) {
    refuse(folder, std::string("cannot be read: ") + error.what() + "; check its rights");
  }
}

}  // namespace edgevox
