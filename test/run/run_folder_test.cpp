// SPDX-License-Identifier: BSD-3-Clause
// A run's files are seen together, whatever happens to those who save them. EDGEVOX_SAVES and
// EDGEVOX_KILLS set how often that is tried, EDGEVOX_KILLED_MB how large the killed saves are.
#include "run/run_folder.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <mutex>
#include <sstream>
#include <thread>
#include <vector>

#include "edgevox/io/atomic_file.hpp"
#include "support/random.hpp"
#include "support/temp_folder.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 4> kFiles = {"trajectory.tum", "map_edges.ply", "map_edges.pcd",
                                               "summary.json"};

size_t countOf(const char* variable, size_t otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoul(text, nullptr, 10);
}

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Of one run, told by its first word.
std::string contentOfRun(const std::string& run, size_t bytes) {
  std::string content = run + "\n";
  while (content.size() < bytes) content += content;
  return content;
}

/// Every other run has one file more.
void save(const fs::path& folder, int run, size_t bytes = 200) {
  RunFolder files(folder);
  const std::string content = contentOfRun("run" + std::to_string(run), bytes);
  for (const char* name : kFiles) writeFile(files.stage(name), content);
  if (run % 2 == 1) writeFile(files.stage("map_occupied.ply"), content);
  files.replace();
}

struct Reading {
  std::string run;    ///< of all files, empty if there is none
  std::string fault;  ///< whole or not, empty if the reader has refused
  bool refused = false;
};

Reading read(const fs::path& folder) {
  Reading reading;
  try {
    const RunFolder files(folder);
    files.check();
    std::istringstream(contentOf(folder / kFiles[0])) >> reading.run;
    if (reading.run.empty()) return reading;
    const std::string content = contentOf(folder / kFiles[0]);
    for (const char* name : kFiles) {
      if (contentOf(folder / name) != content) reading.fault += std::string(name) + " differs ";
    }
    const bool odd = (reading.run.back() - '0') % 2 == 1;
    if (fs::exists(folder / "map_occupied.ply") != odd) reading.fault += "a file of another run ";
    if (odd && contentOf(folder / "map_occupied.ply") != content) reading.fault += "occupied ";
    if (fs::exists(folder / RunFolder::kStaging)) reading.fault += "something is left behind ";
  } catch (const FileError& error) {
    reading.refused = true;
    reading.fault = error.what();
  }
  return reading;
}

void expectRun(const fs::path& folder, const std::string& run) {
  const Reading reading = read(folder);
  EXPECT_EQ(reading.fault, "");
  EXPECT_EQ(reading.run, run);
}

void expectRefused(const fs::path& folder, const std::vector<std::string>& words) {
  const Reading reading = read(folder);
  EXPECT_TRUE(reading.refused);
  for (const std::string& word : words) {
    EXPECT_NE(reading.fault.find(word), std::string::npos) << word << " in: " << reading.fault;
  }
}

TEST(RunFolder, theNewRunTakesThePlaceOfTheOld) {
  const test::TempFolder folder;
  std::ofstream(folder / "picture.png") << "mine";
  writeFile(folder / "errors.csv", "of a run without checksums");
  save(folder.path(), 1);
  expectRun(folder.path(), "run1");
  EXPECT_FALSE(fs::exists(folder / "errors.csv"));
  save(folder.path(), 2);
  expectRun(folder.path(), "run2");
  EXPECT_EQ(contentOf(folder / "picture.png"), "mine");
}

TEST(RunFolder, sha256sumReadsTheChecksums) {
  const test::TempFolder folder;
  save(folder.path(), 1);
  const std::string check =
      "cd '" + folder.path().string() + "' && sha256sum --strict --quiet -c checksums.sha256";
  EXPECT_EQ(std::system(check.c_str()), 0);
  writeFile(folder / "trajectory.tum", "");
  EXPECT_NE(std::system((check + " >/dev/null 2>&1").c_str()), 0);
}

TEST(RunFolder, aRunThatIsNotWholeIsRefused) {
  const test::TempFolder folder;
  save(folder.path(), 1);
  std::fstream file(folder / "map_edges.ply", std::ios::in | std::ios::out);
  file.seekp(100);
  file << '#';
  file.close();
  expectRefused(folder.path(),
                {(folder / "map_edges.ply").string(), "damaged", "save the run again"});
  fs::remove(folder / "map_edges.ply");
  expectRefused(folder.path(), {(folder / "map_edges.ply").string(), "missing"});
  for (const char* list : {"neither this nor that\n", "\0\1", "0123  ../x\n"}) {
    std::ofstream(folder / RunFolder::kChecksums) << list << "\n";
    expectRefused(folder.path(), {(folder / RunFolder::kChecksums).string(), "no list"});
  }
  save(folder.path(), 2);
  expectRun(folder.path(), "run2");
}

TEST(RunFolder, filesWithoutChecksumsAreTakenAsTheyAre) {
  const test::TempFolder folder;
  writeFile(folder / "trajectory.tum", "");
  const RunFolder files(folder.path());
  EXPECT_NO_THROW(files.check());
}

