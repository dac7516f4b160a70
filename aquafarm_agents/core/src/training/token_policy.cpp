// SPDX-License-Identifier: BSD-3-Clause
#include "training/token_policy.h"

#include <utility>

#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/scenario/validate.h"

namespace aquafarm::agents {
namespace {

// Returns the scenario with view.tokens. Its hash stays that of the farms, because
// Farm::CopyStateFrom compares it.
std::shared_ptr<const Scenario> WithTokens(const EnvironmentSpec& spec) {
  Scenario scenario = ParseScenario(spec.scenario_yaml, spec.scenario_name);
  scenario.view.tokens = true;
  ValidateScenario(scenario);  // tokens need more memory
  return std::make_shared<const Scenario>(std::move(scenario));
}

std::unique_ptr<LocalEnvironment> MakeFarms(const std::shared_ptr<const Scenario>& scenario,
                                            std::int32_t farms) {
  EnvironmentOptions options;
  options.farms = farms;
  options.observation_types = kFeaturesBit;
  return std::make_unique<LocalEnvironment>(scenario, options);
}

}  // namespace

TokenPolicy::TokenPolicy(const EnvironmentSpec& spec,
                         const std::function<std::unique_ptr<Policy>(const EnvironmentSpec&)>& make)
    : scenario_(WithTokens(spec)),
      farms_(MakeFarms(scenario_, spec.farms)),
      policy_(make(farms_->spec())) {}

void TokenPolicy::Begin(std::uint64_t seed, std::int32_t farms) {
  if (farms != farms_->spec().farms) farms_ = MakeFarms(scenario_, farms);
  policy_->Begin(seed, farms);
}

void TokenPolicy::Act(const StepResults& results, std::vector<std::uint8_t>& actions) {
  policy_->Act(farms_->CopyStatesFrom(results.states), actions);
  values_ = policy_->values();
}

}  // namespace aquafarm::agents
