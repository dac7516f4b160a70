// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/observation/farm_batch.h"

namespace aquafarm::agents {

/// The consecutive farms that one environment has. Each of several processes may have a part of all
/// farms.
struct FarmShare {
  std::int32_t first{};  ///< index of the environment's first farm among all farms
  std::int32_t total{};  ///< number of all farms; 0 if the environment has all of them
};

/// Environment whose farms run in this process.
class LocalEnvironment final : public Environment {
 public:
  /// @param scenario must have passed ValidateScenario
  /// @param share the farms of this environment. They play the same episodes as in an environment
  ///        with all farms. Load expects the saved bytes of all farms.
  /// @throws InputError if no layout can be generated for the scenario, if it describes a family
  ///         of ranches, or if the tabular index (kIndexBit) is requested and the scenario has too
  ///         many states for a table
  LocalEnvironment(std::shared_ptr<const Scenario> scenario, const EnvironmentOptions& options,
                   const FarmShare& share = {});

  const EnvironmentSpec& spec() const override { return spec_; }
  const StepResults& Reset(std::uint64_t seed, std::uint64_t first_episode = 0) override;
  const StepResults& Step(const std::vector<std::uint8_t>& actions) override;
  std::string Save() override;
  const StepResults& Load(const std::string& bytes) override;
  /// Calls `change` for each farm, with its index, for example to call Farm::CopyStateFrom.
  /// @returns the results of the changed farms, with an empty `finished`
  const StepResults& Change(const std::function<void(std::size_t, Farm&)>& change);
  /// Copies the state of farms of the same scenario, such as StepResults::states, into the farms of
  /// this environment. Returns their results, with an empty `finished`.
  /// @param farms [N]
  const StepResults& CopyStatesFrom(const std::vector<const Farm*>& farms);

  /// Returns the farms, for tools that inspect them.
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

/// Returns `share`, or the share that contains all `farms` if share.total is 0.
inline FarmShare WholeOr(const FarmShare& share, std::int32_t farms) {
  return share.total == 0 ? FarmShare{0, farms} : share;
}

/// Returns the share of one rank.
/// @param farms number of farms of all ranks
/// @param rank [0, ranks)
/// @param ranks number of processes that train together
/// @throws InputError if `farms` is not a multiple of `ranks`
FarmShare ShareOfRank(std::int32_t farms, int rank, int ranks);

/// Extracts the `count` farms of a share from the saved bytes of all farms. Returns `bytes`
/// unchanged if `count` is the number of all farms.
/// @throws InputError if the bytes are damaged or contain too few farms
std::string TakeSavedFarms(const std::string& bytes, const FarmShare& share, std::int32_t count);

/// Joins the saved bytes of several environments into those of one environment with all farms.
/// @param parts saved bytes of each environment, in the order of their farms
/// @throws InputError if a part is damaged
std::string JoinSavedFarms(const std::vector<std::string>& parts);

/// Returns the spec of an environment with `farms` farms of a scenario.
EnvironmentSpec MakeSpec(const Scenario& scenario, const Encoder& encoder, std::int32_t farms);

}  // namespace aquafarm::agents
