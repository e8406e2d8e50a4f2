// SPDX-License-Identifier: BSD-3-Clause
// A map that has just begun, and scans that do not fit it.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "edgevox/archive.hpp"
#include "edgevox/mapping/mapper.hpp"
#include "support/sweeps.hpp"

namespace edgevox::test {
namespace {

constexpr size_t kCount = 20;

/// As by a covered lens, at the time of scan i.
VoxelScan noise(size_t i) {
  constexpr int kPoints = 4000;
  const Sweep sweep = randomSweep(static_cast<uint32_t>(i), buildingScans()[i].stamp, kPoints);
  return voxelScans({sweep}, Config{})[0];
}

/// What becomes of the scans; those with an x in `bad` are noise.
std::vector<ScanResult> mapped(Mapper& mapper, const std::string& bad, size_t from = 0) {
  std::vector<ScanResult> results;
  for (size_t i = from; i < kCount; ++i) {
    const bool is_bad = i - from < bad.size() && bad[i - from] == 'x';
    results.push_back(mapper.process(is_bad ? noise(i) : buildingScans()[i]));
  }
  return results;
}

/// A letter a scan: its status, in capitals if the map was begun anew with it.
std::string lettersOf(const std::vector<ScanResult>& results) {
  std::string letters;
  for (const ScanResult& result : results) {
    const char letter = result.located() ? toString(result.status)[0] : '-';
    letters += result.begun_anew ? 'F' : (letter == 't' || letter == 'f' ? 't' : letter);
  }
  return letters;
}

/// The map holds the good scans from `begin` on, and nothing else, each where it was taken.
void expectMapFrom(size_t begin, const Mapper& mapper, const std::vector<ScanResult>& results) {
  Mapper expected{Config{}};
  for (size_t i = begin; i < kCount; ++i) {
    const ScanResult result = expected.process(buildingScans()[i]);
    EXPECT_TRUE(results[i].located()) << i;
    EXPECT_TRUE(sameBits(result.T_map_sensor, results[i].T_map_sensor)) << i;
  }
  EXPECT_EQ(expected.map().scans(), mapper.map().scans());
  EXPECT_EQ(expected.map().hitVoxelCount(), mapper.map().hitVoxelCount());
}

TEST(YoungMap, OfNoiseIsBegunAnew) {
  Mapper mapper{Config{}};
  const auto results = mapped(mapper, "x");
  EXPECT_EQ("t-Fttttttttttttttttt", lettersOf(results));
  expectMapFrom(2, mapper, results);
}

TEST(YoungMap, OfManyNoisyScansIsBegunAnewUntilTheyEnd) {
  for (size_t bad = 2; bad < 8; ++bad) {
    Mapper mapper{Config{}};
    const auto results = mapped(mapper, std::string(bad, 'x'));
    const std::string letters = lettersOf(results);
    const size_t begin = letters.rfind('F');
    ASSERT_NE(std::string::npos, begin) << letters;
    EXPECT_LE(begin, bad + 1) << letters;
    EXPECT_GE(begin, bad) << letters;
    expectMapFrom(begin, mapper, results);
  }
}

TEST(YoungMap, ThatIsGoodSurvivesAsManyBadScansAsItIsMadeOf) {
  Mapper one{Config{}};
  EXPECT_EQ("t-tttttttttttttttttt", lettersOf(mapped(one, ".x")));
  Mapper two{Config{}};
  EXPECT_EQ("tt--tttttttttttttttt", lettersOf(mapped(two, "..xx")));
}

TEST(YoungMap, ThatIsLostToNoiseComesBack) {
  Mapper mapper{Config{}};
  const auto results = mapped(mapper, ".xxx");
  EXPECT_EQ("t-F-Fttttttttttttttt", lettersOf(results));
  expectMapFrom(4, mapper, results);
}

TEST(YoungMap, ThatTwoScansHaveConfirmedIsKept) {
  Mapper mapper{Config{}};
  EXPECT_EQ("ttt-------tttttttttt", lettersOf(mapped(mapper, "...xxxxxxx")));
}

TEST(YoungMap, FromAFileIsKept) {
  Mapper first{Config{}};
  first.process(buildingScans()[0]);
  ArchiveWriter writer;
  writer(first);
  Mapper mapper{Config{}};
  ArchiveReader reader(writer.bytes());
  reader(mapper);
  EXPECT_EQ("----ttttttttttttttt", lettersOf(mapped(mapper, "xxxx", 1)));
  mapper.reset();
  EXPECT_EQ("t-Fttttttttttttttttt", lettersOf(mapped(mapper, "x")));
}

TEST(YoungMap, IsBegunAnewWhereThePriorSays) {
  Mapper mapper{Config{}};
  Pose T_odom_walk(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
  T_odom_walk.translation() = Eigen::Vector3d(7, -3, 1);
  for (size_t i = 0; i < kCount; ++i) {
    ScanPrior prior;
    prior.T_odom_sensor = prior.T_map_first = T_odom_walk * buildingWalk().truth[i].pose;
    const ScanResult result = mapper.process(i == 0 ? noise(i) : buildingScans()[i], prior);
    EXPECT_EQ(i == 2, result.begun_anew);
    if (i < 2) continue;
    EXPECT_LT(differenceOf(prior.T_map_first, result.T_map_sensor).metres, 0.05) << i;
  }
}

TEST(YoungMap, IsNotJudgedByScansOfAFewVoxels) {
  Mapper mapper{Config{}};
  mapper.process(buildingScans()[0]);
  for (size_t i = 1; i < 8; ++i) {
    VoxelScan few = buildingScans()[i];
    few.voxels.resize(20);
    EXPECT_EQ(ScanStatus::kTooFew, mapper.process(few).status);
  }
  EXPECT_EQ(1U, mapper.map().scans());
  EXPECT_TRUE(mapper.process(buildingScans()[8]).located());
}

}  // namespace
}  // namespace edgevox::test
