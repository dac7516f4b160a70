// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Plays plans in simulated storms. This measures whether the chances that plans promise are
/// correct, and what plans save.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "aquafarm/agents/rescue/rescue_case.h"
#include "rescue/reacting_trial.h"
#include "rescue/trial_storm.h"

namespace aquafarm::agents {

/// How the orders of the ships are chosen.
enum class TrialPolicy : std::uint8_t {
  kPlan,         ///< the plan of the first bulletin
  kCentral,      ///< as kPlan, with the central forecast as the only member
  kPlanAgain,    ///< a new plan at each bulletin; needs one ship
  kPlanner,      ///< the policy `planner` (PlannerSkipper); needs a ranch with one ship, and its
                 ///< devices
  kValue,        ///< FetchRule::kValue
  kNearest,      ///< FetchRule::kNearest
  kClairvoyant,  ///< as kPlan, with the true storm as the only member
};
inline constexpr std::size_t kTrialPolicyCount = 7;
/// Returns "plan", "central", "plan_again", "planner", "fetch_by_value", "fetch_nearest" or
/// "clairvoyant".
std::string_view ToString(TrialPolicy value);

/// A probability of an event, and whether the event happened.
struct Promise {
  double promised{};
  bool kept{};
};

/// Result of one trial.
struct TrialResult {
  std::size_t track{};         ///< TrialStorm::track
  double lead_h{};             ///< TrialStorm::lead_h
  double nearest_km{};         ///< TrialStorm::nearest_km
  double bulletin_mps{};       ///< greatest wind in the forecast of the first bulletin
  std::vector<Promise> home;   ///< for each device that the plan delivers: it reaches a port
  std::vector<Promise> gales;  ///< for each device: the widest ring reaches its site
  double promised{};           ///< value that the plan saves on average over its members
  double at_risk{};            ///< value that is lost in the true storm if no ship leaves
  /// By TrialPolicy: value saved in the true storm; NaN if the policy was not played.
  std::array<double, kTrialPolicyCount> saved{};
};

/// For each of two plans: the mean of the worst 5 % of its losses. The losses are computed in an
/// ensemble whose members differ from those for which the plans were made.
struct AverseResult {
  std::size_t track{};  ///< TrialStorm::track
  double mean{};        ///< of the plan with RescueProblem::risk_averse = 0
  double averse{};      ///< of the plan with RescueProblem::risk_averse = 0.05
};

/// Plans one ranch for many storms.
class PlanTrials {
 public:
  /// @param request must name a storm, which the trials replace
  /// @param bulletin_s time between two bulletins of a trial [s]
  /// @throws InputError in the same cases as MakeRescueCase
  PlanTrials(std::shared_ptr<const Scenario> scenario, RescueRequest request,
             std::int64_t bulletin_s = BulletinPeriod({}));

  /// Middle of the ranch.
  GeoPoint place() const { return place_; }
  /// Plays a trial.
  /// @param reacts whether to play kPlanAgain and kPlanner, too
  TrialResult Run(const TrialStorm& storm, bool reacts = true) const;
  /// Compares a plan with a risk-averse plan.
  /// @param members number of members of the ensemble in which the losses are computed
  AverseResult CompareAverse(const TrialStorm& storm, std::int32_t members) const;

 private:
  RescueCase CaseOf(const StormTrack& known, std::int64_t start, std::uint64_t seed) const;
  double PlayBulletins(const TrialStorm& storm, const TripModel& model, Skipper& skipper) const;

  RescueRequest request_;
  RescueCase base_;
  std::int64_t bulletin_s_;
  GeoPoint place_;
};

/// Contains the number of the group of each value. Groups are independent of each other, but the
/// values of one group may depend on each other. Empty: each value forms its own group.
using Groups = std::vector<std::size_t>;

/// A mean or a ratio with its 95 % interval, from the variance between groups (cluster-robust;
/// Liang and Zeger 1986, Biometrika 73(1), 13-22).
struct Estimate {
  double mean{};
  double half{};  ///< half of the width of the interval; infinite for a single group
};
/// Returns the mean of the values.
Estimate MeanOf(const std::vector<double>& values, const Groups& groups = {});
/// Returns the mean of `above` divided by the mean of `below`, whose values are paired, with the
/// interval of the delta method; 0 ± 0 if the mean of `below` is 0.
Estimate RatioOf(const std::vector<double>& above, const std::vector<double>& below,
                 const Groups& groups = {});

/// Promises with a probability in [low, high).
struct PromiseBin {
  double low{};
  double high{};
  std::int64_t count{};  ///< number of promises
  double promised{};     ///< mean promised probability
  Estimate kept;         ///< share of the promises that were kept
};
/// Returns the bin of [low, high). The promises of one trial may depend on each other.
/// @param by_trial promises of each trial
/// @param groups by trial
PromiseBin BinOf(const std::vector<std::vector<Promise>>& by_trial, double low, double high,
                 const Groups& groups = {});

}  // namespace aquafarm::agents
