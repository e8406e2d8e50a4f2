// SPDX-License-Identifier: BSD-3-Clause
// The library outside of ROS: built without catkin, installed, found by the project of examples,
// whose results are those of the library that this test is linked to, which is optimised more.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "edgevox/io/trajectory_io.hpp"
#include "edgevox/mapping/pipeline.hpp"
#include "edgevox/scan/motion.hpp"
#include "support/sweeps.hpp"
#include "support/temp_folder.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int exit_code;
  std::string output;
};

/// Without what a make or a ROS around this test would hand on.
Outcome execute(const std::string& command) {
  const std::string line =
      "env -u MAKEFLAGS -u MAKELEVEL -u CMAKE_PREFIX_PATH " + command + " 2>&1";
  FILE* pipe = popen(line.c_str(), "r");
  std::string output;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) output += static_cast<char>(c);
  return {WEXITSTATUS(pclose(pipe)), output};
}

std::string contentOf(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

Outcome configure(const fs::path& source, const fs::path& build, const std::string& options) {
  return execute(EDGEVOX_CMAKE " -S " + quoted(source) + " -B " + quoted(build) +
                 " -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O1 "
                 "-DCMAKE_CXX_COMPILER='" EDGEVOX_COMPILER
                 "' -DCMAKE_CXX_COMPILER_LAUNCHER='" EDGEVOX_COMPILER_LAUNCHER "' " +
                 options);
}

/// A room scanned from poses on a bend, the sensor standing still in each; the fourth value of the
/// points has no meaning.
test::Walk walkThroughRoom(int count) {
  sim::Sensor sensor = sim::makeSensor("32");
  sensor.columns = 600;
  const sim::World room = test::furnishedRoom();
  test::Walk walk;
  for (int i = 0; i < count; ++i) {
    Pose pose = Pose::Identity();
    pose.translation() << 0.06 * i, 0.01 * i, 0.0;
    pose.linear() = rotationOf({0.0, 0.0, 0.02 * i});
    const double stamp = i / 10.0;
    walk.sweeps.push_back(test::castSweep(
        room, sensor, [&](double) { return pose; }, stamp, static_cast<uint32_t>(i)));
    walk.truth.push_back({stamp, pose});
  }
  return walk;
}

void writeCloud(const fs::path& file, const test::Sweep& sweep) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(sweep.points.data()),
            static_cast<std::streamsize>(sweep.points.size() * sizeof(sweep.points[0])));
}

Trajectory mapHere(const test::Walk& walk) {
  Pipeline pipeline{Config()};
  Trajectory trajectory;
  for (const test::Sweep& sweep : walk.sweeps) {
    CloudView view = sweep.view();
    view.time = {};
    const ScanResult scan = pipeline.process(view).scan;
    if (scan.located()) trajectory.push_back({scan.stamp, scan.T_map_sensor});
  }
  return trajectory;
}

class ExamplesTest : public ::testing::Test {
 protected:
  /// The core is built in the build folder, where it is up to date the next time; it is moved
  /// after it is installed, as a package of it is.
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
    const fs::path core = fs::path(EDGEVOX_BUILD_DIR) / "without_catkin";
    expectSuccess(configure(EDGEVOX_SOURCE_DIR, core, "-DEDGEVOX_ROS=OFF"));
    expectSuccess(execute(EDGEVOX_CMAKE " --build " + quoted(core)));
    expectSuccess(execute(EDGEVOX_CMAKE " --install " + quoted(core) + " --prefix " +
                          quoted(*folder_ / "staged")));
    fs::rename(*folder_ / "staged", *folder_ / "prefix");
    expectSuccess(configure(EDGEVOX_SOURCE_DIR "/examples", *folder_ / "examples",
                            "-DCMAKE_PREFIX_PATH=" + quoted(*folder_ / "prefix")));
    expectSuccess(execute(EDGEVOX_CMAKE " --build " + quoted(*folder_ / "examples")));
  }

  static void TearDownTestSuite() { folder_.reset(); }

  static void expectSuccess(const Outcome& outcome) {
    ASSERT_EQ(0, outcome.exit_code) << outcome.output;
  }

  static Outcome mapFolder(const std::string& arguments) {
    return execute(quoted(*folder_ / "examples" / "map_folder") + " " + arguments);
  }

  static void expectRefused(const fs::path& clouds, const std::string& fault) {
    const Outcome outcome = mapFolder(quoted(clouds) + " " + quoted(*folder_ / "none.tum"));
    EXPECT_EQ(1, outcome.exit_code);
    EXPECT_EQ(1, std::count(outcome.output.begin(), outcome.output.end(), '\n')) << outcome.output;
    EXPECT_NE(std::string::npos, outcome.output.find(fault)) << outcome.output;
    EXPECT_FALSE(fs::exists(*folder_ / "none.tum"));
  }

  static std::unique_ptr<test::TempFolder> folder_;
};

