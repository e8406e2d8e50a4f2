// SPDX-License-Identifier: BSD-3-Clause
#include "run/run_folder.hpp"

#include <array>
#include <system_error>
#include <utility>

#include "edgevox/io/atomic_file.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

/// The files of a run, also of one that was saved without checksums.
constexpr std::array<const char*, 9> kResults = {
    "trajectory.tum", "map_edges.ply", "map_edges.pcd", "map_occupied.ply", "timings.csv",
    "errors.csv",     "errors.json",   "summary.json",  "config.yaml"};

[[noreturn]] void fail(const fs::path& folder, const std::error_code& error) {
  throw FileError("cannot save to '" + folder.string() + "': " + error.message() +
                  "; check that it may be written to and has space left");
}

/// A file that is not there has been moved before.
void move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error && error != std::errc::no_such_file_or_directory) fail(to.parent_path(), error);
}

/// The checksums of the folder; none if their list is missing or damaged.
Checksums formerChecksums(const fs::path& folder) {
  try {
    return readChecksums(folder / RunFolder::kChecksums);
  } catch (const FileError&) {
    return {};
  }
}

void removeAllBut(const Checksums& kept, const fs::path& folder) {
  std::error_code ignored;
  for (const char* name : kResults) {
    if (kept.count(name) == 0) fs::remove(folder / name, ignored);
  }
}

void requirePlaces(const Checksums& checksums, const fs::path& folder) {
  for (const auto& entry : checksums) {
    std::error_code ignored;
    if (!fs::is_directory(folder / entry.first, ignored)) continue;
    throw FileError("cannot write '" + (folder / entry.first).string() +
                    "': there is a folder of this name; choose another output folder");
  }
}

[[noreturn]] void refuse(const fs::path& file, const std::string& fault) {
  throw FileError("'" + file.string() + "' " + fault + ", by " + RunFolder::kChecksums +
                  " beside it; map or save the run again, or delete " + RunFolder::kChecksums +
                  " if you have changed the files on purpose");
}

}  // namespace

RunFolder::RunFolder(fs::path folder)
    : folder_(std::move(folder)), staging_(folder_ / kStaging), lock_(folder_) {
  completeEarlierSave();
}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (!staged_.empty() && !fs::exists(staging_ / kChecksums, ignored)) {
    fs::remove_all(staging_, ignored);
  }
}

void RunFolder::completeEarlierSave() {
  std::error_code ignored;
  if (fs::exists(staging_ / kChecksums, ignored)) {
    moveIntoPlace();
  } else {
    fs::remove_all(staging_, ignored);
  }
}

void RunFolder::check() const {
  std::error_code ignored;
  if (!fs::exists(folder_ / kChecksums, ignored)) return;
  for (const auto& [name, sum] : readChecksums(folder_ / kChecksums)) {
    const fs::path file = folder_ / name;
    if (!fs::is_regular_file(file, ignored)) refuse(file, "is missing");
    if (sha256Of(file) != sum) refuse(file, "is damaged or of another run");
  }
}

fs::path RunFolder::stage(const std::string& name) {
  std::error_code error;
  fs::create_directory(staging_, error);
  if (error) fail(folder_, error);
  staged_.insert(name);
  return staging_ / name;
}

void RunFolder::replace() {
  const Checksums checksums = stagedChecksums();
  commit(checksums);
  removeAllBut(checksums, folder_);
}

void RunFolder::add() {
  if (!fs::exists(folder_ / kChecksums)) {
    for (const std::string& name : staged_) move(staging_ / name, folder_ / name);
    return;
  }
  Checksums checksums = stagedChecksums();
  for (const auto& entry : formerChecksums(folder_)) checksums.insert(entry);
  commit(checksums);
}

Checksums RunFolder::stagedChecksums() const {
  Checksums checksums;
  for (const std::string& name : staged_) checksums[name] = sha256Of(staging_ / name);
  return checksums;
}

void RunFolder::commit(const Checksums& checksums) {
  requirePlaces(checksums, folder_);
  flushToDisk(staging_);
  writeFile(staging_ / kChecksums, textOf(checksums));
  flushToDisk(staging_);
  flushToDisk(folder_);
  moveIntoPlace();
}

void RunFolder::moveIntoPlace() {
  const Checksums checksums = readChecksums(staging_ / kChecksums);
  for (const auto& entry : checksums) move(staging_ / entry.first, folder_ / entry.first);
  std::error_code ignored;
  for (const auto& entry : formerChecksums(folder_)) {
    if (checksums.count(entry.first) == 0) fs::remove(folder_ / entry.first, ignored);
  }
  flushToDisk(folder_);
  move(staging_ / kChecksums, folder_ / kChecksums);
  flushToDisk(folder_);
  fs::remove_all(staging_, ignored);
}

}  // namespace edgevox
