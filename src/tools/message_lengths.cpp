// SPDX-License-Identifier: BSD-3-Clause
#include "tools/message_lengths.hpp"

#include "tools/bag_file.hpp"

namespace edgevox {
namespace {

/// Walks over a message; stays at its end once that has been reached too early.
class Walk {
 public:
  Walk(const uint8_t* bytes, size_t size) : bytes_(bytes), left_(size) {}

  void skip(size_t count) {
    good_ = good_ && count <= left_;
    if (!good_) return;
    bytes_ += count;
    left_ -= count;
  }
  uint32_t length() {
    if (!good_ || left_ < sizeof(uint32_t)) {
      good_ = false;
      return 0;
    }
    const auto length = numberAt<uint32_t>(bytes_);
    skip(sizeof length);
    return length;
  }
  void skipText() { skip(length()); }
  void skipHeader() {
    skip(4 + 8);  // number and stamp
    skipText();
  }
  bool good() const { return good_; }
  bool isAtEnd() const { return good_ && left_ == 0; }

 private:
  const uint8_t* bytes_;
  size_t left_;
  bool good_ = true;
};

}  // namespace

bool isCloudOfSize(const uint8_t* bytes, size_t size) {
  Walk walk(bytes, size);
  walk.skipHeader();
  walk.skip(4 + 4);  // height and width
  const uint32_t fields = walk.length();
  for (uint32_t i = 0; i < fields && walk.good(); ++i) {
    walk.skipText();
    walk.skip(4 + 1 + 4);  // offset, type, count
  }
  walk.skip(1 + 4 + 4);  // byte order and steps
  walk.skipText();       // the points
  walk.skip(1);
  return walk.isAtEnd();
}

bool isTransformsOfSize(const uint8_t* bytes, size_t size) {
  Walk walk(bytes, size);
  const uint32_t transforms = walk.length();
  for (uint32_t i = 0; i < transforms && walk.good(); ++i) {
    walk.skipHeader();
    walk.skipText();
    walk.skip(7 * sizeof(double));
  }
  return walk.isAtEnd();
}

}  // namespace edgevox
