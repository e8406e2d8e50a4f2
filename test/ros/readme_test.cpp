// SPDX-License-Identifier: BSD-3-Clause
// The tables of the README tell what the code does.
#include <gtest/gtest.h>
#include <ros/init.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <algorithm>

#include "ros/launch_graph.hpp"
#include "ros/launch_process.hpp"
#include "ros/live/parameters.hpp"
#include "ros/readme_table.hpp"
#include "support/temp_folder.hpp"
#include "tools/map_bag_fixture.hpp"

namespace edgevox::test {
namespace {

const std::string kFolder = EDGEVOX_SOURCE_DIR;
const std::string kSpace = "/edgevox/";

std::vector<Row> tableOf(const std::string& heading) {
  return tableBelow(heading, contentOf(kFolder + "/README.md"));
}

std::string code(const std::string& name) { return "`" + name + "`"; }

/// In any order; a row that differs is shown as it should be.
void expectSameRows(std::vector<Row> readme, std::vector<Row> expected) {
  ASSERT_FALSE(readme.empty()) << "there is no such table";
  std::sort(readme.begin(), readme.end());
  std::sort(expected.begin(), expected.end());
  std::string actual_text, expected_text;
  for (const Row& row : readme) actual_text += lineOf(row);
  for (const Row& row : expected) expected_text += lineOf(row);
  EXPECT_EQ(actual_text, expected_text);
}

/// The first `count` columns.
std::vector<Row> columns(std::vector<Row> rows, size_t count) {
  for (Row& row : rows) row.resize(count);
  return rows;
}

std::string rangeOf(const Parameter& p) {
  if (const auto* choice = std::get_if<Choice>(&p.value)) {
    std::string words;
    for (const std::string& word : choice->words) words += (words.empty() ? "" : ", ") + word;
    return words;
  }
  if (std::holds_alternative<bool*>(p.value)) return "true, false";
  if (std::holds_alternative<std::string*>(p.value)) return "";
  std::ostringstream range;
  range << p.min << " to " << p.max << (p.unit.empty() ? "" : " " + p.unit);
  return range.str();
}

TEST(Readme, parameters) {
  MapperParameters defaults;
  LocalizerParameters localizer;
  std::vector<Parameter> parameters = nodeParametersOf(defaults);
  for (const Parameter& p : nodeParametersOf(localizer)) {
    const bool known = std::any_of(parameters.begin(), parameters.end(),
                                   [&](const Parameter& other) { return other.name == p.name; });
    if (!known) parameters.push_back(p);
  }
  for (const Parameter& p : parametersOf(defaults.config)) parameters.push_back(p);
  std::vector<Row> expected;
  for (const Parameter& p : parameters) {
    expected.push_back({code(p.name), valueText(p), rangeOf(p), p.meaning});
  }
  expectSameRows(tableOf("Parameters"), expected);
}

/// Name, default and meaning of each argument.
std::vector<Row> argumentsOf(const std::string& launch_file) {
  boost::property_tree::ptree file;
  boost::property_tree::read_xml(kFolder + "/launch/" + launch_file, file);
  std::vector<Row> rows;
  for (const auto& [tag, element] : file.get_child("launch")) {
    if (tag != "arg" || element.count("<xmlattr>") == 0) continue;
    const auto attribute = [&attributes = element.get_child("<xmlattr>")](const char* name) {
      return attributes.get<std::string>(name, "");
    };
    if (!attribute("value").empty()) continue;
    rows.push_back({code(attribute("name")), attribute("default"), attribute("doc")});
  }
  return rows;
}

TEST(Readme, launchArguments) {
  const std::vector<Row> readme = tableOf("Launch arguments");
  std::vector<Row> expected = argumentsOf("mapping.launch");
  for (Row& row : expected) {
    // A default that is computed is told in words.
    const auto told = std::find_if(readme.begin(), readme.end(),
                                   [&](const Row& r) { return r.front() == row.front(); });
    if (row[1].front() == '$' && told != readme.end()) row[1] = told->at(1);
  }
  expectSameRows(readme, expected);
}

TEST(Readme, localizationTakesTheArgumentsOfMapping) {
  std::vector<Row> expected = argumentsOf("mapping.launch");
  const auto other = [](const Row& row) { return row[0] == "`output`" || row[0] == "`localize`"; };
  expected.erase(std::remove_if(expected.begin(), expected.end(), other), expected.end());
  expectSameRows(columns(argumentsOf("localization.launch"), 2), columns(expected, 2));
}

/// What the four nodelets use.
class ReadmeOfNodelets : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(waitFor([] { return isMapping("/edgevox"); }));
    ASSERT_TRUE(waitFor([this] {  // the last that each of them advertises
      graph_ = readGraph();
      return nodeletsIn(graph_.publishers["/diagnostics"]) == "all";
    }));
  }

  static std::string relative(const std::string& name) {
    return name.compare(0, kSpace.size(), kSpace) == 0 ? name.substr(kSpace.size()) : name;
  }

  /// The nodelets among the nodes, or "all" of them.
  static std::string nodeletsIn(const std::set<std::string>& nodes) {
    std::string names;
    int count = 0;
    for (const char* name : {"voxelizer", "edge_extractor", "mapper", "localizer"}) {
      if (nodes.count(kSpace + name) == 0) continue;
      names += (names.empty() ? "" : ", ") + std::string(name);
      ++count;
    }
    return count == 4 ? "all" : names;
  }

  Graph graph_;
};

/// Of every node.
bool isOfRoscpp(const std::string& name) {
  return name == "/rosout" || name == "/clock" || name.find("_logger") != std::string::npos;
}

TEST_F(ReadmeOfNodelets, topics) {
  const std::map<std::string, std::string> types = readTypes();
  std::vector<Row> expected;
  const auto add = [&](const std::string& topic, const std::string& by) {
    expected.push_back({code(relative(topic)), types.at(topic), by});
  };
  for (const auto& [topic, nodes] : graph_.publishers) {
    if (const std::string by = nodeletsIn(nodes); !by.empty() && !isOfRoscpp(topic)) add(topic, by);
  }
  for (const auto& [topic, nodes] : graph_.subscribers) {
    const std::string by = nodeletsIn(nodes);
    if (by.empty() || graph_.isPublished(topic) || isOfRoscpp(topic)) continue;
    add(topic, "into " + by);
  }
  expectSameRows(columns(tableOf("Topics"), 3), expected);
}

std::string typeOfService(const std::string& service) {
  const TempFolder folder;
  Process ask({"rosservice", "type", service}, folder.path(), folder / "type");
  EXPECT_TRUE(ask.waitForEnd(20));
  const std::string type = contentOf(folder / "type");
  return type.substr(0, type.find('\n'));
}

TEST_F(ReadmeOfNodelets, services) {
  std::vector<Row> expected;
  for (const auto& [service, nodes] : graph_.services) {
    if (nodeletsIn(nodes).empty() || isOfRoscpp(service)) continue;
    expected.push_back({code(relative(service)), typeOfService(service)});
  }
  expectSameRows(columns(tableOf("Services"), 2), expected);
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "readme_test");
  const ros::NodeHandle connected;
  return RUN_ALL_TESTS();
}
