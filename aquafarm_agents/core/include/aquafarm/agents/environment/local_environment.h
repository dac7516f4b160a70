// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/observation/farm_batch.h"

namespace aquafarm::agents {

/// The farms of one environment if several processes share all farms.
struct FarmShare {
  std::int32_t first{};  ///< index of its first farm among all
  std::int32_t total{};  ///< number of all farms; 0: the environment has all of them
};

/// Environment whose farms run in this process.
class LocalEnvironment final : public Environment {
 public:
  /// @param scenario must have passed ValidateScenario
  /// @param share the farms play the same episodes as in an environment with all farms, and Load
  ///        takes their part of the saved bytes of all farms
  /// @throws InputError if no layout can be generated for the scenario
  LocalEnvironment(std::shared_ptr<const Scenario> scenario, const EnvironmentOptions& options,
                   const FarmShare& share = {});

  const EnvironmentSpec& spec() const override { return spec_; }
  const StepResults& Reset(std::uint64_t seed, std::uint64_t first_episode = 0) override;
  const StepResults& Step(const std::vector<std::uint8_t>& actions) override;
  std::string Save() override;
  const StepResults& Load(const std::string& bytes) override;
  /// Changes the farms, such as by Farm::CopyStateFrom. @param change called for each farm, with
  /// its index @returns their current results with an empty `finished`
  const StepResults& Change(const std::function<void(std::size_t, Farm&)>& change);
  /// Continues copies of farms of the same scenario, such as StepResults::states. @param farms [N]
  const StepResults& CopyStatesFrom(const std::vector<const Farm*>& farms);

  /// The farms, for tools that inspect them.
  const FarmBatch& batch() const { return batch_; }

 private:
  void Complete();
  void CollectFinished();

  FarmBatch batch_;
  EnvironmentSpec spec_;
  const FarmShare share_;
  const bool own_rewards_;
  StepResults results_;
  BatchOutput output_;
};

/// Returns `share`, or that of all `farms` if its total is 0.
inline FarmShare WholeOr(const FarmShare& share, std::int32_t farms) {
  return share.total == 0 ? FarmShare{0, farms} : share;
}

/// Returns the share of a rank of all farms. @param ranks number of processes that train together
/// @throws InputError if the ranks cannot have equally many farms
FarmShare ShareOfRank(std::int32_t farms, int rank, int ranks);

/// Extracts the `count` farms of a share from the saved bytes of all farms.
/// @throws InputError if the bytes are damaged or have fewer farms
std::string TakeSavedFarms(const std::string& bytes, const FarmShare& share, std::int32_t count);

/// Joins the saved bytes of environments that share the farms. @param parts in order of the farms
/// @throws InputError if the bytes are damaged
std::string JoinSavedFarms(const std::vector<std::string>& parts);

/// Spec of `farms` farms of a scenario.
EnvironmentSpec MakeSpec(const Scenario& scenario, const Encoder& encoder, std::int32_t farms);

}  // namespace aquafarm::agents
