// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Plays a trial in which new bulletins arrive and one ship gets new orders at each of them. The
/// rules are those of rescue_problem.h, so the value that is saved can be compared with the value
/// that a plan saves.

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "aquafarm/agents/planning/planner.h"
#include "aquafarm/agents/rescue/rescue_case.h"
#include "rescue/trip_model.h"

namespace aquafarm::agents {

/// State of the ship and the devices of a trial.
struct TrialFleet {
  Cell cell{};                      ///< cell of the ship
  double time_s{};                  ///< time after the start of the trial [s]; in Skipper::Plan,
                                    ///< time after the bulletin [s]
  std::vector<std::size_t> aboard;  ///< indices of the devices aboard
  std::vector<bool> is_delivered;   ///< by device
  std::vector<double> lost;         ///< by device: share of its value lost in the trial so far
};

/// One action of the ship.
struct TrialAct {
  Cell cell{};                    ///< cell of the ship after the action
  double seconds{};               ///< duration [s]
  std::optional<OrderKind> kind;  ///< fetch, or deliver all devices aboard; nullopt: move or wait
  std::size_t device{};           ///< index of the device to fetch
};

/// Chooses the actions of the ship of a trial.
class Skipper {
 public:
  Skipper() = default;
  Skipper(const Skipper&) = delete;
  Skipper& operator=(const Skipper&) = delete;
  virtual ~Skipper() = default;

  /// Plans for a new bulletin.
  /// @param known case with the storm of the bulletin; it starts at the time of the bulletin
  /// @param fleet present state
  virtual void Plan(RescueCase known, const TrialFleet& fleet) = 0;
  /// Returns the next action; nullopt if the ship waits for the next bulletin.
  virtual std::optional<TrialAct> Next() = 0;
};

/// Makes a new rescue plan at each bulletin.
class PlanAgain final : public Skipper {
 public:
  void Plan(RescueCase known, const TrialFleet& fleet) override;
  std::optional<TrialAct> Next() override;

 private:
  std::deque<TrialAct> acts_;
};

/// The policy `planner` (planning/planner.h). It plans as if the newest forecast were exact, with
/// the rules and rewards of the farm. It keeps its plan until the next bulletin. Its actions take
/// the time that they take in a rescue plan.
class PlannerSkipper final : public Skipper {
 public:
  /// @param rescue case with one ship and the devices of the ranch
  explicit PlannerSkipper(const RescueCase& rescue);
  void Plan(RescueCase known, const TrialFleet& fleet) override;
  std::optional<TrialAct> Next() override;

 private:
  std::shared_ptr<const Scenario> calm_;  // the ranch without disasters
  Farm farm_;
  Planner planner_;
  double pace_s_;
  double handling_s_;
  std::deque<std::uint8_t> actions_;
};

/// A bulletin of a trial.
struct TrialBulletin {
  double time_s{};                    ///< time after the start of the trial [s]
  std::function<RescueCase()> known;  ///< makes the case that starts with this bulletin
};

/// Plays the actions of a skipper in the true storm.
/// @param model of the true storm, with one ship and an ensemble of one member
/// @param bulletins in order of time
/// @returns the value saved: the loss if no ship leaves, minus the loss with these actions
double PlayReacting(const TripModel& model, const std::vector<TrialBulletin>& bulletins,
                    Skipper& skipper);

}  // namespace aquafarm::agents
