// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace edgevox::sim {

/// One step of splitmix64: a bijection of 64-bit words whose outputs look independent.
inline std::uint64_t mix(std::uint64_t word) {
  word += 0x9e3779b97f4a7c15ULL;
  word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9ULL;
  word = (word ^ (word >> 27)) * 0x94d049bb133111ebULL;
  return word ^ (word >> 31);
}

/// A seeded stream of numbers in integer arithmetic: the same on every compiler and library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(mix(seed)) {}

  /// A stream of its own for each (seed, stream) pair.
  Random(std::uint64_t seed, std::uint64_t stream) : state_(mix(mix(seed) ^ stream)) {}

  std::uint64_t next() { return mix(state_++); }

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Mean 0, standard deviation 1, bounded by +-6: the sum of twelve 16-bit uniforms.
  double normal() {
    std::int64_t sum = 0;
    for (int word = 0; word < 3; ++word) {
      const std::uint64_t bits = next();
      for (int shift = 0; shift < 64; shift += 16) {
        sum += static_cast<std::int64_t>((bits >> shift) & 0xffff);
      }
    }
    return (static_cast<double>(sum) + 6.0) / 65536.0 - 6.0;
  }

 private:
  std::uint64_t state_;
};

}  // namespace edgevox::sim
