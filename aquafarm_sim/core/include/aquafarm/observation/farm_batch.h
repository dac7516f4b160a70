// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Many farms of one scenario, stepped together. Observations are written directly to the caller's
/// memory. If the episode of a farm has ended, the next Step ignores the actions for that farm and
/// starts its next episode (next-step auto-reset, as in Gymnasium 1.x). With one call per step, the
/// caller therefore also receives the final observation of each episode.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/farm/farm.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/grid/step_fields.h"
#include "aquafarm/observation/encoder.h"

namespace aquafarm {

/// Destination buffers of a step's results (step_fields.h); N farms × S agents, row-major. Null
/// pointers are skipped.
struct BatchOutput {
  float* rewards{};             ///< [N, S]
  float* terms{};               ///< [N, S, kRewardTermCount]
  float* energy{};              ///< [N, S] consumed in the step [kWh]
  float* distance{};            ///< [N, S] travelled in the step [km]
  std::uint8_t* outcomes{};     ///< [N, S] Outcome
  ActionMask* legal{};          ///< [N, S] legal actions of the next step
  std::uint8_t* active{};       ///< [N, S] 0: a self-propelled device that is delivered; else 1
  std::uint8_t* end_reasons{};  ///< [N] EndReason; kNone while the episode runs
  std::uint8_t* is_first{};     ///< [N] 1 for the first observation of an episode, before any step
  std::uint64_t* hashes{};      ///< [N] state hash
  std::uint32_t* index{};       ///< [N, S] tabular index; must be null if state_count() is 0
  float* features{};            ///< [N, S, F]
  std::uint8_t* planes{};       ///< [N, S, P, H, W]
};

/// Writes the results of one farm to row `n` of the caller's buffers.
/// @param is_first whether this is the first observation of an episode
/// @param view scratch memory
void WriteFarm(const Farm& farm, const Encoder& encoder, std::size_t n, bool is_first, View& view,
               const BatchOutput& output);

/// N farms of one scenario, each in its own episode. Not thread-safe.
class FarmBatch {
 public:
  /// Creates N farms, all at episode 0 of seed 0. After Reset(seed, 0, output), farm i plays the
  /// episodes i, i + N, i + 2N, … of the seed.
  /// @param farms N, at least 1
  /// @param threads number of threads that step the farms; results do not depend on it. If the
  ///   process has stepped farms on several threads and then forks, its child processes use one
  ///   thread.
  /// @throws InputError if the scenario is a family, or if the layout cannot be drawn
  FarmBatch(std::shared_ptr<const Scenario> scenario, std::int32_t farms, std::int32_t threads = 1);

  /// Starts one episode of `seed` in each farm: episode first_episode + i in farm i. Writes the
  /// first observations.
  /// @param stride difference between the numbers of successive episodes of a farm; 0 selects
  ///   farms(). Pass a larger stride if other batches play the episodes in between.
  /// @throws InputError if an episode's layout cannot be drawn; call Reset with another episode
  void Reset(std::uint64_t seed, std::uint64_t first_episode, const BatchOutput& output,
             std::uint64_t stride = 0);

  /// Steps every farm. @param actions [N, S], each in [0, kActionCount] (kHold allowed)
  /// @throws InputError if an episode's layout cannot be drawn
  /// @throws LogicError for an invalid action of an active ship
  ///
  /// With one thread, an error ends the step: the farms after the failed one are not stepped. With
  /// several threads, all other farms are stepped before the error is thrown.
  void Step(const std::uint8_t* actions, const BatchOutput& output);

  /// Writes the results of the current state without stepping, for example after Load.
  void Write(const BatchOutput& output);

  /// N of BatchOutput.
  std::int32_t farms() const { return static_cast<std::int32_t>(farms_.size()); }
  /// S of BatchOutput: ships and self-propelled devices of one farm.
  std::int32_t agents() const { return agents_; }
  /// Sizes of the results of a step.
  StepShape shape() const;
  const Scenario& scenario() const { return *scenario_; }
  /// Encoder of the index, the features and the planes.
  const Encoder& encoder() const { return encoder_; }
  /// @param i [0, farms())
  const Farm& farm(std::int32_t i) const { return farms_[static_cast<std::size_t>(i)]; }
  /// Mutable access to one farm, for example to call SetDisaster, Load or Step.
  Farm& farm(std::int32_t i) { return farms_[static_cast<std::size_t>(i)]; }

  /// Starts farm i's next episode.
  /// @throws InputError if the layout cannot be drawn
  void StartNext(std::int32_t i);
  /// Starts farm i's next episode and writes its first observation.
  /// @throws InputError if the layout cannot be drawn
  void StartNext(std::int32_t i, const BatchOutput& output);
  /// Starts episode `episode` of `seed` in farm i only, sets the stride of this farm, and writes
  /// its first observation.
  /// @throws InputError if the layout cannot be drawn
  void Start(std::int32_t i, std::uint64_t seed, std::uint64_t episode, std::uint64_t stride,
             const BatchOutput& output);
  /// Difference between the numbers of successive episodes of farm i. Initially farms(); Reset,
  /// Start and set_stride change it.
  std::uint64_t stride(std::int32_t i) const { return strides_[static_cast<std::size_t>(i)]; }
  /// Sets the stride of farm i. @param stride at least 1
  void set_stride(std::int32_t i, std::uint64_t stride);

  /// Serializes all farms. Farms restored by Load continue bit-identically. The bytes do not
  /// contain the strides.
  std::string Save() const;
  /// Restores farms written by Save. The strides do not change.
  /// @throws InputError if the bytes are damaged or belong to another version, scenario or number
  ///   of farms; the farms are then unchanged
  void Load(const std::string& bytes);

 private:
  void StepOne(std::int32_t i, std::int32_t thread, const std::uint8_t* actions,
               const BatchOutput& output);
  void WriteOne(std::int32_t i, std::int32_t thread, bool is_first, const BatchOutput& output);

  std::shared_ptr<const Scenario> scenario_;
  std::vector<Farm> farms_;
  Encoder encoder_;
  std::vector<std::uint64_t> strides_;  // by farm
  std::vector<View> views_;             // one per thread
  std::int32_t agents_{};
  std::int32_t threads_{};
};

}  // namespace aquafarm
