// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Plays plans against simulated storms: were the promised chances kept, and what did the plan
/// save?

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "aquafarm/agents/rescue/rescue_case.h"
#include "rescue/reacting_trial.h"
#include "rescue/trial_storm.h"

namespace aquafarm::agents {

/// Who gives the orders.
enum class TrialPolicy : std::uint8_t {
  kPlan,
  kCentral,    ///< the same search for the forecast alone, without its errors
  kPlanAgain,  ///< the plan, made again at each bulletin; one ship
  kPlanner,    ///< the policy `planner`, which plans again at each bulletin; one ship of the ranch
  kValue,      ///< FetchRule::kValue
  kNearest,    ///< FetchRule::kNearest
  kClairvoyant,  ///< the same search for the true storm
};
inline constexpr std::size_t kTrialPolicyCount = 7;
/// "plan", "central", "plan_again", "planner", "fetch_by_value", "fetch_nearest", "clairvoyant".
std::string_view ToString(TrialPolicy value);

/// A promised probability and what happened.
struct Promise {
  double promised{};
  bool kept{};
};

/// One trial.
struct TrialResult {
  std::size_t track{};  ///< TrialStorm::track
  double lead_h{};
  double nearest_km{};
  double bulletin_mps{};       ///< greatest wind of the bulletin after the start
  std::vector<Promise> home;   ///< of each device that the plan fetches: it came home
  std::vector<Promise> gales;  ///< of each device: the weakest ring reached its site
  double promised{};           ///< value that the plan saves on average over its members
  double at_risk{};            ///< value that is lost if no ship leaves
  /// By TrialPolicy, in the true storm; NaN if the policy is not for these ships and devices.
  std::array<double, kTrialPolicyCount> saved{};
};

/// Mean of the worst 5 % of the losses of two plans, over other members than those of the plans.
struct AverseResult {
  std::size_t track{};  ///< TrialStorm::track
  double mean{};        ///< of the plan with the least mean loss
  double averse{};      ///< of the plan with the least mean of the worst 5 %
};

/// Plans a ranch for many storms.
class PlanTrials {
 public:
  /// @param request with its storm: any one of the archive
  /// @param bulletin_s time between the bulletins of a trial
  PlanTrials(std::shared_ptr<const Scenario> scenario, RescueRequest request,
             std::int64_t bulletin_s = BulletinPeriod({}));

  GeoPoint place() const { return place_; }
  /// @param reacts also play the policies that react to later bulletins
  TrialResult Run(const TrialStorm& storm, bool reacts = true) const;
  /// @param members of the ensemble that compares the plans
  AverseResult CompareAverse(const TrialStorm& storm, std::int32_t members) const;

 private:
  RescueCase CaseOf(const StormTrack& known, std::int64_t start, std::uint64_t seed) const;
  double PlayBulletins(const TrialStorm& storm, const TripModel& model, Skipper& skipper) const;

  RescueRequest request_;
  RescueCase base_;
  std::int64_t bulletin_s_;
  GeoPoint place_;
};

/// Group of each value. Values of one group may depend on each other, groups are independent.
/// Empty: each value is a group of its own.
using Groups = std::vector<std::size_t>;

/// Mean with the half width of its 95 % interval, from the variance between groups
/// (cluster-robust; Liang and Zeger 1986, Biometrika 73(1), 13-22).
struct Estimate {
  double mean{};
  double half{};  ///< infinite for a single group
};
Estimate MeanOf(const std::vector<double>& values, const Groups& groups = {});
/// Ratio of the means of paired values, with the interval of the delta method.
Estimate RatioOf(const std::vector<double>& above, const std::vector<double>& below,
                 const Groups& groups = {});

/// Promises of about one probability. Groups of trials are independent, the devices of one trial
/// are not.
struct PromiseBin {
  double low{};
  double high{};
  std::int64_t count{};
  double promised{};  ///< mean
  Estimate kept;      ///< share
};
/// @param by_trial promises of each trial @param groups of the trials
PromiseBin BinOf(const std::vector<std::vector<Promise>>& by_trial, double low, double high,
                 const Groups& groups = {});

}  // namespace aquafarm::agents
