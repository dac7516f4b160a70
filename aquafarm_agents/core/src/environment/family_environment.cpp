// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/environment/family_environment.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/base/cbor.h"
#include "aquafarm/base/check.h"
#include "aquafarm/grid/step_buffers.h"
#include "aquafarm/observation/for_each_farm.h"
#include "aquafarm/scenario/family.h"

namespace aquafarm::agents {
namespace {

constexpr std::uint32_t kMaxAttempts = 100;

}  // namespace

Farm MakeRanch(const Scenario& family, std::uint64_t seed, std::uint64_t episode) {
  std::string last;
  for (std::uint32_t attempt = 0; attempt < kMaxAttempts; ++attempt) {
    try {
      Farm farm(std::make_shared<const Scenario>(DrawRanch(family, seed, episode, attempt)));
      farm.Reset(seed, episode);
      return farm;
    } catch (const InputError& error) {  // the objects of the drawn ranch do not fit its map
      last = error.what();
    }
  }
  throw InputError("family: no ranch with a valid layout in " + std::to_string(kMaxAttempts) +
                   " attempts (seed " + std::to_string(seed) + ", episode " +
                   std::to_string(episode) +
                   "), expected larger maps or fewer objects; the last attempt: " + last);
}

FamilyEnvironment::FamilyEnvironment(std::shared_ptr<const Scenario> family,
                                     const EnvironmentOptions& options, const FarmShare& share)
    : family_(std::move(family)),
      encoder_(*family_),
      spec_(MakeSpec(*family_, encoder_, options.farms)),
      share_(WholeOr(share, options.farms)),
      own_rewards_(WantsOwnRewards(options.observation_types, spec_)),
      threads_(std::max(1, std::min(options.threads, options.farms))),
      views_(static_cast<std::size_t>(threads_)) {
  AQUAFARM_CHECK_EQ(family_->family.has_value(), true);
  spec_.state_count = 0;
  spec_.plane_count = 0;
  spec_.width = family_->family->width.max;
  spec_.height = family_->family->height.max;
  spec_.step_limit = std::max(spec_.step_limit, kMaxRanchSteps);
  const std::string refusal =
      "scenario " + spec_.scenario_name + ": is a family of ranches of different sizes, expected ";
  if ((options.observation_types & kStatesBit) != 0) {
    throw InputError(
        refusal +
        "one ranch, whose state this policy reads; evaluate the policy 'generalist' or "
        "another policy that reads features, or train without teacher_policy=planner");
  }
  if ((options.observation_types & (kIndexBit | kPlanesBit)) != 0) {
    throw InputError(refusal + "a learner that reads features: use algorithm ppo");
  }
  std::uint8_t bits = options.observation_types & kFeaturesBit;
  if (options.hashes) bits |= kHashesField;
  if (own_rewards_) bits |= kTermsField;
  const StepShape shape{static_cast<std::size_t>(spec_.farms),
                        static_cast<std::size_t>(spec_.agents),
                        static_cast<std::size_t>(spec_.feature_count), 0};
  SizeStepFields(shape, bits, results_, output_);
  results_.finished.reserve(shape.farms);
  MakeRanch(*family_, 0, 0);  // fails early if no ranch of the family has a valid layout
}

const StepResults& FamilyEnvironment::Reset(std::uint64_t seed, std::uint64_t first_episode) {
  std::vector<std::optional<Farm>> drawn(static_cast<std::size_t>(spec_.farms));
  const auto draw = [&](std::int32_t i, std::int32_t) {
    const auto farm = static_cast<std::uint64_t>(share_.first + i);
    drawn[static_cast<std::size_t>(i)] = MakeRanch(*family_, seed, first_episode + farm);
  };
  ForEachFarm(spec_.farms, threads_, std::cref(draw));
  farms_ = std::move(drawn);
  for (std::int32_t i = 0; i < spec_.farms; ++i) Write(i, 0, true);
  Complete();
  return results_;
}

const StepResults& FamilyEnvironment::Step(const std::vector<std::uint8_t>& actions) {
  AQUAFARM_CHECK_EQ(actions.size(), results_.rewards.size());
  AQUAFARM_CHECK_LE(*std::max_element(actions.begin(), actions.end()),
                    static_cast<int>(Action::kHold));
  AQUAFARM_CHECK_EQ(farms_.size(), static_cast<std::size_t>(spec_.farms));  // after Reset or Load
  const auto step = [&](std::int32_t i, std::int32_t thread) {
    std::optional<Farm>& farm = farms_[static_cast<std::size_t>(i)];
    const bool starts = farm->over();
    if (starts) {
      farm = MakeRanch(*family_, farm->seed(),
                       farm->episode() + static_cast<std::uint64_t>(share_.total));
    } else {
      farm->Step(actions.data() + static_cast<std::ptrdiff_t>(i) * spec_.agents);
    }
    Write(i, thread, starts);
  };
  ForEachFarm(spec_.farms, threads_, std::cref(step));
  Complete();
  for (std::int32_t i = 0; i < spec_.farms; ++i) {
    if (!farm(i).over()) continue;
    results_.finished.push_back(SummaryOf(farm(i).record(), share_.first + i));
  }
  return results_;
}

void FamilyEnvironment::Write(std::int32_t i, std::int32_t thread, bool is_first) {
  WriteFarm(farm(i), encoder_, static_cast<std::size_t>(i), is_first,
            views_[static_cast<std::size_t>(thread)], output_);
}

void FamilyEnvironment::Complete() {
  if (own_rewards_) UseOwnRewards(results_);
  results_.finished.clear();
}

std::string FamilyEnvironment::Save() {
  nlohmann::json states = nlohmann::json::array();
  for (const std::optional<Farm>& farm : farms_) {
    const std::string bytes = farm->Save();
    states.push_back(
        {farm->seed(), farm->episode(), nlohmann::json::binary({bytes.begin(), bytes.end()})});
  }
  std::string bytes;
  nlohmann::json::to_cbor(states, bytes);
  return bytes;
}

const StepResults& FamilyEnvironment::Load(const std::string& bytes) {
  std::vector<std::optional<Farm>> loaded;
  try {
    const nlohmann::json states = ParseCbor(TakeSavedFarms(bytes, share_, spec_.farms));
    if (!states.is_array() || states.size() != static_cast<std::size_t>(spec_.farms)) {
      throw InputError("state: got " + std::to_string(states.size()) + " farms, expected " +
                       std::to_string(spec_.farms) + "; load a checkpoint of as many farms");
    }
    for (const nlohmann::json& state : states) {
      loaded.push_back(
          MakeRanch(*family_, state.at(0).get<std::uint64_t>(), state.at(1).get<std::uint64_t>()));
      const auto& farm = state.at(2).get_binary();
      loaded.back()->Load(std::string(farm.begin(), farm.end()));
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(std::string("state: damaged bytes: ") + error.what() +
                     "; load another checkpoint");
  }
  farms_ = std::move(loaded);
  for (std::int32_t i = 0; i < spec_.farms; ++i) Write(i, 0, farm(i).step() == 0);
  Complete();
  return results_;
}

std::unique_ptr<Environment> MakeLocalFarms(std::shared_ptr<const Scenario> scenario,
                                            const EnvironmentOptions& options,
                                            const FarmShare& share) {
  if (scenario->family) {
    return std::make_unique<FamilyEnvironment>(std::move(scenario), options, share);
  }
  return std::make_unique<LocalEnvironment>(std::move(scenario), options, share);
}

}  // namespace aquafarm::agents
