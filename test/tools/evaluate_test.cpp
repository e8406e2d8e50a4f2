// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "run/run_folder.hpp"
#include "tools/map_bag_fixture.hpp"

namespace edgevox {
namespace {

using test::contentOf;

struct Outcome {
  int exit_code;
  std::string output;
};

/// The program itself, as built beside this test.
Outcome evaluateRun(const std::string& arguments) {
  char self[4096] = {};
  if (readlink("/proc/self/exe", self, sizeof self - 1) < 0) return {-1, ""};
  const auto program = std::filesystem::path(self).parent_path() / "evaluate";
  FILE* pipe = popen((program.string() + " " + arguments + " 2>&1").c_str(), "r");
  std::string output;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) output += static_cast<char>(c);
  return {WEXITSTATUS(pclose(pipe)), output};
}

class EvaluateTest : public test::MapBagTest {};

TEST_F(EvaluateTest, givesTheErrorsThatMapBagGives) {
  writeBag(test::simulatedRun().clouds);
  writeTum(folder_ / "truth.tum", test::simulatedRun().truth);
  options_.reference = (folder_ / "truth.tum").string();
  const YAML::Node summary = run();
  const std::string errors = contentOf(options_.output / "errors.csv");
  ASSERT_FALSE(errors.empty());
  const std::string reference = std::exchange(options_.reference, "");
  run();
  ASSERT_FALSE(std::filesystem::exists(options_.output / "errors.csv"));

  const Outcome outcome =
      evaluateRun("run " + options_.output.string() + " --reference " + reference);
  ASSERT_EQ(0, outcome.exit_code) << outcome.output;
  const YAML::Node printed = YAML::Load(outcome.output);
  EXPECT_GT(printed.size(), 5U);
  for (const auto& value : printed) {
    const auto name = value.first.as<std::string>();
    EXPECT_EQ(YAML::Dump(summary[name]), YAML::Dump(value.second)) << name;
  }
  EXPECT_EQ(errors, contentOf(options_.output / "errors.csv"));
  EXPECT_EQ(outcome.output, contentOf(options_.output / "errors.json"));
  EXPECT_NO_THROW(RunFolder(options_.output).check());
}

TEST_F(EvaluateTest, refusesARunThatIsNotWhole) {
  writeBag({test::simulatedRun().clouds.front()});
  run();
  std::ofstream(options_.output / "trajectory.tum", std::ios::app) << "# a line more\n";
  const Outcome outcome = evaluateRun("run " + options_.output.string() + " --reference /none.tum");
  EXPECT_EQ(1, outcome.exit_code);
  EXPECT_NE(std::string::npos, outcome.output.find("trajectory.tum' is damaged")) << outcome.output;
}

TEST_F(EvaluateTest, saysWhatIsMissing) {
  const Outcome missing = evaluateRun("run " + folder_.path().string() + " --reference /none.tum");
  EXPECT_EQ(1, missing.exit_code);
  EXPECT_NE(std::string::npos, missing.output.find("trajectory.tum")) << missing.output;
  const Outcome unknown = evaluateRun("maps x --reference y");
  EXPECT_EQ(2, unknown.exit_code);
  EXPECT_NE(std::string::npos, unknown.output.find("'maps' is not known")) << unknown.output;
}

TEST_F(EvaluateTest, measuresEdges) {
  const std::filesystem::path out = folder_ / "edges";
  const std::string arguments = " --scans 3 --every 40 --voxel-sizes 0.4 --pair-step 1 --output ";
  const Outcome outcome = evaluateRun("edges corridor:16" + arguments + out.string());
  ASSERT_EQ(0, outcome.exit_code) << outcome.output;
  const std::string text = contentOf(out / "edges.md");
  EXPECT_NE(std::string::npos, text.find("3 scans")) << text;
  EXPECT_NE(std::string::npos, text.find("| 0.40 | scan with support |")) << text;
  EXPECT_NE(std::string::npos, text.find("False edges by cause")) << text;
  EXPECT_NE(std::string::npos, outcome.output.find(text));
  const std::string table = contentOf(out / "edges.csv");
  EXPECT_EQ(0U, table.find("voxel_m,method,"));
  const bool drawn = std::filesystem::exists(out / "edges.png");
  EXPECT_NE(drawn, outcome.output.find("edges.png was not drawn") != std::string::npos);
}

TEST_F(EvaluateTest, measuresEdgesOfOtherConfigurations) {
  const std::string arguments = "edges corridor:16 --scans 2 --voxel-sizes 0.4 --output ";
  const auto occupiedOfMap = [&](const std::string& name, const std::string& options) {
    const auto out = folder_ / name;
    EXPECT_EQ(0, evaluateRun(arguments + out.string() + options).exit_code);
    const std::string table = contentOf(out / "edges.csv");
    const std::string row = "\n0.4,map,";
    return std::atof(table.c_str() + table.find(row) + row.size());
  };
  EXPECT_GT(occupiedOfMap("once", " --set map/min_hits=1"), 1.1 * occupiedOfMap("twice", ""));
  EXPECT_NE(std::string::npos, contentOf(folder_ / "once" / "edges.md").find("map/min_hits=1"));
  const Outcome unknown = evaluateRun(arguments + "x --set map/hits=1");
  EXPECT_EQ(2, unknown.exit_code);
  EXPECT_NE(std::string::npos, unknown.output.find("map/hits")) << unknown.output;
}

TEST_F(EvaluateTest, countsRightWrongAndLostScans) {
  const std::filesystem::path out = folder_ / "trust";
  const Outcome outcome =
      evaluateRun("trust --worlds corridor --beams 16 --seeds 1 --strides 1,8 --most 40 --output " +
                  out.string());
  ASSERT_EQ(0, outcome.exit_code) << outcome.output;
  const std::string text = contentOf(out / "trust.md");
  EXPECT_NE(std::string::npos, text.find("| corridor | 16 | 1 | 40 | 100.00 | 0.00 | 0.00 |"))
      << text;
  EXPECT_NE(std::string::npos, text.find("| corridor | 16 | 8 | 5 | 100.00 | 0.00 | 0.00 |"))
      << text;
  EXPECT_NE(std::string::npos, outcome.output.find(text));
  const std::string table = contentOf(out / "trust.csv");
  EXPECT_NE(std::string::npos, table.find("\ncorridor:16:1,corridor,16,1,8,5,5,0,0,0,")) << table;
  const bool drawn = std::filesystem::exists(out / "trust.png");
  EXPECT_NE(drawn, outcome.output.find("trust.png was not drawn") != std::string::npos);
}

TEST_F(EvaluateTest, looksForScansInAMapFile) {
  writeBag(test::simulatedRun().clouds);
  run();
  const std::string map = (options_.output / "map.edgevox").string();
  const auto out = folder_ / "localize";
  const auto localize = [&](const std::filesystem::path& poses) {
    return evaluateRun("localize " + map + " " + options_.bag + " --poses " + poses.string() +
                       " --output " + out.string());
  };
  const Outcome outcome = localize(options_.output / "trajectory.tum");
  ASSERT_EQ(0, outcome.exit_code) << outcome.output;
  const std::string text = contentOf(out / "localize.md");
  EXPECT_NE(std::string::npos, text.find("| 12 | 100.0 | 0.0 |")) << text;
  EXPECT_NE(std::string::npos, outcome.output.find(text));
  EXPECT_NE(std::string::npos, contentOf(out / "localize.csv").find(",right,1,"));
  const bool drawn = std::filesystem::exists(out / "localize.png");
  EXPECT_NE(drawn, outcome.output.find("localize.png was not drawn") != std::string::npos);

  Trajectory shifted = readTum(options_.output / "trajectory.tum");
  for (StampedPose& pose : shifted) pose.pose.translation().x() += 1.0;
  writeTum(folder_ / "shifted.tum", shifted);
  ASSERT_EQ(0, localize(folder_ / "shifted.tum").exit_code);
  const std::string wrong = contentOf(out / "localize.md");
  EXPECT_NE(std::string::npos, wrong.find("| 12 | 0.0 | 0.0 | 0.0 | 100.0 |")) << wrong;
}

TEST_F(EvaluateTest, countsScansOfABagAgainstItsReference) {
  writeBag(test::simulatedRun().clouds);
  Trajectory wrong = test::simulatedRun().truth;
  for (size_t i = 1; i < wrong.size(); ++i) wrong[i].pose.translation().x() += 1.0;
  writeTum(folder_ / "wrong.tum", wrong);
  const std::string out = (folder_ / "trust").string();
  const Outcome outcome =
      evaluateRun("trust --worlds none --strides 1 --output " + out + " --bag " + options_.bag +
                  " " + options_.bag + "=" + (folder_ / "wrong.tum").string());
  ASSERT_EQ(0, outcome.exit_code) << outcome.output;
  const std::string n = std::to_string(wrong.size());
  const std::string others = std::to_string(wrong.size() - 1);
  const std::string table = contentOf(folder_ / "trust" / "trust.csv");
  EXPECT_NE(std::string::npos, table.find(",,,,1," + n + "," + n + ",0,0,0,")) << table;
  EXPECT_NE(std::string::npos, table.find(",,,,1," + n + ",1," + others + ",0,0,")) << table;
}

TEST_F(EvaluateTest, measuresCaptureBesideThatOfPcl) {
  const auto out = folder_ / "trust";
  const Outcome outcome = evaluateRun(
      "trust --worlds none --capture --capture-inputs corridor:16 --most 6 --trials 3 "
      "--set voxel_size=0.4 --output " +
      out.string());
  ASSERT_EQ(0, outcome.exit_code) << outcome.output;
  const std::string text = contentOf(out / "capture.md");
  EXPECT_NE(std::string::npos, outcome.output.find(text));
  for (const char* method : {"edgevox (first scan)", "edgevox", "PCL GICP", "PCL NDT"}) {
    EXPECT_NE(std::string::npos, text.find("degrees | " + std::string(method) + " | 3 |")) << text;
  }
  const std::string table = contentOf(out / "capture.csv");
  EXPECT_EQ(0U, table.find("recording,disturbance,registration,trials,right,refused,wrong,ms\n"));
  EXPECT_FALSE(std::filesystem::exists(out / "trust.csv"));
  EXPECT_EQ(2, evaluateRun("trust --worlds none --capture --capture-inputs corridor:16 --most 1 "
                           "--output " +
                           out.string())
                   .exit_code);
}

TEST_F(EvaluateTest, refusesAMatrixOfNothing) {
  const std::string output = " --output " + (folder_ / "trust").string();
  const Outcome bag = evaluateRun("trust --worlds none --bag /none.bag=/none.tum" + output);
  EXPECT_EQ(1, bag.exit_code);
  EXPECT_NE(std::string::npos, bag.output.find("/none.bag")) << bag.output;
  const Outcome seeds = evaluateRun("trust --worlds corridor --seeds 1-x" + output);
  EXPECT_EQ(2, seeds.exit_code);
  EXPECT_NE(std::string::npos, seeds.output.find("--seeds")) << seeds.output;
  EXPECT_EQ(2, evaluateRun("trust --worlds castle" + output).exit_code);
  EXPECT_EQ(2, evaluateRun("trust --worlds corridor --beams 17" + output).exit_code);
  EXPECT_EQ(2, evaluateRun("trust --worlds none" + output).exit_code);
}

TEST_F(EvaluateTest, refusesEdgesOfNothing) {
  const std::string output = " --output " + (folder_ / "edges").string();
  const Outcome bag = evaluateRun("edges /none.bag" + output);
  EXPECT_EQ(1, bag.exit_code);
  EXPECT_NE(std::string::npos, bag.output.find("/none.bag")) << bag.output;
  const Outcome sensor = evaluateRun("edges corridor:17" + output);
  EXPECT_EQ(2, sensor.exit_code);
  EXPECT_NE(std::string::npos, sensor.output.find("unknown sensor '17'")) << sensor.output;
  EXPECT_EQ(2, evaluateRun("edges corridor:16 --voxel-sizes 0" + output).exit_code);
  EXPECT_EQ(2, evaluateRun("edges corridor:16 --scans 0" + output).exit_code);
  EXPECT_EQ(2, evaluateRun("edges corridor:16").exit_code);
}

}  // namespace
}  // namespace edgevox
