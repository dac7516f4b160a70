// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Fetch by value: the rule of an operator who has no forecast. Ships choose in id order:
///
///   - A ship with free capacity fetches the most valuable device that no other ship is fetching
///     and that it can still bring to a port before the episode ends. Of equally valuable devices
///     it fetches the nearest one.
///   - If there is no such device, or no free capacity, the ship sails to the nearest port.
///   - A ship with devices aboard unloads in every port that it enters.
///
/// The value of a device is its insured value (farm/accounts.h) if the scenario has money, else the
/// value that the reward credits (Device::value). Routes are the shortest ones by water. The rule
/// uses disasters only to compute the latest step at which the episode can end: the step in which
/// the last disaster ends, or the step limit if that comes first. A ship keeps its chosen device
/// until the device is aboard, or can no longer be brought home in time. A self-propelled device
/// sails to the nearest port.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// Chooses the actions of all agents of one farm.
class FetchByValue {
 public:
  /// Chooses the actions of the next step. The episode must not be over.
  /// @param actions [agents]
  void Act(const Farm& farm, std::uint8_t* actions);

 private:
  /// The task of one ship.
  struct Errand {
    std::int32_t device{kNone};       ///< device that the ship fetches; kNone: no device
    std::vector<std::int32_t> moves;  ///< [H, W] moves by water from each cell to that device
    std::int32_t waited{};            ///< consecutive steps in which other ships blocked the way
  };
  void Begin(const Farm& farm);
  bool CanBringHome(const Farm& farm, std::int32_t device, std::int32_t moves) const;
  void Choose(const Farm& farm, std::int32_t id);
  std::uint8_t ActOf(const Farm& farm, std::int32_t id);
  std::uint8_t Sail(const Farm& farm, std::int32_t id, const std::vector<std::int32_t>& moves);
  std::int32_t Blocker(const Farm& farm, std::int32_t id, Cell cell) const;

  std::uint64_t seed_{};
  std::uint64_t episode_{};
  /// Step of the farm that Act expects in its next call. At any other step it clears `errands_`.
  std::int32_t next_step_{kNone};
  std::vector<Errand> errands_;        ///< by ship
  std::vector<std::int32_t> to_port_;  ///< [H, W] moves by water to the nearest port
  std::vector<Cell> cells_;            ///< cells of the ships after the actions chosen so far
};

/// FetchByValue as a Policy. It reads the complete state of the farm, even if the scenario limits
/// what ships observe.
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
