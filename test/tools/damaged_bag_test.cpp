// SPDX-License-Identifier: BSD-3-Clause
// What is left of a damaged bag is mapped; what is not is told.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "support/random.hpp"
#include "tools/bag_reader.hpp"
#include "tools/map_bag_fixture.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;
using rosbag::compression::CompressionType;
using test::contentOf;
using test::kSweeps;
using test::simulatedRun;

/// Reads all clouds of the bag, whatever it holds; gives their number, or none.
size_t countReadable(const std::string& bag) {
  size_t count = 0;
  try {
    BagReader reader(bag, "/points");
    CheckedTransforms transforms(ros::Duration(10.0), 3600.0);
    reader.readTransforms(transforms);
    reader.forEachCloud([&](size_t, const BagReader::ReadCloud& read) {
      if (read().message) ++count;
    });
  } catch (const BagError&) {
    return 0;
  }
  return count;
}

class DamagedBagTest : public test::MapBagTest {
 protected:
  /// A chunk a cloud.
  void writeChunks(CompressionType compression, size_t clouds = kSweeps) {
    rosbag::Bag bag(options_.bag, rosbag::bagmode::Write);
    bag.setCompression(compression);
    bag.setChunkThreshold(1);
    const auto begin = simulatedRun().clouds.begin();
    test::writeClouds(bag, "/points", {begin, begin + static_cast<ptrdiff_t>(clouds)});
  }

  BagEntry entryOf(size_t cloud) const {
    BagFile file(options_.bag);
    return readBagIndex(file).entries.at(cloud);
  }

  BagRecord chunkOf(size_t cloud) const {
    BagFile file(options_.bag);
    return file.recordAt(entryOf(cloud).chunk, BagOp::kChunk);
  }

