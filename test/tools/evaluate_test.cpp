// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "map_bag_fixture.hpp"

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
  std::filesystem::remove(options_.output / "errors.csv");

  const Outcome outcome =
      evaluateRun("run " + options_.output.string() + " --reference " + options_.reference);
  ASSERT_EQ(0, outcome.exit_code) << outcome.output;
  const YAML::Node printed = YAML::Load(outcome.output);
  EXPECT_GT(printed.size(), 5U);
  for (const auto& value : printed) {
    const auto name = value.first.as<std::string>();
    EXPECT_EQ(summary[name].as<std::string>(), value.second.as<std::string>()) << name;
  }
  EXPECT_EQ(errors, contentOf(options_.output / "errors.csv"));
}

TEST_F(EvaluateTest, saysWhatIsMissing) {
  const Outcome missing = evaluateRun("run " + folder_.path().string() + " --reference /none.tum");
  EXPECT_EQ(1, missing.exit_code);
  EXPECT_NE(std::string::npos, missing.output.find("trajectory.tum")) << missing.output;
  const Outcome unknown = evaluateRun("maps x --reference y");
  EXPECT_EQ(2, unknown.exit_code);
  EXPECT_NE(std::string::npos, unknown.output.find("'maps' is not known")) << unknown.output;
}

}  // namespace
}  // namespace edgevox