TEST(RunFolder, filesJoinARun) {
  const test::TempFolder folder;
  save(folder.path(), 1);
  for (const char* text : {"first", "second"}) {
    RunFolder files(folder.path());
    writeFile(files.stage("errors.csv"), text);
    files.add();
    files.check();
    EXPECT_EQ(contentOf(folder / "errors.csv"), text);
  }
  expectRun(folder.path(), "run1");
  EXPECT_EQ(readChecksums(folder / RunFolder::kChecksums).count("errors.csv"), 1U);
  save(folder.path(), 2);
  EXPECT_FALSE(fs::exists(folder / "errors.csv"));
}

TEST(RunFolder, aSaveThatFailsLeavesTheOldRun) {
  const test::TempFolder folder;
  save(folder.path(), 1);
  {
    RunFolder files(folder.path());
    writeFile(files.stage("trajectory.tum"), "half a run");
  }
  expectRun(folder.path(), "run1");
  fs::create_directory(folder / "errors.json");
  RunFolder files(folder.path());
  writeFile(files.stage("trajectory.tum"), "a run");
  writeFile(files.stage("errors.json"), "with a folder in its way");
  EXPECT_THROW(files.replace(), FileError);
  EXPECT_EQ(contentOf(folder / "trajectory.tum"), contentOfRun("run1", 200));
}

TEST(RunFolder, aFolderThatIsNotThereIsNamed) {
  const test::TempFolder folder;
  expectRefused(folder / "none", {(folder / "none").string(), "No such file"});
}

TEST(RunFolder, fourSaversWhoReadInBetween) {
  const test::TempFolder folder;
  const size_t saves = countOf("EDGEVOX_SAVES", 100);
  std::atomic<size_t> started{0}, failed{0};
  std::mutex mutex;
  std::string faults;
  size_t of_others = 0;
  const auto saveAndRead = [&](size_t run) {
    save(folder.path(), static_cast<int>(run));
    const Reading reading = read(folder.path());
    const std::lock_guard<std::mutex> lock(mutex);
    faults += reading.fault;
    of_others += reading.run != "run" + std::to_string(run) ? 1 : 0;
  };
  std::vector<std::thread> savers;
  for (int i = 0; i < 4; ++i) {
    savers.emplace_back([&] {
      for (size_t run = started++; run < saves; run = started++) {
        try {
          saveAndRead(run);
        } catch (const std::exception&) {
          ++failed;
        }
      }
    });
  }
  for (std::thread& saver : savers) saver.join();
  EXPECT_EQ(failed, 0U);
  EXPECT_EQ(faults, "");
  std::cout << saves << " saves, " << failed << " failed; as many readings, " << of_others
            << " of a run of another saver, faults: " << faults.size() << "\n";
}

/// Saves one run after another into the folder and is killed after some time.
void saveAndDie(const fs::path& folder, int first_run, size_t bytes, double seconds) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    for (int run = first_run;; ++run) save(folder, run, bytes);
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  ASSERT_EQ(kill(child, SIGKILL), 0);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the saver has failed by itself";
}

/// What a killed saver has left.
struct Remains {
  size_t staged = 0;    ///< files were being written
  size_t complete = 0;  ///< files were being moved
};

TEST(RunFolder, killedSaversLeaveAWholeRun) {
  const test::TempFolder folder;
  const size_t kills = countOf("EDGEVOX_KILLS", 20);
  const size_t bytes = countOf("EDGEVOX_KILLED_MB", 1) * 1000 * 1000 / 4;
  test::Random random(5);
  save(folder.path(), 0, bytes);
  Remains remains;
  size_t accepted = 0, whole = 0;
  for (size_t i = 1; i <= kills; ++i) {
    const double seconds = random.uniform(0.001, 0.02 + 4e-8 * static_cast<double>(bytes));
    saveAndDie(folder.path(), static_cast<int>(1000 * i), bytes, seconds);
    if (fs::exists(folder / RunFolder::kStaging / RunFolder::kChecksums)) {
      ++remains.complete;
    } else if (fs::exists(folder / RunFolder::kStaging)) {
      ++remains.staged;
    }
    const Reading reading = read(folder.path());
    accepted += reading.refused ? 0 : 1;
    whole += !reading.run.empty() && reading.fault.empty() ? 1 : 0;
    EXPECT_EQ(reading.fault, "");
  }
  EXPECT_EQ(accepted, kills);
  EXPECT_EQ(whole, accepted);
  EXPECT_GT(remains.staged + remains.complete, 0U) << "no saver was killed while it saved";
  std::cout << kills << " kills, " << remains.staged << " while files were written, "
            << remains.complete << " while they were moved; " << accepted << " accepted, " << whole
            << " whole\n";
}

/// A saver is killed between any two moves of files.
TEST(RunFolder, aSaveCutOffWhileItsFilesAreMovedIsCompleted) {
  for (size_t moved = 0; moved <= kFiles.size(); ++moved) {
    const test::TempFolder folder;
    save(folder.path(), 1);
    const test::TempFolder other;
    save(other.path(), 2);
    fs::create_directory(folder / RunFolder::kStaging);
    for (size_t i = 0; i < kFiles.size(); ++i) {
      const fs::path to = i < moved ? folder.path() : folder / RunFolder::kStaging;
      fs::rename(other / kFiles[i], to / kFiles[i]);
    }
    fs::rename(other / RunFolder::kChecksums, folder / RunFolder::kStaging / RunFolder::kChecksums);
    expectRun(folder.path(), "run2");
  }
}

}  // namespace
}  // namespace edgevox