  void flip(uint64_t at, int bit) {
    std::fstream file(options_.bag, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(static_cast<std::streamoff>(at));
    const int byte = file.get();
    file.seekp(static_cast<std::streamoff>(at));
    file.put(static_cast<char>(byte ^ (1 << bit)));
  }

  /// The results are those of a run that is told to skip the cloud.
  void expectAllBut(size_t cloud) {
    const uint64_t chunk = entryOf(cloud).chunk;
    const std::string number = std::to_string(cloud);
    const YAML::Node summary = run();
    EXPECT_EQ(summary["scans"].as<int>(), kSweeps - 1);
    EXPECT_EQ(summary["clouds_left_out"]["unreadable"].as<int>(0), 1);
    EXPECT_TRUE(logged("cloud " + number + " is left out")) << log_.str();
    EXPECT_TRUE(logged("the chunk at byte " + std::to_string(chunk) + " is damaged")) << log_.str();
    EXPECT_TRUE(logged("cloud " + number + " could not be read")) << log_.str();
    EXPECT_NE(loss_.find("without 1 of 12 clouds and 0 messages"), std::string::npos) << loss_;
    MapBagOptions skipping = options_;
    skipping.output = folder_ / "skipping";
    skipping.skipped = {{cloud, cloud}};
    run(skipping);
    EXPECT_EQ(loss_, "");
    for (const char* file : {"trajectory.tum", "map_edges.ply"}) {
      EXPECT_EQ(contentOf(options_.output / file), contentOf(skipping.output / file)) << file;
    }
  }
};

TEST_F(DamagedBagTest, aFlippedByteInAPackedChunk) {
  for (const auto compression : {rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    writeChunks(compression);
    const BagRecord chunk = chunkOf(5);
    flip(chunk.data_at + chunk.data_size / 2, 3);
    expectAllBut(5);
  }
}

/// The program itself, as built beside this test.
int exitCodeOf(const std::string& arguments) {
  char self[4096] = {};
  if (readlink("/proc/self/exe", self, sizeof self - 1) < 0) return -1;
  const auto program = fs::path(self).parent_path() / "map_bag";
  return WEXITSTATUS(
      std::system((program.string() + " " + arguments + " >/dev/null 2>&1").c_str()));
}

TEST_F(DamagedBagTest, theExitCodeTellsOfCloudsThatAreMissing) {
  writeChunks(rosbag::compression::LZ4, 3);
  const std::string arguments = options_.bag + " --output " + options_.output.string();
  EXPECT_EQ(exitCodeOf(arguments), 0);
  flip(chunkOf(1).data_at + 50, 3);
  EXPECT_EQ(exitCodeOf(arguments), 3);
  EXPECT_EQ(readTum(options_.output / "trajectory.tum").size(), 2U);
  flip(chunkOf(0).data_at + 50, 3);
  flip(chunkOf(2).data_at + 50, 3);
  EXPECT_EQ(exitCodeOf(arguments), 1);
  EXPECT_EQ(readTum(options_.output / "trajectory.tum").size(), 2U);
}

TEST_F(DamagedBagTest, aFlippedByteInTheHeaderOfAMessage) {
  writeChunks(rosbag::compression::Uncompressed);
  const uint64_t message = chunkOf(7).data_at + entryOf(7).offset;
  flip(message, 6);  // of the length
  expectAllBut(7);
  flip(message, 6);
  flip(message + 4, 0);  // of the length of the first field
  expectAllBut(7);
}

TEST_F(DamagedBagTest, aFlippedByteInTheLengthsOfACloud) {
  writeChunks(rosbag::compression::Uncompressed);
  const auto bytes = simulatedRun().clouds[3].data.size();
  const BagRecord chunk = chunkOf(3);
  flip(chunk.end() - bytes - 2, 7);  // the highest byte of the size of the points
  expectAllBut(3);
}

TEST_F(DamagedBagTest, aFlippedByteInTheRecordsOfAChunk) {
  writeChunks(rosbag::compression::LZ4);
  const uint64_t index = chunkOf(4).end();
  flip(index + 4, 1);
  expectAllBut(4);
  flip(index + 4, 1);
  flip(entryOf(4).chunk + 4, 1);
  expectAllBut(4);
}

TEST_F(DamagedBagTest, transformsInADamagedChunk) {
  {
    rosbag::Bag bag(options_.bag, rosbag::bagmode::Write);
    bag.setCompression(rosbag::compression::BZ2);
    bag.setChunkThreshold(1);
    const ros::Time start = simulatedRun().clouds.front().header.stamp;
    for (const char* child : {"camera", "lidar"}) {
      test::writeTransform(bag, "/tf_static", start,
                           test::transformOf("base_link", child, start, Pose::Identity()));
    }
    test::writeClouds(bag, "/points", simulatedRun().clouds);
  }
  options_.frames.base = "base_link";
  BagFile file(options_.bag);
  const BagIndex index = readBagIndex(file);
  std::vector<uint64_t> chunks;
  for (const BagEntry& entry : index.entries) {
    if (index.connections.at(entry.connection).topic == "/tf_static") chunks.push_back(entry.chunk);
  }
  ASSERT_EQ(chunks.size(), 2U);
  const auto middle = [&](uint64_t chunk) {
    const BagRecord record = file.recordAt(chunk, BagOp::kChunk);
    return record.data_at + record.data_size / 2;
  };
  flip(middle(chunks[0]), 2);
  EXPECT_EQ(run()["tracked"].as<int>(), kSweeps);
  EXPECT_TRUE(logged("1 messages of transforms could not be read")) << log_.str();
  EXPECT_NE(loss_.find("without 0 of 12 clouds and 1 messages"), std::string::npos) << loss_;
  flip(middle(chunks[1]), 2);
  expectError<BagError>({"no_mounting 12"});
  EXPECT_TRUE(logged("1 messages of transforms could not be read")) << log_.str();
}

TEST_F(DamagedBagTest, aDamagedIndexIsToldWithItsByte) {
  writeChunks(rosbag::compression::LZ4);
  const BagRecord last = chunkOf(kSweeps - 1);
  BagFile file(options_.bag);
  const uint64_t index = file.recordAt(last.end(), BagOp::kIndex).end();
  flip(index + 4, 1);
  expectError<BagError>({"the record at byte " + std::to_string(index), "rosbag reindex"});
  flip(index + 4, 1);
  EXPECT_EQ(countReadable(options_.bag), size_t{kSweeps});
  const std::string count = "chunk_count=";
  flip(contentOf(options_.bag).find(count) + count.size(), 2);
  expectError<BagError>({"more chunks", "rosbag reindex"});
  fs::resize_file(options_.bag, index);
  expectError<BagError>({options_.bag, "the file ends too early", "rosbag reindex"});
}

TEST_F(DamagedBagTest, anyByteMayBeWrong) {
  constexpr size_t kClouds = 2;
  test::Random random(3);
  std::set<size_t> counts;
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    writeChunks(compression, kClouds);
    const uint64_t size = fs::file_size(options_.bag);
    const uint64_t index = chunkOf(kClouds - 1).end();
    for (int i = 0; i < 40; ++i) {
      // Half of them in the index at the end, half anywhere.
      const double from = i % 2 == 0 ? static_cast<double>(index) : 0.0;
      const auto at = static_cast<uint64_t>(random.uniform(from, static_cast<double>(size)));
      flip(at, i % 8);
      counts.insert(countReadable(options_.bag));
      flip(at, i % 8);
    }
    EXPECT_EQ(countReadable(options_.bag), kClouds);
  }
  EXPECT_EQ(counts, (std::set<size_t>{0, kClouds - 1, kClouds}));
}

}  // namespace
}  // namespace edgevox
