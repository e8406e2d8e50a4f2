// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/io/trajectory_io.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "edgevox/io/atomic_file.hpp"
#include "support/random.hpp"
#include "support/temp_folder.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

Trajectory parse(const std::string& text) {
  std::istringstream in(text);
  return parseTum(in, "path.tum");
}

void expectError(const std::string& text, const std::string& message) {
  try {
    parse(text);
    ADD_FAILURE() << "no error for: " << text;
  } catch (const TrajectoryError& error) {
    EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
  }
}

Trajectory randomTrajectory(size_t size) {
  test::Random random(7);
  Trajectory trajectory(size);
  for (size_t i = 0; i < size; ++i) {
    trajectory[i].stamp = 1630577758.0 + 0.5 * static_cast<double>(i) + random.uniform(0, 0.4);
    trajectory[i].pose.linear() = random.rotation();
    trajectory[i].pose.translation() = random.vectorIn(-100, 100);
  }
  return trajectory;
}

std::string contentOf(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

size_t entriesIn(const fs::path& folder) {
  return static_cast<size_t>(std::distance(fs::directory_iterator(folder), {}));
}

TEST(Tum, readsLinesAndLeavesOutComments) {
  const Trajectory trajectory =
      parse("# stamp x y z qx qy qz qw\n\n1.5 1 2 3 0 0 0 1\r\n  2.5\t4 5 6 0 0 1 0  \n");
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_EQ(trajectory[0].stamp, 1.5);
  EXPECT_EQ(trajectory[0].pose.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(trajectory[0].pose.linear().isIdentity());
  EXPECT_TRUE(
      (trajectory[1].pose.linear() * Eigen::Vector3d::UnitX()).isApprox(-Eigen::Vector3d::UnitX()));
}

TEST(Tum, emptyTextIsAnEmptyTrajectory) { EXPECT_TRUE(parse("# nothing\n").empty()); }

TEST(Tum, malformedLinesAreNamed) {
  const std::string good = "1 0 0 0 0 0 0 1\n";
  expectError(good + "2 0 0 0 0 0 0\n", "path.tum, line 2: there are 7 values");
  expectError("# c\n\n1 0 0 0 0 0 0 1 9\n", "path.tum, line 3: there are 9 values");
  expectError("1 0 0 zero 0 0 0 1\n", "line 1: 'zero' is no finite number");
  expectError("1 0 0 0.5m 0 0 0 1\n", "'0.5m'");
  expectError("1 0 nan 0 0 0 0 1\n", "'nan' is no finite number");
  expectError("1 0 inf 0 0 0 0 1\n", "'inf'");
  expectError("1 0 0 0 0 0 0 0.5\n", "norm 0.5");
  expectError("1 0 0 0 0 0 0 0\n", "norm 0.0");
  expectError(good + good, "line 2: the stamp is not later");
  expectError("2 0 0 0 0 0 0 1\n" + good, "line 2: the stamp is not later");
}

TEST(Tum, missingFileIsNamed) {
  try {
    readTum("no/such/path.tum");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("no/such/path.tum"), std::string::npos);
  }
  EXPECT_THROW(readTum(fs::temp_directory_path()), FileError);
}

TEST(Tum, roundTrip) {
  const test::TempFolder folder;
  const Trajectory written = randomTrajectory(50);
  writeTum(folder / "path.tum", written);
  const Trajectory read = readTum(folder / "path.tum");
  ASSERT_EQ(read.size(), written.size());
  for (size_t i = 0; i < read.size(); ++i) {
    EXPECT_NEAR(read[i].stamp, written[i].stamp, 1e-6);
    EXPECT_LT((read[i].pose.matrix() - written[i].pose.matrix()).cwiseAbs().maxCoeff(), 1e-9);
  }
  EXPECT_EQ(tumText(read), contentOf(folder / "path.tum"));
}

TEST(Tum, textIsFixed) {
  StampedPose stamped;
  stamped.stamp = 1300000000.1;
  stamped.pose.translation() = Eigen::Vector3d(1, -2.5, 1e-7);
  EXPECT_EQ(tumText({stamped}),
            "1300000000.100000 1.000000000 -2.500000000 0.000000100 "
            "0.000000000000 0.000000000000 0.000000000000 1.000000000000\n");
}

TEST(Tum, numbersOfAnySizeAreWhole) {
  Trajectory written(3);
  for (size_t i = 0; i < written.size(); ++i) {
    written[i].stamp = std::pow(10.0, 100.0 * static_cast<double>(i + 1));
    written[i].pose.translation() = Eigen::Vector3d(-1e300, 1e299, std::pow(10.0, -300));
  }
  const std::string text = tumText(written);
  std::istringstream in(text);
  const Trajectory read = parseTum(in, "text");
  ASSERT_EQ(read.size(), written.size());
  for (size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].stamp, written[i].stamp);
    EXPECT_EQ(read[i].pose.translation().x(), written[i].pose.translation().x());
    EXPECT_EQ(read[i].pose.translation().y(), written[i].pose.translation().y());
  }
}

TEST(AtomicFile, replacesTheFileAndLeavesNothingElse) {
  const test::TempFolder folder;
  writeFile(folder / "file", "first");
  writeFile(folder / "file", "second");
  EXPECT_EQ(contentOf(folder / "file"), "second");
  EXPECT_EQ(entriesIn(folder.path()), 1U);
}

TEST(AtomicFile, unfinishedFileDoesNotTouchTheTarget) {
  const test::TempFolder folder;
  writeFile(folder / "file", "before");
  {
    const AtomicFile unfinished(folder / "file");
    std::ofstream(unfinished.temporary()) << "half";
    EXPECT_EQ(unfinished.temporary().parent_path(), folder.path());
    EXPECT_EQ(entriesIn(folder.path()), 2U);
  }
  EXPECT_EQ(contentOf(folder / "file"), "before");
  EXPECT_EQ(entriesIn(folder.path()), 1U);
}

TEST(AtomicFile, threadsThatWriteTheSameFileDoNotMeet) {
  const test::TempFolder folder;
  const std::vector<std::string> contents = {std::string(9000, 'a'), std::string(20000, 'b'),
                                             std::string(30000, 'c'), std::string(500, 'd')};
  std::atomic<int> failures{0};
  std::vector<std::thread> writers;
  for (const std::string& content : contents) {
    writers.emplace_back([&] {
      for (int i = 0; i < 50; ++i) {
        try {
          writeFile(folder / "file", content);
        } catch (const FileError&) {
          ++failures;
        }
        const std::string found = contentOf(folder / "file");
        if (std::count(contents.begin(), contents.end(), found) != 1) ++failures;
      }
    });
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(failures, 0);
  EXPECT_EQ(entriesIn(folder.path()), 1U);
}

TEST(AtomicFile, failuresNameTheFile) {
  const test::TempFolder folder;
  const fs::path target = folder / "missing" / "file";
  try {
    writeFile(target, "text");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find(target.string()), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
  }
  fs::create_directory(folder / "taken");
  EXPECT_THROW(writeFile(folder / "taken", "text"), FileError);
  EXPECT_EQ(entriesIn(folder.path()), 1U);
}

}  // namespace
}  // namespace edgevox
