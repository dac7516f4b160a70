// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Many farms of one scenario, stepped together, observations written straight into the caller's
/// memory. A farm whose episode is over ignores the action of the next Step and starts its next
/// episode instead (next-step auto-reset, as in Gymnasium 1.x): no final observation is lost and
/// one call a step is enough.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/farm/farm.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/observation/encoder.h"

namespace aquafarm {

/// Where a step's results go; N farms × S agents, row-major. A null pointer is skipped.
struct BatchOutput {
  float* rewards{};          ///< [N, S]
  float* terms{};            ///< [N, S, kRewardTermCount]
  std::uint8_t* outcomes{};  ///< [N, S] Outcome
  ActionMask* legal{};       ///< [N, S] legal actions of the next step
  std::uint8_t* in_play{};   ///< [N, S] 0: a delivered self-propelled device, whose agent is done
  std::uint8_t* reasons{};   ///< [N] EndReason; kNone while the episode goes on
  std::uint8_t* started{};   ///< [N] 1: this entry is an episode's first observation, no step
  std::uint64_t* hashes{};   ///< [N] state hash
  std::uint32_t* index{};    ///< [N, S] tabular index
  float* features{};         ///< [N, S, F]
  std::uint8_t* planes{};    ///< [N, S, P, H, W]
};

/// N farms of one scenario, each at its own episode; not for several callers at once.
class FarmBatch {
 public:
  /// Farm i of N plays episodes i, i + N, i + 2N, … of a seed.
  /// @param threads used to step; results do not depend on it
  /// @throws InputError when the layout cannot be drawn
  FarmBatch(std::shared_ptr<const Scenario> scenario, std::int32_t farms, std::int32_t threads = 1);

  /// Starts the sequence `seed` in all farms, farm i at episode first_episode + i, and writes the
  /// first observations.
  /// @throws InputError when an episode's layout cannot be drawn; Reset to another then
  void Reset(std::uint64_t seed, std::uint64_t first_episode, const BatchOutput& output);

  /// Steps every farm. @param actions [N, S], each in [0, kActionCount] (kHold allowed)
  /// @throws InputError when an episode's layout cannot be drawn; the other farms have stepped then
  void Step(const std::uint8_t* actions, const BatchOutput& output);

  /// Writes the present state's results again without stepping (after Load).
  void Write(const BatchOutput& output);

  /// N of BatchOutput.
  std::int32_t farms() const { return static_cast<std::int32_t>(farms_.size()); }
  /// S of BatchOutput: ships and self-propelled devices of one farm.
  std::int32_t agents() const { return agents_; }
  const Scenario& scenario() const { return *scenario_; }
  /// What writes the index, the features and the planes.
  const Encoder& encoder() const { return encoder_; }
  /// @param i [0, farms())
  const Farm& farm(std::int32_t i) const { return farms_[static_cast<std::size_t>(i)]; }
  /// For what is done to one farm: SetDisaster, Load, single steps.
  Farm& farm(std::int32_t i) { return farms_[static_cast<std::size_t>(i)]; }

  /// Starts farm i's next episode.
  /// @throws InputError when its layout cannot be drawn
  void StartNext(std::int32_t i);

  /// All farms as bytes; Load continues them bit for bit.
  std::string Save() const;
  /// Continues farms that Save wrote.
  /// @throws InputError when the bytes are damaged, of another version, scenario or number of
  /// farms;
  ///         nothing has changed then
  void Load(const std::string& bytes);

 private:
  void StepOne(std::int32_t i, std::int32_t thread, const std::uint8_t* actions,
               const BatchOutput& output);
  void WriteOne(std::int32_t i, std::int32_t thread, bool started, const BatchOutput& output);

  std::shared_ptr<const Scenario> scenario_;
  std::vector<Farm> farms_;
  Encoder encoder_;
  std::vector<View> views_;  // one per thread
  std::int32_t agents_{};
  std::int32_t threads_{};
};

}  // namespace aquafarm
