// SPDX-License-Identifier: BSD-3-Clause
#include "run/report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "tools/console.hpp"

namespace edgevox {
namespace {

Report makeReport() {
  Report group;
  group.add("match", 1.5);
  Report report;
  report.add("scans", uint64_t{90});
  report.add("ms", group);
  report.add("rate", std::numeric_limits<double>::quiet_NaN());
  report.add("text", std::string("a \"b\" \\ \n"));
  report.add("none", Report());
  return report;
}

TEST(Report, json) {
  EXPECT_EQ(makeReport().json(),
            "{\n  \"scans\": 90,\n  \"ms\": {\n    \"match\": 1.5\n  },\n  \"rate\": null,\n"
            "  \"text\": \"a \\\"b\\\" \\\\ \\u000a\",\n  \"none\": {}\n}\n");
  EXPECT_EQ(Report().json(), "{}\n");
}

TEST(Report, tableLeavesOutWhatIsNotKnown) {
  const std::string table = makeReport().table();
  EXPECT_NE(table.find("  scans                       90\n"), std::string::npos) << table;
  EXPECT_NE(table.find("  ms/match                    1.5\n"), std::string::npos) << table;
  EXPECT_EQ(table.find("rate"), std::string::npos);
}

TEST(Console, sparseLinesWithoutTerminal) {
  std::ostringstream out;
  Console console(out, false);
  for (size_t i = 1; i <= 1000; ++i) console.showProgress(i, 1000);
  const std::string text = out.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
  EXPECT_NE(text.find("1000 of 1000 clouds\n"), std::string::npos);
  EXPECT_EQ(text.find('\r'), std::string::npos);
}

TEST(Console, messagesDoNotMixWithTheBar) {
  std::ostringstream out;
  Console console(out, true);
  console.showProgress(1, 4);
  console.print("note");
  EXPECT_EQ(out.str(), "\r[##########                              ] 1 of 4 clouds\r\033[Knote\n");
}

}  // namespace
}  // namespace edgevox
