// SPDX-License-Identifier: BSD-3-Clause
#include "rescue/plan_trials.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "aquafarm/base/check.h"
#include "base/constants.h"
#include "rescue/case_parts.h"

namespace aquafarm::agents {
namespace {

// Returns an ensemble whose only member is the central forecast without errors.
Ensemble Certain(const RescueCase& rescue, const CentralForecast& forecast) {
  EnsembleOptions options = rescue.ensemble;
  options.members = 1;
  options.errors.scale = 0.0;
  return {forecast, options, rescue.Sites()};
}

Ensemble TruthOf(const RescueCase& rescue, const StormTrack& truth) {
  CentralForecast forecast;
  forecast.path = ToPath(ToRings(truth, RingReduction::kQuadrants), rescue.frame,
                         rescue.scenario->cell_size_m, rescue.ensemble.step_s, rescue.start);
  forecast.lead_h.assign(forecast.path.points.size(), 0.0);
  forecast.risks = rescue.forecast.risks;
  return Certain(rescue, forecast);
}

double SavedOf(const RescuePlan& plan) {
  return static_cast<double>(plan.loss_idle[0]) - static_cast<double>(plan.loss[0]);
}

}  // namespace

std::string_view ToString(TrialPolicy value) {
  constexpr std::array<std::string_view, kTrialPolicyCount> kNames{
      "plan", "central", "plan_again", "planner", "fetch_by_value", "fetch_nearest", "clairvoyant"};
  return kNames[static_cast<std::size_t>(value)];
}

PlanTrials::PlanTrials(std::shared_ptr<const Scenario> scenario, RescueRequest request,
                       std::int64_t bulletin_s)
    : request_(std::move(request)),
      base_(MakeRescueCase(std::move(scenario), request_)),
      bulletin_s_(bulletin_s) {
  place_ = base_.frame.ToGeo((base_.scenario->width - 1) / 2.0, (base_.scenario->height - 1) / 2.0);
}

RescueCase PlanTrials::CaseOf(const StormTrack& known, std::int64_t start,
                              std::uint64_t seed) const {
  RescueCase rescue = base_;
  rescue.start = start;
  const StormTrack whole = WithForecast(known, NoForecast::kPersist);
  rescue.storm.recorded_until = start;
  rescue.storm.issued = start;
  rescue.storm.known_until = whole.fixes.back().time;
  UseStorm(whole, request_, rescue);
  rescue.ensemble.seed = seed;
  rescue.problem.exposure_damage = ExposureDamage(rescue);
  return rescue;
}

double PlanTrials::PlayBulletins(const TrialStorm& storm, const TripModel& model,
                                 Skipper& skipper) const {
  std::vector<TrialBulletin> bulletins;
  for (std::size_t i = 0; i <= storm.later.size(); ++i) {
    const StormTrack& known = i == 0 ? storm.known : storm.later[i - 1];
    const std::int64_t after_s = static_cast<std::int64_t>(i) * bulletin_s_;
    bulletins.push_back({static_cast<double>(after_s), [this, &known, &storm, after_s, i] {
                           return CaseOf(known, storm.start + after_s, storm.seed + i);
                         }});
  }
  return PlayReacting(model, bulletins, skipper);
}

TrialResult PlanTrials::Run(const TrialStorm& storm, bool reacts) const {
  const RescueCase rescue = CaseOf(storm.known, storm.start, storm.seed);
  const RescueProblem& problem = rescue.problem;
  const Ensemble ensemble(rescue.forecast, rescue.ensemble, rescue.Sites());
  const Ensemble truth = TruthOf(rescue, storm.truth);
  const RescuePlan plan = PlanRescue(problem, ensemble);
  const RescuePlan real = PlayRescue(problem, truth, plan);
  TrialResult result;
  result.track = storm.track;
  result.lead_h = storm.lead_h;
  result.nearest_km = storm.nearest_km;
  for (const StormForecast& forecast : storm.known.forecasts) {
    for (const StormFix& fix : forecast.fixes) {
      result.bulletin_mps = std::max(result.bulletin_mps, fix.wind_mps.value_or(0.0));
    }
  }
  result.promised = plan.saved;
  result.at_risk = static_cast<double>(real.loss_idle[0]);
  const std::int32_t gale = ensemble.rings() - 1;
  for (std::size_t d = 0; d < problem.devices.size(); ++d) {
    const Cell site = problem.devices[d].cell;
    const std::int16_t* arrival = ensemble.Arrival(gale, site);
    const auto reached = std::count_if(arrival, arrival + ensemble.members(),
                                       [](std::int16_t at) { return at != Ensemble::kNoArrival; });
    result.gales.push_back({static_cast<double>(reached) / ensemble.members(),
                            truth.Arrival(gale, site)[0] != Ensemble::kNoArrival});
    if (plan.devices[d].ship == kNone) continue;
    result.home.push_back({plan.devices[d].home, real.devices[d].home > 0.5});
  }
  const RescuePlan central = PlanRescue(problem, Certain(rescue, rescue.forecast));
  double again = std::numeric_limits<double>::quiet_NaN();
  double planner = again;
  if (reacts && problem.ships.size() == 1) {
    const TripModel model(problem, truth);
    PlanAgain skipper;
    again = PlayBulletins(storm, model, skipper);
    if (request_.devices.empty() && rescue.scenario->ships.count == 1) {
      PlannerSkipper farm(rescue);
      planner = PlayBulletins(storm, model, farm);
    }
  }
  result.saved = {SavedOf(real),
                  SavedOf(PlayRescue(problem, truth, central)),
                  again,
                  planner,
                  SavedOf(FetchInOrder(problem, truth, FetchRule::kValue)),
                  SavedOf(FetchInOrder(problem, truth, FetchRule::kNearest)),
                  SavedOf(PlanRescue(problem, truth))};
  return result;
}

AverseResult PlanTrials::CompareAverse(const TrialStorm& storm, std::int32_t members) const {
  RescueCase rescue = CaseOf(storm.known, storm.start, storm.seed);
  const Ensemble ensemble(rescue.forecast, rescue.ensemble, rescue.Sites());
  EnsembleOptions others = rescue.ensemble;
  others.members = members;
  others.seed ^= 0x5eed5eedULL;
  const Ensemble scoring(rescue.forecast, others, rescue.Sites());
  constexpr double kShare = 0.05;
  const auto worst = [&](double risk_averse) {
    rescue.problem.risk_averse = risk_averse;
    const RescuePlan plan = PlanRescue(rescue.problem, ensemble);
    return MeanOfWorst(PlayRescue(rescue.problem, scoring, plan).loss, kShare);
  };
  return {storm.track, worst(0.0), worst(kShare)};
}

Estimate MeanOf(const std::vector<double>& values, const Groups& groups) {
  return RatioOf(values, std::vector<double>(values.size(), 1.0), groups);
}

Estimate RatioOf(const std::vector<double>& above, const std::vector<double>& below,
                 const Groups& groups) {
  AQUAFARM_CHECK_EQ(above.size(), below.size());
  if (!groups.empty()) AQUAFARM_CHECK_EQ(groups.size(), above.size());
  const double base = std::accumulate(below.begin(), below.end(), 0.0);
  if (base == 0.0) return {};
  const double ratio = std::accumulate(above.begin(), above.end(), 0.0) / base;
  std::map<std::size_t, double> rest;  // by group: sum of the residuals
  for (std::size_t i = 0; i < above.size(); ++i) {
    rest[groups.empty() ? i : groups[i]] += above[i] - ratio * below[i];
  }
  if (rest.size() < 2) return {ratio, std::numeric_limits<double>::infinity()};
  double squares = 0.0;
  for (const auto& [group, sum] : rest) squares += sum * sum;
  const auto count = static_cast<double>(rest.size());
  return {ratio, kNormal95 * std::sqrt(squares * count / (count - 1.0)) / std::abs(base)};
}

PromiseBin BinOf(const std::vector<std::vector<Promise>>& by_trial, double low, double high,
                 const Groups& groups) {
  PromiseBin bin;
  bin.low = low;
  bin.high = high;
  std::vector<double> kept;
  std::vector<double> number;
  for (const std::vector<Promise>& trial : by_trial) {
    double kept_here = 0.0;
    double number_here = 0.0;
    for (const Promise& one : trial) {
      if (one.promised < low || one.promised >= high) continue;
      bin.promised += one.promised;
      number_here += 1.0;
      kept_here += one.kept ? 1.0 : 0.0;
    }
    bin.count += static_cast<std::int64_t>(number_here);
    kept.push_back(kept_here);
    number.push_back(number_here);
  }
  if (bin.count == 0) return bin;
  bin.promised /= static_cast<double>(bin.count);
  bin.kept = RatioOf(kept, number, groups);
  return bin;
}

}  // namespace aquafarm::agents
