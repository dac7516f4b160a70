// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The rescue plan: which ship fetches which devices, when, and with which chance of success. See
/// rescue_problem.h for the inputs and rules.
///
/// A plan is a sequence of trips for each ship. A ship leaves as soon as it is ready, takes the
/// shortest routes and never has more devices aboard than its capacity. It delivers at the nearest
/// open port, or at the open port through which the way to another device is shortest. If a ship
/// starts with devices aboard and delivers them first, it may do so at any open port. A later
/// departure is never better: in each member of the ensemble, winds stop a ship in a cell from a
/// fixed time on, and a ship that departs earlier also leaves each cell earlier.
///
///   for each ship: sequences of trips, extended device by device, each with the members in which
///   the ship still works ──> best value per set of devices ──> best disjoint sets of all ships
///
/// If energy or ship-hours have prices (RescueEnergy), their cost is subtracted from the value
/// saved. A trip that does not save more than it costs is left out. (A ship that starts with
/// devices aboard delivers them anyway; see rescue_problem.h.) With risk_averse, the search is
/// repeated. Each repetition gives higher weights to the members with the largest losses under the
/// plans found so far. `averse_gap` bounds the advantage of other plans.
///
/// The value that a plan saves is the sum of the values that its ships save, so that combining the
/// ships adds no error. The search keeps only the best partial sequences and combinations, up to a
/// max number of each. If no max number is exceeded, the search is exhaustive (`is_exhaustive`). An
/// exhaustive search without risk_averse finds the best plan of the kind described above. `bound`
/// is an upper bound of the value that any plan saves. For each device, it assumes the earliest
/// pickup and the earliest delivery by any ship, and failure only in members whose winds reach the
/// device's site by the end of this pickup.

#include <cstdint>
#include <optional>
#include <vector>

#include "aquafarm/agents/rescue/rescue_outcome.h"
#include "aquafarm/agents/rescue/rescue_problem.h"

namespace aquafarm::agents {

/// Summary of the losses of all members.
struct LossSummary {
  double mean{};
  double standard_error{};  ///< of the mean
  double q05{};             ///< 5 % quantile
  double q50{};
  double q95{};
  double cvar05{};  ///< mean of the worst 5 % of the members
};
/// Summarizes losses. @param losses by member, at least one
LossSummary Summarize(std::vector<float> losses);
/// Returns the mean of the k largest losses, where k = share · losses.size(). If k is not a whole
/// number, the smallest of these losses counts in part.
/// @param losses at least one
/// @param share in (0, 1]
double MeanOfWorst(std::vector<float> losses, double share);

/// Max rounds of the risk-averse search for a plan.
inline constexpr int kAverseRounds = 12;
/// Max rounds of the risk-averse search for a plan that is only compared with another one.
inline constexpr int kAverseRoundsToCompare = 3;

/// Searches for the best plan.
/// @param averse_rounds max rounds of the search with risk_averse
/// @throws InputError if the problem is invalid, for example because a number is out of range, or a
///   device, port or ship is not on water
RescuePlan PlanRescue(const RescueProblem& problem, const Ensemble& ensemble,
                      int averse_rounds = kAverseRounds);

/// Plays the orders of a plan in the members of an ensemble, for example of another storm. Does not
/// set `bound`, `averse_gap` or `is_exhaustive` of the result.
/// @param problem must contain the ships, devices and ports of the plan
/// @param ensemble made for the sites of `problem`
RescuePlan PlayRescue(const RescueProblem& problem, const Ensemble& ensemble,
                      const RescuePlan& plan);

/// Returns a plan that follows `rule` and ignores storms, for comparison with other plans. Devices
/// are assigned one after the other, each to the ship that is free earliest. A ship delivers at the
/// nearest open port when it is full or when it can reach no remaining device.
RescuePlan FetchInOrder(const RescueProblem& problem, const Ensemble& ensemble, FetchRule rule);

/// Latest departure to fetch a device.
struct Deadline {
  double probability{};  ///< required chance that the device comes home
  /// Time after the start of the plan, in whole seconds; nullopt if no departure has this chance.
  std::optional<double> leave_s;
  /// True if leave_s is limited only by the time until which the storm is known: winds stop the
  /// ship in so few members that a later departure might also have the required chance.
  bool is_open{};
  std::int32_t ship{kNone};  ///< ship that may leave at leave_s; kNone without leave_s
};
/// Returns, by device and probability, the latest departure of any ship that fetches this device
/// first and brings it to the nearest open port. A ship that leaves at this time succeeds with at
/// least the given probability. A ship that leaves a second later succeeds with a smaller
/// probability. A ship with devices aboard delivers them before it fetches the device.
std::vector<std::vector<Deadline>> Deadlines(const RescueProblem& problem, const Ensemble& ensemble,
                                             const std::vector<double>& probabilities);

}  // namespace aquafarm::agents
