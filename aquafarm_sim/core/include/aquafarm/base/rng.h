// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Counter-based random numbers. A draw depends only on its key (seed, episode, purpose, stream)
/// and its index in the stream. The generator is Philox4x32-10 (Salmon et al., "Parallel random
/// numbers: as easy as 1, 2, 3", SC 2011), as implemented in Random123.

#include <array>
#include <cstdint>

namespace aquafarm {

/// Purpose of a draw. Each purpose has its own streams.
enum class RngStream : std::uint8_t {
  kLayout,         ///< positions of ports, devices and rocks
  kStart,          ///< port in which a ship starts
  kDisasterSpawn,  ///< centre and heading of a disaster at the start
  kDisasterTurn,   ///< turns of a disaster
  kDamage,         ///< whether a crash damages devices
  kSensors,        ///< errors of bulletins
  kExploration,    ///< random actions
  kLearner,        ///< initial weights and random samples of a learner
  kForecast,       ///< errors of forecasts
  kStorm,          ///< storm drawn from an archive, and its perturbation
  kRanch,          ///< ranch drawn from a family
};

/// Bit that is set in every evaluation seed and clear in every training seed. Storms of an archive
/// are drawn from its evaluation years with an evaluation seed, and from its training years with a
/// training seed.
inline constexpr std::uint64_t kEvaluationSeedBit = 1ULL << 63U;
constexpr bool IsEvaluationSeed(std::uint64_t seed) { return (seed & kEvaluationSeedBit) != 0; }

/// Identifies an independent sequence of draws.
struct StreamKey {
  std::uint64_t seed{};
  std::uint64_t episode{};
  RngStream purpose{};
  std::uint32_t stream{};  ///< index, such as the id of a ship or disaster; below 2^24
};

/// Returns four 32-bit draws, which depend only on `key` and `index`.
std::array<std::uint32_t, 4> Draw(const StreamKey& key, std::uint32_t index);

/// Maps a draw to [0, 1): divides its upper 24 bits by 2^24. The result is exact.
constexpr float ToUnit(std::uint32_t draw) {
  return static_cast<float>(draw >> 8U) * (1.0F / 16777216.0F);
}
/// Maps a draw to an integer in [0, count). @param count above 0
constexpr std::uint32_t ToBelow(std::uint32_t draw, std::uint32_t count) {
  return static_cast<std::uint32_t>((static_cast<std::uint64_t>(draw) * count) >> 32U);
}

/// Generates the draws of one stream in order. A copy continues with the same draws as the
/// original.
class RandomStream {
 public:
  RandomStream() = default;
  explicit RandomStream(const StreamKey& key) : key_(key) {}

  std::uint32_t Next() {
    if (used_ == 4) {
      block_ = Draw(key_, index_++);
      used_ = 0;
    }
    return block_[used_++];
  }
  /// Returns a number that is uniform in [0, 1).
  float Unit() { return ToUnit(Next()); }
  /// Returns a number that is uniform in [min, max). Because of rounding, it may equal max.
  float Uniform(float min, float max) { return min + (max - min) * Unit(); }
  /// Returns an integer that is uniform in [0, count).
  std::uint32_t Below(std::uint32_t count) { return ToBelow(Next(), count); }

  /// Returns a number that is approximately normal with mean 0 and standard deviation 1: the scaled
  /// sum of four uniform draws. It is in [-3.47, 3.47] and bit-identical on every machine.
  double Normal() {
    constexpr double kScale = 1.7320508075688772;  // 1 / standard deviation of the sum
    double sum = -2.0;
    for (int i = 0; i < 4; ++i) sum += static_cast<double>(Unit());
    return kScale * sum;
  }

  const StreamKey& key() const { return key_; }
  /// Number of draws taken so far.
  std::uint64_t position() const { return static_cast<std::uint64_t>(index_) * 4 - (4 - used_); }
  /// Continues as if `position` draws had been taken.
  void Seek(std::uint64_t position) {
    index_ = static_cast<std::uint32_t>(position / 4);
    used_ = 4;
    for (std::uint64_t i = 0; i < position % 4; ++i) Next();
  }

 private:
  StreamKey key_{};
  std::uint32_t index_{};
  std::uint32_t used_{4};
  std::array<std::uint32_t, 4> block_{};
};

}  // namespace aquafarm
