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

/// Returns the farm at the start of an episode of a family (scenario/family.h), as drawn by
/// FamilyEnvironment.
/// @throws InputError if no ranch with a valid layout is found in a bounded number of attempts
Farm MakeRanch(const Scenario& family, std::uint64_t seed, std::uint64_t episode);

/// Environment whose farms play another ranch of a family in every episode. Farm i of N plays
/// episodes i, i + N, i + 2N, … A new episode allocates memory; a step does not.
class FamilyEnvironment final : public Environment {
 public:
  /// The spec has the largest width and height of the family, and no table and planes.
  /// @param family with Scenario::family
  /// @param share as in LocalEnvironment
  /// @throws InputError if observations are requested that depend on the size of the map
  FamilyEnvironment(std::shared_ptr<const Scenario> family, const EnvironmentOptions& options,
                    const FarmShare& share = {});

  const EnvironmentSpec& spec() const override { return spec_; }
  const StepResults& Reset(std::uint64_t seed, std::uint64_t first_episode = 0) override;
  const StepResults& Step(const std::vector<std::uint8_t>& actions) override;
  std::string Save() override;
  const StepResults& Load(const std::string& bytes) override;

  /// A farm, for tools that inspect it. Precondition: Reset or Load was called.
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

/// Makes farms in this process: a FamilyEnvironment for a family, else a LocalEnvironment.
std::unique_ptr<Environment> MakeLocalFarms(std::shared_ptr<const Scenario> scenario,
                                            const EnvironmentOptions& options,
                                            const FarmShare& share = {});

}  // namespace aquafarm::agents
