// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "run/checksums.hpp"
#include "run/folder_lock.hpp"

namespace edgevox {

/// The files of one run in a folder that may hold others, which are left alone. They are written
/// into its subfolder kStaging; with a list of their checksums they are complete and take their
/// places. A saver that is killed before leaves the run that was there; later, a run that the next
/// RunFolder completes. While one exists, others of the same folder wait.
class RunFolder {
 public:
  static constexpr const char* kChecksums = "checksums.sha256";  ///< for sha256sum -c
  static constexpr const char* kStaging = ".saving";

  /// Completes or drops what a killed saver has left in the folder, which must exist. Throws
  /// FileError.
  explicit RunFolder(std::filesystem::path folder);
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  ~RunFolder();

  /// Throws FileError, with what to do, unless all files are there as they were saved. A folder
  /// without checksums, made by hand or by edgevox 0.1.0, is taken as it is.
  void check() const;

  /// Where to write a file of the run. Throws FileError.
  std::filesystem::path stage(const std::string& name);

  /// The staged files take the place of the whole run that was there. Throws FileError.
  void replace();
  /// The staged files join the run that is there, in place of those of the same name. A folder
  /// without checksums stays one. Throws FileError.
  void add();

 private:
  void completeEarlierSave();
  Checksums stagedChecksums() const;
  void commit(const Checksums& checksums);
  void moveIntoPlace();

  std::filesystem::path folder_;
  std::filesystem::path staging_;
  FolderLock lock_;
  std::set<std::string> staged_;
};

}  // namespace edgevox
