// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/rescue/rescue_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "aquafarm/base/check.h"
#include "rescue/follow_trips.h"
#include "rescue/trip_cache.h"
#include "rescue/trip_search.h"

namespace aquafarm::agents {
namespace {

// Max number of teams (struct Team) that the search keeps after each ship.
constexpr std::size_t kMaxTeams = 3000;
// Max number of plans per set of devices in a risk-averse search.
constexpr std::size_t kAlternatives = 8;

// A combination of the trips of the ships considered so far.
struct Team {
  DeviceSet devices{};                 // delivered by any of the ships
  double net{};                        // value saved minus cost
  std::vector<const TripPlan*> trips;  // by ship; nullptr: the ship stays
};

void RequireValid(const RescueProblem& problem) {
  const auto require = [](bool ok, const std::string& name, const std::string& what) {
    if (!ok) throw InputError(name + ": " + what);
  };
  require(problem.devices.size() <= kMaxRescueDevices, "devices",
          "got " + std::to_string(problem.devices.size()) + ", expected at most " +
              std::to_string(kMaxRescueDevices));
  require(!problem.ports.empty(), "ports", "got none, expected at least one");
  require(problem.risk_averse >= 0.0 && problem.risk_averse <= 1.0, "risk averse",
          "got " + std::to_string(problem.risk_averse) + ", expected a share in [0, 1]");
  for (const RescueDevice& device : problem.devices) {
    require(std::isfinite(device.value) && device.value >= 0.0, device.name,
            "value: got " + std::to_string(device.value) + ", expected a number of at least 0");
    require(
        device.damage_before >= 0.0 && device.damage_before <= 1.0, device.name,
        "damaged: got " + std::to_string(device.damage_before) + ", expected a share in [0, 1]");
  }
  std::vector<std::int32_t> carriers(problem.devices.size(), 0);
  for (const RescueShip& ship : problem.ships) {
    for (const std::int32_t device : ship.aboard) {
      const bool exists = device >= 0 && static_cast<std::size_t>(device) < carriers.size();
      require(exists && ++carriers[static_cast<std::size_t>(device)] == 1, ship.name,
              "aboard: expected devices of the problem, each aboard one ship");
    }
    require(ship.speed_kn > 0.0 && std::isfinite(ship.speed_kn), ship.name,
            "speed: got " + std::to_string(ship.speed_kn) + " knots, expected more than 0");
    require(ship.capacity >= 1, ship.name,
            "capacity: got " + std::to_string(ship.capacity) + ", expected at least 1");
    require(ship.ready_s >= 0.0, ship.name,
            "ready: got " + std::to_string(ship.ready_s) +
                " s, expected a time after the start of the plan");
  }
}

RescuePlan PlanOf(const TripModel& model, const Team& team) {
  std::vector<ShipTrips> trips;
  for (std::size_t ship = 0; ship < team.trips.size(); ++ship) {
    if (team.trips[ship] != nullptr) trips.push_back({ship, team.trips[ship]->stops});
  }
  return FollowTrips(model, trips);
}

// Sorts the teams, the best one first. Keeps at most `alternatives` teams for each set of devices,
// and at most kMaxTeams in total. Returns whether the latter limit was exceeded.
bool Narrow(std::vector<Team>& teams, std::size_t alternatives) {
  std::stable_sort(teams.begin(), teams.end(),
                   [](const Team& a, const Team& b) { return a.net > b.net; });
  std::map<DeviceSet, std::size_t> count;
  const auto is_spare = [&](const Team& team) { return ++count[team.devices] > alternatives; };
  teams.erase(std::remove_if(teams.begin(), teams.end(), is_spare), teams.end());
  if (teams.size() <= kMaxTeams) return false;
  teams.resize(kMaxTeams);
  return true;
}

// Searches the teams with the highest net value. It is a weighted mean over the members.
class TeamSearch {
 public:
  /// @param cache must outlive the search
  TeamSearch(const TripModel& model, std::size_t alternatives, TripCache& cache,
             const MemberWeights& weights = {})
      : teams_(1) {
    const RescueProblem& problem = model.problem();
    for (std::size_t ship = 0; ship < problem.ships.size(); ++ship) {
      AddShip(problem.ships[ship], cache.Of(model, ship, alternatives, weights));
      if (Narrow(teams_, alternatives)) is_exhaustive_ = false;
    }
  }

