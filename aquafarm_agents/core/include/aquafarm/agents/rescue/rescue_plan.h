// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The rescue plan: which ship fetches which devices, when, and with which chance of success. See
/// rescue_problem.h for the inputs and rules.
///
/// A plan is a sequence of trips for each ship. A ship leaves as soon as it is ready, takes the
/// shortest routes and fetches up to its capacity. It delivers at the nearest open port, or at the
/// open port on the shortest way to another device. A later departure is never better: in each
/// member, winds stop a ship in a cell from a fixed time on, and a ship that departs earlier also
/// leaves each cell earlier. A ship that starts with devices aboard may deliver them at any open
/// port.
///
///   for each ship: sequences of trips, extended device by device, each with the members in which
///   the ship still works ──> best value per set of devices ──> best disjoint sets of all ships
///
/// If energy or ship-hours have prices (RescueEnergy), their cost is subtracted from the value
/// saved. A trip that costs more than it saves is left out, except the first trip of a ship that
/// starts with devices aboard. With risk_averse, the search is repeated with higher weights of the
/// worst members of the plans found so far. `averse_gap` bounds the advantage of other plans.
///
/// The value of a plan is the sum of the values of its devices, so combining the ships adds no
/// error. The search keeps only the best partial sequences and combinations, up to a max number. If
/// this number is not exceeded, the search is exhaustive (`is_exhaustive`). Without risk_averse,
/// the plan is then the best one of this kind. `bound` is an upper bound of the value of every
/// plan. For each device it assumes the earliest pickup and the earliest delivery by any ship. It
/// assumes failure only in members whose winds reach the device's site before the end of this
/// pickup.

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
/// Returns the mean of the share · losses.size() largest values. If this number is not whole, the
/// smallest of these values counts in part.
/// @param losses at least one
/// @param share in (0, 1]
double MeanOfWorst(std::vector<float> losses, double share);

/// Max rounds of the risk-averse search for a plan.
inline constexpr int kAverseRounds = 12;
/// Max rounds of the risk-averse search for a plan that is only compared with another one.
inline constexpr int kAverseRoundsToCompare = 3;

/// Makes the best plan.
/// @param averse_rounds max rounds of the search with risk_averse
/// @throws InputError if a number of the problem is out of range, or if a device, port or ship is
///   not on water
RescuePlan PlanRescue(const RescueProblem& problem, const Ensemble& ensemble,
                      int averse_rounds = kAverseRounds);

/// Plays the orders of a plan in the members of an ensemble, for example of another storm. Does not
/// set `bound`, `averse_gap` or `is_exhaustive` of the result.
/// @param problem must contain the ships, devices and ports of the plan
/// @param ensemble made for the sites of `problem`
RescuePlan PlayRescue(const RescueProblem& problem, const Ensemble& ensemble,
                      const RescuePlan& plan);

/// Returns a plan for comparison that follows a rule and ignores storms. Devices are assigned one
/// after the other, each to the ship that is free earliest. A ship delivers at the nearest open
/// port when it is full or when no device is left.
RescuePlan FetchInOrder(const RescueProblem& problem, const Ensemble& ensemble, FetchRule rule);

/// Latest departure to fetch a device.
struct Deadline {
  double probability{};  ///< required chance that the device comes home
  /// Time after the start of the plan, in whole seconds; nullopt if no departure has this chance.
  std::optional<double> leave_s;
  /// True if only the end of the known time limits leave_s, because winds stop the ship in too few
  /// members.
  bool is_open{};
  std::int32_t ship{kNone};  ///< ship that may leave at leave_s; kNone without leave_s
};
/// Returns, by device and probability, the latest departure of any ship that fetches this device
/// first and brings it to the nearest open port. A ship that leaves at this time succeeds in at
/// least this share of the members. A ship that leaves a second later succeeds in less than this
/// share. A ship with devices aboard delivers these first.
std::vector<std::vector<Deadline>> Deadlines(const RescueProblem& problem, const Ensemble& ensemble,
                                             const std::vector<double>& probabilities);

}  // namespace aquafarm::agents
