// SPDX-License-Identifier: BSD-3-Clause
#include "tools/options.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "edgevox/parameter.hpp"

namespace edgevox {
namespace {

namespace po = boost::program_options;

po::options_description known() {
  po::options_description known = withHelp("Usage: try INPUT\nOptions");
  auto add = known.add_options();
  add("input", po::value<std::string>()->required(), "what to try");
  add("count", po::value<int64_t>()->default_value(3), "how often");
  add("size", po::value<double>(), "how large");
  add("set", po::value<std::vector<std::string>>()->multitoken(), "how");
  return known;
}

std::optional<po::variables_map> parse(const Arguments& arguments) {
  return parseOptions(arguments, known(), "input");
}

void expectUsageError(const Arguments& arguments, const std::string& words) {
  try {
    parse(arguments);
    ADD_FAILURE() << "no error; expected " << words;
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(Options, AreGivenByName) {
  const auto given = parse({"a", "--count", "5", "--size", "0.5", "--set", "b=1", "c=2"});
  ASSERT_TRUE(given);
  EXPECT_EQ("a", textOf(*given, "input"));
  EXPECT_EQ(5U, countOf(*given, "count", 5));
  EXPECT_EQ(0.5, numberOf(*given, "size"));
  EXPECT_EQ((std::vector<std::string>{"b=1", "c=2"}), textsOf(*given, "set"));
  EXPECT_THROW(countOf(*given, "count", 6), UsageError);
}

TEST(Options, NotGivenAreEmptyOrTheirDefault) {
  const auto given = parse({"--input", "a"});
  ASSERT_TRUE(given);
  EXPECT_EQ(3U, countOf(*given, "count", 1));
  EXPECT_FALSE(numberOf(*given, "size"));
  EXPECT_TRUE(textsOf(*given, "set").empty());
}

TEST(Options, WrongOnesAreUsageErrors) {
  expectUsageError({}, "--input");
  expectUsageError({"a", "b"}, "positional");
  expectUsageError({"a", "--coun", "5"}, "coun");
  expectUsageError({"a", "--count", "x"}, "'x'");
  EXPECT_THROW(parseOptions({"a"}, known()), UsageError);
}

TEST(Options, HelpIsPrintedInsteadOfAnErrorForWhatIsMissing) {
  ::testing::internal::CaptureStdout();
  EXPECT_FALSE(parse({"--help"}));
  const std::string help = ::testing::internal::GetCapturedStdout();
  EXPECT_EQ(0U, help.find("Usage: try INPUT\nOptions:\n  -h [ --help ]")) << help;
}

int exitCodeOf(const std::function<int(const Arguments&)>& tool, std::string& said) {
  const char* const argv[] = {"/bin/try", "first", "second"};
  ::testing::internal::CaptureStderr();
  const int code = runTool("try", 3, argv, tool);
  said = ::testing::internal::GetCapturedStderr();
  return code;
}

TEST(RunTool, GivesTheArgumentsAndTheExitCode) {
  std::string said;
  EXPECT_EQ(3, exitCodeOf(
                   [](const Arguments& arguments) {
                     EXPECT_EQ((Arguments{"first", "second"}), arguments);
                     return 3;
                   },
                   said));
  EXPECT_EQ("", said);
}

TEST(RunTool, TellsWrongUsageFromOtherFailures) {
  std::string said;
  EXPECT_EQ(2, exitCodeOf([](const Arguments&) -> int { throw UsageError("no"); }, said));
  EXPECT_EQ("try: no; see try --help\n", said);
  EXPECT_EQ(2, exitCodeOf([](const Arguments&) -> int { throw ConfigError("no"); }, said));
  EXPECT_EQ(1, exitCodeOf([](const Arguments&) -> int { throw std::runtime_error("no"); }, said));
  EXPECT_EQ("try: no\n", said);
}

}  // namespace
}  // namespace edgevox
