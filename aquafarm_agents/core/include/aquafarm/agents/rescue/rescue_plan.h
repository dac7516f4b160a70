// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The rescue plan: who fetches what, when, and how likely it succeeds (inputs: rescue_problem.h).
///
/// A plan is a sequence of trips for each ship. A ship leaves as soon as it is ready, takes the
/// shortest routes, fetches up to its capacity, and delivers at the nearest open port or at the one
/// on the way to the next device. A later departure is never better: in each member winds stop a
/// ship in a cell from a fixed time on, and a ship that leaves earlier is there earlier.
///
///   per ship: sequences of trips, extended device by device, each with the members in which
///   the ship still works ──> best value per set of devices ──> best disjoint sets of all ships
///
/// Energy and ship-hours with prices (RescueEnergy) are subtracted from the value: a trip that
/// costs more than it saves is left out. With risk_averse, the search is repeated with weights on
/// the worst members of the plans found (`averse_gap` states how far from the best plan it may be).
///
/// The value of a plan is additive over devices, so the combination is exact. The search keeps the
/// best kWidth partial sequences of each length. If there are never more, it is exhaustive
/// (`is_exhaustive`), and the plan is the best of this class. `bound` is an upper bound of the
/// value of any plan: it assumes that the fastest ship of each device fetches this device alone,
/// and fails only in members whose winds are at the device's site before that ship can be there.

#include <cstdint>
#include <optional>
#include <vector>

#include "aquafarm/agents/rescue/rescue_outcome.h"
#include "aquafarm/agents/rescue/rescue_problem.h"

namespace aquafarm::agents {

/// Distribution over the members.
struct LossSummary {
  double mean{};
  double standard_error{};
  double q05{};
  double q50{};
  double q95{};
  double cvar05{};  ///< mean of the worst 5 % of the members
};
/// @param losses one per member, at least one
LossSummary Summarize(std::vector<float> losses);
/// Returns the mean of the worst share of the values; the last value of the share may count in
/// part.
/// @param share in (0, 1]
double MeanOfWorst(std::vector<float> losses, double share);

/// Rounds of the search with risk_averse, of a plan and of a plan that is only compared with it.
inline constexpr int kAverseRounds = 12;
inline constexpr int kAverseRoundsToCompare = 3;

/// Makes the best plan.
/// @param averse_rounds max rounds of the search with risk_averse
/// @throws InputError if the numbers of the problem do not fit together
RescuePlan PlanRescue(const RescueProblem& problem, const Ensemble& ensemble,
                      int averse_rounds = kAverseRounds);

/// Plays the orders of a plan in the members of another ensemble with the same ranch and steps.
/// `bound` and `is_exhaustive` of the result are not set.
RescuePlan PlayRescue(const RescueProblem& problem, const Ensemble& ensemble,
                      const RescuePlan& plan);

/// Returns the plan that follows a rule and ignores storms, for comparison: the ship that is free
/// first takes the next device, and delivers at the nearest open port when it is full.
RescuePlan FetchInOrder(const RescueProblem& problem, const Ensemble& ensemble, FetchRule rule);

/// Latest departure to a device.
struct Deadline {
  double probability{};           ///< min chance that the device comes home
  std::optional<double> leave_s;  ///< after the start of the plan; nullopt: no departure reaches it
  bool is_open{};  ///< winds stop the ship in too few members to matter: the end of the known time
                   ///< alone limits leave_s
  std::int32_t ship{kNone};
};
/// Returns, by device and probability, the latest departure of any ship that fetches this device
/// first and brings it to the nearest open port. A ship that leaves at this time succeeds with at
/// least this probability (share of the members); a ship that leaves a step later does not.
std::vector<std::vector<Deadline>> Deadlines(const RescueProblem& problem, const Ensemble& ensemble,
                                             const std::vector<double>& probabilities);

}  // namespace aquafarm::agents
