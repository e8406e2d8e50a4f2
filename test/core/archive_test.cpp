// SPDX-License-Identifier: BSD-3-Clause
#include "edgevox/archive.hpp"

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/compression.hpp"

namespace edgevox::test {
namespace {

enum class Colour : uint8_t { kRed = 1, kBlue = 2 };

struct Inner {
  int32_t number = 0;
  std::optional<double> maybe;

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.number, self.maybe);
  }
};

struct Outer {
  std::string text;
  std::vector<Inner> inner;
  std::deque<uint16_t> words;
  std::array<float, 3> floats{};
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  Colour colour = Colour::kRed;
  bool flag = false;

  template <typename Self, typename Archive>
  static void archive(Self& self, Archive& bytes) {
    bytes(self.text, self.inner, self.words, self.floats, self.vector, self.colour, self.flag);
  }
};

Outer example() {
  Outer outer;
  outer.text = std::string("a\0b", 3);
  outer.inner = {{-7, std::nullopt}, {1 << 30, 0.1}};
  outer.words = {1, 65535};
  outer.floats = {-0.0F, std::numeric_limits<float>::infinity(), 1e-40F};
  outer.vector = {1, -2, 3};
  outer.colour = Colour::kBlue;
  outer.flag = true;
  return outer;
}

std::string bytesOf(const Outer& outer) {
  ArchiveWriter writer;
  writer(outer);
  return writer.take();
}

TEST(Archive, GivesBackWhatWasWritten) {
  const std::string bytes = bytesOf(example());
  Outer read;
  ArchiveReader reader(bytes);
  reader(read);
  EXPECT_NO_THROW(reader.requireEnd());
  EXPECT_EQ(bytes, bytesOf(read));
  EXPECT_EQ(example().text, read.text);
  ASSERT_EQ(2U, read.inner.size());
  EXPECT_FALSE(read.inner[0].maybe);
  EXPECT_DOUBLE_EQ(0.1, *read.inner[1].maybe);
  EXPECT_EQ(Colour::kBlue, read.colour);
}

TEST(Archive, IsLittleEndian) {
  ArchiveWriter writer;
  writer(uint32_t{0x01020304}, int16_t{-2}, 1.0);
  EXPECT_EQ(std::string("\x04\x03\x02\x01\xfe\xff\0\0\0\0\0\0\xf0\x3f", 14), writer.bytes());
}

TEST(Archive, EveryCutIsNoticed) {
  const std::string bytes = bytesOf(example());
  for (size_t size = 0; size < bytes.size(); ++size) {
    const std::string cut = bytes.substr(0, size);
    ArchiveReader reader(cut);
    Outer read;
    EXPECT_THROW(reader(read), ArchiveError) << size;
  }
  const std::string longer = bytes + 'x';
  ArchiveReader reader(longer);
  Outer read;
  reader(read);
  EXPECT_THROW(reader.requireEnd(), ArchiveError);
}

TEST(Archive, AHugeCountTakesNoMemory) {
  ArchiveWriter writer;
  writer(std::numeric_limits<uint64_t>::max());
  ArchiveReader reader(writer.bytes());
  std::vector<double> values;
  EXPECT_THROW(reader(values), ArchiveError);
}

TEST(Compression, GivesBackTheBytesAndRefusesOthers) {
  std::string bytes;
  for (int i = 0; i < 5000; ++i) bytes += static_cast<char>(i * i % 251);
  const std::string frame = compressed(bytes);
  EXPECT_LT(frame.size(), bytes.size());
  EXPECT_EQ(bytes, decompressed(frame));
  EXPECT_EQ("", decompressed(compressed("")));
  EXPECT_THROW(decompressed(frame.substr(0, frame.size() / 2)), ArchiveError);
  EXPECT_THROW(decompressed(""), ArchiveError);
  EXPECT_THROW(decompressed("no frame at all"), ArchiveError);
}

}  // namespace
}  // namespace edgevox::test
