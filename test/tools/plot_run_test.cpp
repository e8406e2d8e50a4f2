// SPDX-License-Identifier: BSD-3-Clause
// The script itself: a run that is not whole gives one line that names the file, and exit code 1.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>

#include "edgevox/io/atomic_file.hpp"
#include "run/run_folder.hpp"
#include "tools/map_bag_fixture.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int exit_code;
  std::string output;
};

class PlotRunTest : public test::MapBagTest {
 protected:
  void SetUp() override {
    writeBag({test::simulatedRun().clouds.begin(), test::simulatedRun().clouds.begin() + 4});
    writeTum(folder_ / "truth.tum", test::simulatedRun().truth);
    options_.reference = (folder_ / "truth.tum").string();
    run();
  }

  Outcome plot() const {
    const std::string command = "/usr/bin/python3 '" EDGEVOX_SOURCE_DIR "/scripts/plot_run' '" +
                                options_.output.string() + "' 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    std::string output;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) output += static_cast<char>(c);
    return {WEXITSTATUS(pclose(pipe)), output};
  }

  void expectRefused(const std::string& file, const std::string& fault) const {
    const Outcome outcome = plot();
    EXPECT_EQ(outcome.exit_code, 1) << file;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_NE(outcome.output.find("'" + (options_.output / file).string() + "'"), std::string::npos)
        << outcome.output;
    EXPECT_NE(outcome.output.find(fault), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find("map "), std::string::npos) << "what to do: " << outcome.output;
  }

  /// The file is whole again after that.
  void expectRefused(const std::string& name, void (*damage)(const fs::path&),
                     const std::string& fault) const {
    const fs::path file = options_.output / name;
    const std::string content = test::contentOf(file);
    damage(file);
    expectRefused(name, fault);
    writeFile(file, content);
  }
};

void cutShort(const fs::path& file) { fs::resize_file(file, 3 * fs::file_size(file) / 5 + 7); }
void emptied(const fs::path& file) { fs::resize_file(file, 0); }
void removed(const fs::path& file) { fs::remove(file); }

TEST_F(PlotRunTest, drawsARunAndWhatWasSavedByHalf) {
  EXPECT_EQ(plot().exit_code, 0);
  EXPECT_GT(fs::file_size(options_.output / "run.png"), 10000U);
  // A saver was killed when its files were complete and some of them moved.
  const fs::path staging = options_.output / RunFolder::kStaging;
  fs::create_directory(staging);
  for (const char* name : {RunFolder::kChecksums, "trajectory.tum", "summary.json"}) {
    fs::rename(options_.output / name, staging / name);
  }
  EXPECT_EQ(plot().exit_code, 0);
  EXPECT_FALSE(fs::exists(staging));
}

TEST_F(PlotRunTest, damageIsSeenByTheChecksums) {
  expectRefused("map_edges.pcd", cutShort, "damaged");
  expectRefused("errors.csv", removed, "missing");
  expectRefused(RunFolder::kChecksums, cutShort, "damaged");
}

TEST_F(PlotRunTest, damageIsSeenWithoutChecksums) {
  fs::remove(options_.output / RunFolder::kChecksums);
  for (const char* name :
       {"trajectory.tum", "map_edges.ply", "timings.csv", "errors.csv", "summary.json"}) {
    expectRefused(name, cutShort, "damaged");
  }
  expectRefused("timings.csv", emptied, "damaged");
  expectRefused("map_edges.ply", removed, "missing");
}

}  // namespace
}  // namespace edgevox
