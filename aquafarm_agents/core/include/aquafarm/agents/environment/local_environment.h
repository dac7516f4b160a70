// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/observation/farm_batch.h"

namespace aquafarm::agents {

/// Farms in this process.
class LocalEnvironment final : public Environment {
 public:
  /// @param scenario must have passed ValidateScenario
  /// @throws InputError when the scenario cannot be laid out
  LocalEnvironment(std::shared_ptr<const Scenario> scenario, const EnvironmentOptions& options);

  const EnvironmentSpec& spec() const override { return spec_; }
  const Results& Reset(std::uint64_t seed, std::uint64_t first_episode = 0) override;
  const Results& Step(const std::vector<std::uint8_t>& actions) override;
  std::string Save() override;
  const Results& Load(const std::string& bytes) override;

  /// For tools that look at the farms besides learning on them.
  const FarmBatch& batch() const { return batch_; }

 private:
  BatchOutput Output();
  void CollectFinished();

  FarmBatch batch_;
  EnvironmentSpec spec_;
  std::vector<float> terms_;  // [N, S, kRewardTermCount]; empty unless own rewards are asked for
  bool with_states_{};
  Results results_;
  BatchOutput output_;
};

/// How a farm's episode ended.
EpisodeResult ToResult(const EpisodeRecord& record, std::int32_t farm);

/// The spec of farms of a scenario.
EnvironmentSpec MakeSpec(const Scenario& scenario, const Encoder& encoder, std::int32_t farms);

}  // namespace aquafarm::agents