  const std::vector<Team>& teams() const { return teams_; }  // the best team first
  bool is_exhaustive() const { return is_exhaustive_; }

 private:
  void AddShip(const RescueShip& ship, const TripTable& table) {
    is_exhaustive_ = is_exhaustive_ && table.is_exhaustive;
    std::vector<Team> next;
    for (const Team& team : teams_) {
      if (ship.aboard.empty() || table.plans.empty()) {  // the ship stays
        next.push_back(team);
        next.back().trips.push_back(nullptr);
      }
      for (const auto& [devices, plans] : table.plans) {
        if ((team.devices & devices) != 0) continue;
        for (const TripPlan& trips : plans) {
          next.push_back({team.devices | devices, team.net + trips.net, team.trips});
          next.back().trips.push_back(&trips);
        }
      }
    }
    teams_ = std::move(next);
  }

  std::vector<Team> teams_;
  bool is_exhaustive_{true};
};

// Searches the plan with the smallest objective: the mean loss of the worst members plus cost. This
// mean equals the max of the weighted mean loss over all weights that sum to 1 and are at most
// 1 / (share · members) each. The search is fictitious play (Brown 1951, Iterative solution of
// games by fictitious play). Each round averages the weights of AddTail over the first plan and the
// best plans of all previous rounds. The trip search then finds the best plans for these weights.
// The smallest weighted loss plus cost is a lower bound of the objective of every plan.
// All members get a small additional weight, so that a plan also contains trips that help only in
// members that are not among the worst. The mixed weights are still at most 1 / (share · members)
// each, so the bound remains valid. Of plans with equal objectives the one with the best mean is
// taken.
class AverseSearch {
 public:
  AverseSearch(const TripModel& model, const TeamSearch& by_mean, RescuePlan best, int rounds)
      : model_(model), best_(std::move(best)), last_(best_) {
    is_exhaustive_ = by_mean.is_exhaustive();
    Consider(by_mean, kConsideredByMean);
    std::vector<double> sum(best_.loss.size(), 0.0);
    for (int round = 1; round <= rounds && !IsEnough(); ++round) {
      AddTail(last_.loss, sum);
      const double others = kOthers / static_cast<double>(sum.size());
      MemberWeights weights;
      for (const double one : sum) {
        weights.push_back(static_cast<float>((1.0 - kOthers) * one / round + others));
      }
      TripCache weighted;
      const TeamSearch search(model, kAlternatives, weighted, weights);
      last_ = PlanOf(model, search.teams().front());
      double loss = last_.cost;
      for (std::size_t m = 0; m < weights.size(); ++m) {
        loss += static_cast<double>(weights[m]) * static_cast<double>(last_.loss[m]);
      }
      bound_ = std::max(bound_, loss);
      is_exhaustive_ = is_exhaustive_ && search.is_exhaustive();
      Consider(search, kConsidered);
    }
  }

  RescuePlan Take() {
    best_.averse_gap = is_exhaustive_ ? std::max(0.0, Value(best_) - bound_)
                                      : std::numeric_limits<double>::infinity();
    return std::move(best_);
  }

 private:
  static constexpr std::size_t kConsideredByMean = 300;  // max plans taken from the first search
  static constexpr std::size_t kConsidered = 40;         // max plans taken from each round
  static constexpr double kEnough = 1e-4;                // absolute tolerance in IsEnough
  static constexpr double kOthers = 1e-4;  // total weight that is spread equally over all members

  double Share() const { return model_.problem().risk_averse; }
  double Value(const RescuePlan& plan) const { return MeanOfWorst(plan.loss, Share()) + plan.cost; }

  bool IsEnough() const { return Value(best_) <= bound_ + kEnough + kOthers * Value(best_); }
  bool IsBetter(const RescuePlan& a, const RescuePlan& b) const {
    const double difference = Value(a) - Value(b);
    const double same = 1e-6 * std::max(1.0, std::abs(Value(b)));  // rounding of float losses
    if (std::abs(difference) > same) return difference < 0.0;
    return a.saved - a.cost > b.saved - b.cost + same;
  }

  void Consider(const TeamSearch& search, std::size_t limit) {
    for (std::size_t i = 0; i < std::min(limit, search.teams().size()); ++i) {
      RescuePlan other = PlanOf(model_, search.teams()[i]);
      if (IsBetter(other, best_)) best_ = std::move(other);
    }
  }

