// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Fetch by value, the rule of an operator without a forecast. Ships choose in id order:
///
///   a ship with capacity left fetches the most valuable device that no other ship fetches and
///   that it can still bring to a port before the episode ends; of equal values the nearest one
///   a ship without such a device returns to the nearest port and unloads there
///
/// The value is the insured one (farm/accounts.h) if the scenario has money, else the one of
/// rewards. Routes are the shortest ones by water. Disasters are ignored, except that the episode
/// ends with them. A ship keeps its device until it is aboard or can no longer be brought home. A
/// self-propelled device sails to the nearest port.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// Chooses the actions of all agents of one farm.
class FetchByValue {
 public:
  /// Chooses the actions of the next step of a farm whose episode is active.
  /// @param actions [agents]
  void Act(const Farm& farm, std::uint8_t* actions);

 private:
  /// The task of one ship.
  struct Errand {
    std::int32_t device{kNone};       ///< that it fetches
    std::vector<std::int32_t> moves;  ///< by water to that device, [H, W]
    std::int32_t waited{};            ///< steps in a row without a free cell on the route
  };
  void Begin(const Farm& farm);
  bool CanBringHome(const Farm& farm, std::int32_t device, std::int32_t moves) const;
  void Choose(const Farm& farm, std::int32_t id);
  std::uint8_t ActOf(const Farm& farm, std::int32_t id);
  std::uint8_t Sail(const Farm& farm, std::int32_t id, const std::vector<std::int32_t>& moves);
  std::int32_t Blocker(const Farm& farm, std::int32_t id, Cell cell) const;

  std::uint64_t seed_{};
  std::uint64_t episode_{};
  std::int32_t next_step_{kNone};  ///< kNone: before the first episode
  std::vector<Errand> errands_;
  std::vector<std::int32_t> to_port_;  ///< moves by water to the nearest port, [H, W]
  std::vector<Cell> cells_;            ///< of the ships, after the actions that are already chosen
};

/// FetchByValue as a Policy. It sees the complete farm, as PlannerPolicy does.
class FetchByValuePolicy final : public Policy {
 public:
  explicit FetchByValuePolicy(const EnvironmentSpec& spec);
  std::uint8_t observation_types() const override { return kStatesBit; }
  void Begin(std::uint64_t seed, std::int32_t farms) override;
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override;

 private:
  std::size_t agents_;
  std::vector<FetchByValue> fetchers_;
};

}  // namespace aquafarm::agents
