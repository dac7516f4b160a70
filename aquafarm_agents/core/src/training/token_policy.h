// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/environment/policy.h"

namespace aquafarm::agents {

/// Plays a policy that reads entity tokens. It is for farms whose features are not tokens: each Act
/// copies the farms into local farms of the same scenario with view.tokens. All other view settings
/// stay the same, so a ship observes no more than its scenario allows.
class TokenPolicy final : public Policy {
 public:
  /// @param make makes the policy for farms with tokens
  /// @throws InputError if the scenario cannot have tokens. Also throws what `make` throws
  TokenPolicy(const EnvironmentSpec& spec,
              const std::function<std::unique_ptr<Policy>(const EnvironmentSpec&)>& make);

  std::uint8_t observation_types() const override { return kStatesBit; }
  void Begin(std::uint64_t seed, std::int32_t farms) override;
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override;

 private:
  std::shared_ptr<const Scenario> scenario_;  // with view.tokens
  std::unique_ptr<LocalEnvironment> farms_;
  std::unique_ptr<Policy> policy_;
};

}  // namespace aquafarm::agents
