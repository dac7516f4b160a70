// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/observation/farm_batch.h"

namespace aquafarm::agents {

/// Environment whose farms run in this process.
class LocalEnvironment final : public Environment {
 public:
  /// @param scenario must have passed ValidateScenario
  /// @throws InputError if no layout can be generated for the scenario
  LocalEnvironment(std::shared_ptr<const Scenario> scenario, const EnvironmentOptions& options);

  const EnvironmentSpec& spec() const override { return spec_; }
  const StepResults& Reset(std::uint64_t seed, std::uint64_t first_episode = 0) override;
  const StepResults& Step(const std::vector<std::uint8_t>& actions) override;
  std::string Save() override;
  const StepResults& Load(const std::string& bytes) override;

  /// The farms, for tools that inspect them.
  const FarmBatch& batch() const { return batch_; }

 private:
  void Complete();
  void CollectFinished();

  FarmBatch batch_;
  EnvironmentSpec spec_;
  bool own_rewards_{};
  bool with_states_{};
  StepResults results_;
  BatchOutput output_;
};

/// Result of a farm's episode from its record.
EpisodeResult ToResult(const EpisodeRecord& record, std::int32_t farm);

/// Spec of `farms` farms of a scenario.
EnvironmentSpec MakeSpec(const Scenario& scenario, const Encoder& encoder, std::int32_t farms);

}  // namespace aquafarm::agents
