// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace edgevox {
namespace {

Table twoRows() {
  Table table({{"voxel", "voxel [m]"}, {"name", "of"}, {"share", "share", 3}, {"unused", "none"}});
  table.addRow();
  table.set("voxel", 0.05);
  table.set("name", "scan");
  table.set("share", 0.123456789);
  table.addRow();
  table.set("voxel", 0.1);
  table.set("share", std::nan(""));
  return table;
}

TEST(Table, CsvKeepsWhatMarkdownRounds) {
  EXPECT_EQ(twoRows().csv(), "voxel,name,share,unused\n0.05,scan,0.123457,\n0.1,,,\n");
}

TEST(Table, MarkdownLeavesOutEmptyColumnsAndRows) {
  EXPECT_EQ(twoRows().markdown({"voxel", "unused", "share"}, 1),
            "| voxel [m] | share |\n| --- | --- |\n| 0.05 | 0.123 |\n");
  Table table = twoRows();
  table.set("unused", 7.0);
  EXPECT_EQ(table.markdown({"voxel", "unused", "share"}, 1),
            "| voxel [m] | none | share |\n| --- | --- | --- |\n| 0.05 | - | 0.123 |\n"
            "| 0.10 | 7.00 | - |\n");
}

TEST(Table, NothingButKeysIsNoTable) { EXPECT_EQ(twoRows().markdown({"voxel", "unused"}, 1), ""); }

TEST(Table, TextThatWouldBreakTheFormatsIsAnError) {
  Table table = twoRows();
  EXPECT_THROW(table.set("name", "a, b"), std::invalid_argument);
  EXPECT_THROW(table.set("name", "a | b"), std::invalid_argument);
}

TEST(Table, UnknownColumnIsAnError) {
  Table table = twoRows();
  EXPECT_THROW(table.set("shares", 1.0), std::out_of_range);
  EXPECT_THROW(table.markdown({"shares"}, 0), std::out_of_range);
}

}  // namespace
}  // namespace edgevox
