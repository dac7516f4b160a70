// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/observation/farm_batch.h"

namespace aquafarm::agents {

/// Draws the ranch of one episode of a family (scenario/family.h) and returns it in its state at
/// the start of this episode.
/// @throws InputError if none of 100 drawn ranches has a valid layout
Farm MakeRanch(const Scenario& family, std::uint64_t seed, std::uint64_t episode);

/// Environment whose farms play a new ranch of a family in every episode. The start of an episode
/// allocates memory; other steps do not.
class FamilyEnvironment final : public Environment {
 public:
  /// spec() contains the largest width and height of the family; its state_count and plane_count
  /// are 0.
  /// @param family a scenario whose `family` is set
  /// @param share as in LocalEnvironment
  /// @throws InputError if the index, planes or states are requested, or if the first ranch cannot
  ///   be drawn (see MakeRanch)
  FamilyEnvironment(std::shared_ptr<const Scenario> family, const EnvironmentOptions& options,
                    const FarmShare& share = {});

  const EnvironmentSpec& spec() const override { return spec_; }
  const StepResults& Reset(std::uint64_t seed, std::uint64_t first_episode = 0) override;
  const StepResults& Step(const std::vector<std::uint8_t>& actions) override;
  std::string Save() override;
  const StepResults& Load(const std::string& bytes) override;

  /// Returns farm `i`, for tools that inspect it. Precondition: Reset or Load was called.
  /// @param i [0, N)
  const Farm& farm(std::int32_t i) const { return *farms_[static_cast<std::size_t>(i)]; }

 private:
  void Write(std::int32_t i, std::int32_t thread, bool is_first);
  void Complete();

  std::shared_ptr<const Scenario> family_;
  Encoder encoder_;
  EnvironmentSpec spec_;
  const FarmShare share_;
  const bool own_rewards_;
  const std::int32_t threads_;
  std::vector<std::optional<Farm>> farms_;  // empty before the first Reset or Load
  std::vector<View> views_;                 // one per thread
  StepResults results_;
  BatchOutput output_;
};

/// Makes an environment in this process: a FamilyEnvironment if the scenario describes a family,
/// else a LocalEnvironment. @throws InputError if the constructor throws it
std::unique_ptr<Environment> MakeLocalFarms(std::shared_ptr<const Scenario> scenario,
                                            const EnvironmentOptions& options,
                                            const FarmShare& share = {});

}  // namespace aquafarm::agents