  // Adds to `sum` the weights with which the weighted loss is the mean loss of the worst members.
  void AddTail(const std::vector<float>& losses, std::vector<double>& sum) const {
    std::vector<std::size_t> order(losses.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return losses[a] > losses[b]; });
    const double wanted = std::max(1e-9, Share() * static_cast<double>(losses.size()));
    double rest = wanted;
    for (std::size_t i = 0; i < order.size() && rest > 0.0; ++i, rest -= 1.0) {
      sum[order[i]] += std::min(1.0, rest) / wanted;
    }
  }

  const TripModel& model_;
  RescuePlan best_;
  RescuePlan last_;
  double bound_{-std::numeric_limits<double>::infinity()};
  bool is_exhaustive_{true};
};

}  // namespace

double MeanOfWorst(std::vector<float> losses, double share) {
  AQUAFARM_CHECK_LT(std::size_t{0}, losses.size());
  std::sort(losses.begin(), losses.end(), std::greater<>());
  const double wanted = std::max(1e-9, share * static_cast<double>(losses.size()));
  double sum = 0.0;
  double rest = wanted;
  for (std::size_t i = 0; i < losses.size() && rest > 0.0; ++i, rest -= 1.0) {
    sum += static_cast<double>(losses[i]) * std::min(1.0, rest);
  }
  return sum / wanted;
}

LossSummary Summarize(std::vector<float> losses) {
  AQUAFARM_CHECK_LT(std::size_t{0}, losses.size());
  std::sort(losses.begin(), losses.end());
  const auto count = static_cast<double>(losses.size());
  LossSummary summary;
  for (const float loss : losses) summary.mean += static_cast<double>(loss) / count;
  double squares = 0.0;
  for (const float loss : losses) {
    squares += std::pow(static_cast<double>(loss) - summary.mean, 2.0);
  }
  summary.standard_error = losses.size() < 2 ? 0.0 : std::sqrt(squares / (count - 1.0) / count);
  const auto quantile = [&](double share) {
    return static_cast<double>(losses[static_cast<std::size_t>(share * (count - 1.0) + 0.5)]);
  };
  summary.q05 = quantile(0.05);
  summary.q50 = quantile(0.5);
  summary.q95 = quantile(0.95);
  summary.cvar05 = MeanOfWorst(losses, 0.05);
  return summary;
}

RescuePlan PlanRescue(const RescueProblem& problem, const Ensemble& ensemble, int averse_rounds) {
  TripCache cache;
  return PlanRescue(problem, ensemble, averse_rounds, cache);
}

RescuePlan PlanRescue(const RescueProblem& problem, const Ensemble& ensemble, int averse_rounds,
                      TripCache& cache) {
  RequireValid(problem);
  const TripModel model(problem, ensemble);
  const bool is_averse = problem.risk_averse > 0.0;
  const TeamSearch search(model, is_averse ? kAlternatives : 1, cache);
  RescuePlan best = PlanOf(model, search.teams().front());  // the plan with the best mean
  if (is_averse) best = AverseSearch(model, search, std::move(best), averse_rounds).Take();
  for (std::size_t d = 0; d < problem.devices.size(); ++d) best.bound += model.BoundOf(d);
  best.is_exhaustive = search.is_exhaustive();
  return best;
}

RescuePlan PlayRescue(const RescueProblem& problem, const Ensemble& ensemble,
                      const RescuePlan& plan) {
  RequireValid(problem);
  const TripModel model(problem, ensemble);
  std::vector<ShipTrips> trips;
  for (const ShipRoute& route : plan.routes) {
    ShipTrips one{static_cast<std::size_t>(route.ship), {}};
    for (const RescueOrder& order : route.orders) {
      if (order.kind == OrderKind::kLeave) continue;
      const bool is_fetch = order.kind == OrderKind::kFetch;
      one.stops.push_back(
          {order.kind, static_cast<std::size_t>(is_fetch ? order.device : order.port)});
    }
    trips.push_back(std::move(one));
  }
  return FollowTrips(model, trips);
}

RescuePlan FetchInOrder(const RescueProblem& problem, const Ensemble& ensemble, FetchRule rule) {
  RequireValid(problem);
  const TripModel model(problem, ensemble);
  return FollowTrips(model, SimpleTrips(model, rule));
}

}  // namespace aquafarm::agents