std::unique_ptr<test::TempFolder> ExamplesTest::folder_;

TEST_F(ExamplesTest, mapFolderGivesTheTrajectoryOfThisLibrary) {
  const fs::path clouds = *folder_ / "clouds";
  fs::create_directory(clouds);
  const test::Walk walk = walkThroughRoom(8);
  for (size_t i = 0; i < walk.sweeps.size(); ++i) {
    writeCloud(clouds / ("00000" + std::to_string(i) + ".bin"), walk.sweeps[i]);
  }
  const fs::path file = *folder_ / "trajectory.tum";
  const Outcome outcome = mapFolder(quoted(clouds) + " " + quoted(file));
  ASSERT_EQ(0, outcome.exit_code) << outcome.output;
  EXPECT_EQ(0U, outcome.output.find("8 clouds: ")) << outcome.output;
  EXPECT_NE(std::string::npos, outcome.output.find(" 1 first")) << outcome.output;
  EXPECT_EQ(tumText(mapHere(walk)), contentOf(file));
  const Trajectory found = readTum(file);
  ASSERT_EQ(walk.truth.size(), found.size());
  for (size_t i = 0; i < found.size(); ++i) {
    const auto error = test::differenceOf(walk.truth[i].pose, found[i].pose);
    EXPECT_LT(error.metres, 0.02) << i;
    EXPECT_LT(error.degrees, 0.3) << i;
  }
}

TEST_F(ExamplesTest, localizeFolderLocatesCloudsInTheMapItHasSaved) {
  const fs::path clouds = *folder_ / "half";
  fs::create_directory(clouds);
  const test::Walk walk = walkThroughRoom(12);
  for (size_t i = 0; i < walk.sweeps.size(); ++i) {
    writeCloud(clouds / (std::string(1, static_cast<char>('a' + i)) + ".bin"), walk.sweeps[i]);
  }
  const fs::path map = *folder_ / "room.edgevox";
  const fs::path file = *folder_ / "located.tum";
  const Outcome outcome = execute(quoted(*folder_ / "examples" / "localize_folder") + " " +
                                  quoted(clouds) + " " + quoted(map) + " " + quoted(file));
  ASSERT_EQ(0, outcome.exit_code) << outcome.output;
  EXPECT_NE(std::string::npos, outcome.output.find("6 of 6 clouds located")) << outcome.output;
  const Trajectory found = readTum(file);
  ASSERT_EQ(6U, found.size());
  for (size_t i = 0; i < found.size(); ++i) {
    const auto error = test::differenceOf(walk.truth[2 * i + 1].pose, found[i].pose);
    EXPECT_LT(error.metres, 0.02) << i;
    EXPECT_LT(error.degrees, 0.3) << i;
  }
}

TEST_F(ExamplesTest, mapFolderRefusesWhatIsNoCloud) {
  const fs::path clouds = *folder_ / "bad";
  expectRefused(clouds, "bad");
  fs::create_directory(clouds);
  expectRefused(clouds, "holds no .bin files");
  writeCloud(clouds / "0.bin", walkThroughRoom(1).sweeps[0]);
  fs::resize_file(clouds / "0.bin", fs::file_size(clouds / "0.bin") - 3);
  expectRefused(clouds, "0.bin' has ");
  EXPECT_EQ(2, mapFolder("").exit_code);
}

TEST_F(ExamplesTest, aNewerVersionIsNotFound) {
  const fs::path source = *folder_ / "newer";
  fs::create_directory(source);
  std::ofstream(source / "CMakeLists.txt") << "cmake_minimum_required(VERSION 3.16)\n"
                                              "project(newer CXX)\n"
                                              "find_package(edgevox 99 REQUIRED)\n";
  const Outcome outcome = configure(source, *folder_ / "newer_build",
                                    "-DCMAKE_PREFIX_PATH=" + quoted(*folder_ / "prefix"));
  EXPECT_NE(0, outcome.exit_code);
  EXPECT_NE(std::string::npos, outcome.output.find("edgevoxConfig.cmake, version: "))
      << outcome.output;
}

TEST(Options, aToolOfBagsNeedsRos) {
  const test::TempFolder folder;
  const Outcome outcome = configure(EDGEVOX_SOURCE_DIR, folder.path(),
                                    "-DEDGEVOX_ROS=OFF -DEDGEVOX_BUILD_EVALUATION=ON");
  EXPECT_NE(0, outcome.exit_code);
  EXPECT_NE(std::string::npos, outcome.output.find("EDGEVOX_BUILD_EVALUATION needs EDGEVOX_ROS"))
      << outcome.output;
}

}  // namespace
}  // namespace edgevox
