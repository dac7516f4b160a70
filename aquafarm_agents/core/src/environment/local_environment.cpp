// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/environment/local_environment.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "aquafarm/base/cbor.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/version.h"
#include "aquafarm/grid/step_buffers.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace aquafarm::agents {
namespace {

// Environments save a CBOR array with one item per farm.
nlohmann::json SavedFarms(const std::string& bytes) {
  const nlohmann::json farms = ParseCbor(bytes);
  if (!farms.is_array()) throw InputError("state: damaged bytes: expected a list of farms");
  return farms;
}

std::string ToBytes(const nlohmann::json& farms) {
  std::string bytes;
  nlohmann::json::to_cbor(farms, bytes);
  return bytes;
}

}  // namespace

FarmShare ShareOfRank(std::int32_t farms, int rank, int ranks) {
  if (farms % ranks != 0) {
    throw InputError("farms: got " + std::to_string(farms) + " with " + std::to_string(ranks) +
                     " ranks, expected a multiple of the ranks");
  }
  return {farms / ranks * rank, farms};
}

std::string TakeSavedFarms(const std::string& bytes, const FarmShare& share, std::int32_t count) {
  if (share.total == count) return bytes;
  const nlohmann::json all = SavedFarms(bytes);
  if (all.size() < static_cast<std::size_t>(share.first + count)) {
    throw InputError("state: got " + std::to_string(all.size()) + " farms, expected at least " +
                     std::to_string(share.first + count));
  }
  const auto begin = all.begin() + share.first;
  return ToBytes(nlohmann::json(nlohmann::json::array_t(begin, begin + count)));
}

std::string JoinSavedFarms(const std::vector<std::string>& parts) {
  nlohmann::json all = nlohmann::json::array();
  for (const std::string& part : parts) {
    for (const nlohmann::json& farm : SavedFarms(part)) all.push_back(farm);
  }
  return ToBytes(all);
}

bool WantsOwnRewards(std::uint8_t observation_types, EnvironmentSpec& spec) {
  if ((observation_types & kOwnRewardsBit) == 0 || !spec.team_reward) return false;
  spec.team_reward = false;
  return true;
}

void UseOwnRewards(StepResults& results) {
  AQUAFARM_CHECK_EQ(results.terms.size(), results.rewards.size() * kRewardTermCount);
  for (std::size_t slot = 0; slot < results.rewards.size(); ++slot) {
    // Same order of summation as RewardTerms::Total.
    const auto own = results.terms.begin() + static_cast<std::ptrdiff_t>(slot * kRewardTermCount);
    results.rewards[slot] = std::accumulate(own, own + kRewardTermCount, 0.0F);
  }
}

EnvironmentSpec MakeSpec(const Scenario& scenario, const Encoder& encoder, std::int32_t farms) {
  EnvironmentSpec spec;
  spec.scenario_name = scenario.name;
  spec.scenario_yaml = ToYaml(scenario);
  spec.scenario_hash = scenario.hash;
  spec.version = kVersion;
  spec.farms = farms;
  spec.agents = scenario.AgentCount();
  spec.team_reward = scenario.rewards.sharing == RewardSharing::kTeam;
  spec.state_count = encoder.state_count();
  spec.feature_count = encoder.feature_count();
  spec.feature_names = encoder.feature_names();
  spec.plane_count = encoder.plane_count();
  spec.height = scenario.height;
  spec.width = scenario.width;
  spec.step_limit = scenario.step_limit;
  return spec;
}

LocalEnvironment::LocalEnvironment(std::shared_ptr<const Scenario> scenario,
                                   const EnvironmentOptions& options, const FarmShare& share)
    : batch_(std::move(scenario), options.farms, options.threads),
      spec_(MakeSpec(batch_.scenario(), batch_.encoder(), options.farms)),
      share_(WholeOr(share, options.farms)),
      own_rewards_(WantsOwnRewards(options.observation_types, spec_)) {
  if ((options.observation_types & kIndexBit) != 0 && spec_.state_count == 0) {
    throw InputError(
        "scenario " + spec_.scenario_name +
        ": too many states for a table, expected a learner with a network; use algorithm auto");
  }
  std::uint8_t bits = options.observation_types & (kIndexBit | kFeaturesBit | kPlanesBit);
  if (options.hashes) bits |= kHashesField;
  if (own_rewards_) bits |= kTermsField;
  const StepShape shape = batch_.shape();
  SizeStepFields(shape, bits, results_, output_);
  results_.finished.reserve(shape.farms);
  if ((options.observation_types & kStatesBit) != 0) results_.states.resize(shape.farms);
}

const StepResults& LocalEnvironment::Reset(std::uint64_t seed, std::uint64_t first_episode) {
  batch_.Reset(seed, first_episode + static_cast<std::uint64_t>(share_.first), output_,
               static_cast<std::uint64_t>(share_.total));
  Complete();
  return results_;
}

const StepResults& LocalEnvironment::Step(const std::vector<std::uint8_t>& actions) {
  AQUAFARM_CHECK_EQ(actions.size(), results_.rewards.size());
  AQUAFARM_CHECK_LE(*std::max_element(actions.begin(), actions.end()),
                    static_cast<int>(Action::kHold));
  batch_.Step(actions.data(), output_);
  Complete();
  CollectFinished();
  return results_;
}

void LocalEnvironment::Complete() {
  if (own_rewards_) UseOwnRewards(results_);
  for (std::size_t i = 0; i < results_.states.size(); ++i) {  // Load may have moved the farms
    results_.states[i] = &std::as_const(batch_).farm(static_cast<std::int32_t>(i));
  }
  results_.finished.clear();
}

// A farm has an end reason in one step only, because it starts its next episode in the next step.
void LocalEnvironment::CollectFinished() {
  for (std::int32_t i = 0; i < spec_.farms; ++i) {
    if (results_.end_reasons[static_cast<std::size_t>(i)] == 0) continue;
    results_.finished.push_back(SummaryOf(batch_.farm(i).record(), share_.first + i));
  }
}

std::string LocalEnvironment::Save() { return batch_.Save(); }

const StepResults& LocalEnvironment::Load(const std::string& bytes) {
  batch_.Load(TakeSavedFarms(bytes, share_, spec_.farms));
  return Change([](std::size_t, Farm&) {});
}

const StepResults& LocalEnvironment::CopyStatesFrom(const std::vector<const Farm*>& farms) {
  AQUAFARM_CHECK_EQ(farms.size(), static_cast<std::size_t>(spec_.farms));
  return Change([&farms](std::size_t i, Farm& farm) { farm.CopyStateFrom(*farms[i]); });
}

const StepResults& LocalEnvironment::Change(const std::function<void(std::size_t, Farm&)>& change) {
  for (std::int32_t i = 0; i < spec_.farms; ++i) {
    change(static_cast<std::size_t>(i), batch_.farm(i));
    batch_.set_stride(i, static_cast<std::uint64_t>(share_.total));
  }
  batch_.Write(output_);
  Complete();
  return results_;
}

}  // namespace aquafarm::agents
