// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Plays a trial in which new bulletins arrive, and one ship gets new orders at each of them. The
/// rules of ships and losses are those of rescue_problem.h, so that what these skippers save can be
/// compared with what a plan saves.

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

/// The ship of a trial and the devices, at a time.
struct TrialFleet {
  Cell cell{};
  double time_s{};                  ///< after the start of the trial
  std::vector<std::size_t> aboard;  ///< devices
  std::vector<bool> is_delivered;   ///< by device
  std::vector<double> lost;         ///< by device: share of its value since the start of the trial
};

/// What a ship does next.
struct TrialAct {
  Cell cell{};                    ///< where the ship is after it
  double seconds{};               ///< duration
  std::optional<OrderKind> kind;  ///< fetch: `device`; deliver: all that is aboard; else a move
  std::size_t device{};
};

/// Gives orders to the ship of a trial.
class Skipper {
 public:
  Skipper() = default;
  Skipper(const Skipper&) = delete;
  Skipper& operator=(const Skipper&) = delete;
  virtual ~Skipper() = default;

  /// Makes new orders for a bulletin. @param known the case as the bulletin describes it
  virtual void Plan(RescueCase known, const TrialFleet& fleet) = 0;
  /// Returns the next act; nullopt if the ship waits for the next bulletin.
  virtual std::optional<TrialAct> Next() = 0;
};

/// Makes the rescue plan again at each bulletin.
class PlanAgain final : public Skipper {
 public:
  void Plan(RescueCase known, const TrialFleet& fleet) override;
  std::optional<TrialAct> Next() override;

 private:
  std::deque<TrialAct> acts_;
};

/// The policy `planner` (planning/planner.h): it plans for the newest forecast as if it were exact,
/// in the rules and with the rewards of the farm. Between two bulletins its forecast does not
/// change, so that it keeps its plan. Its moves take the time that they take in a rescue plan.
class PlannerSkipper final : public Skipper {
 public:
  /// @param rescue with one ship and the devices of the ranch
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
  double time_s{};  ///< after the start of the trial
  std::function<RescueCase()> known;
};

/// Plays the orders of a skipper in a storm. @param model of the true storm, with one ship
/// @returns the value saved, compared with no departure
double PlayReacting(const TripModel& model, const std::vector<TrialBulletin>& bulletins,
                    Skipper& skipper);

}  // namespace aquafarm::agents
