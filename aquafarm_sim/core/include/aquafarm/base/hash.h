// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

namespace aquafarm {

/// Mixes 64-bit words into a hash with the finaliser of SplitMix64 (Steele, Lea and Flood, "Fast
/// splittable pseudorandom number generators", OOPSLA 2014). It is not a cryptographic hash.
class Hasher {
 public:
  /// Adds one word.
  void Add(std::uint64_t word) {
    std::uint64_t z = (hash_ ^ word) + 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    hash_ = z ^ (z >> 31U);
  }
  /// Adds two numbers as one word.
  void Add(std::int32_t a, std::int32_t b) {
    Add((static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32U) |
        static_cast<std::uint32_t>(b));
  }
  /// Adds the bit patterns of two numbers as one word.
  void Add(float a, float b) { Add(BitsOf(a), BitsOf(b)); }
  std::uint64_t value() const { return hash_; }

 private:
  static std::int32_t BitsOf(float value) {
    std::int32_t bits;
    std::memcpy(&bits, &value, sizeof(bits));
    return bits;
  }
  std::uint64_t hash_{};
};

/// Returns a checksum of bytes. The result is the same on every machine.
std::uint64_t HashBytes(std::string_view bytes);

/// Returns the checksum of the concatenated parts without copying them.
std::uint64_t HashBytes(const std::vector<std::string_view>& parts);

}  // namespace aquafarm
