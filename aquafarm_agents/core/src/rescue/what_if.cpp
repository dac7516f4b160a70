// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/rescue/what_if.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "rescue/trip_cache.h"

namespace aquafarm::agents {
namespace {

WhatIf Compare(const std::string& change, const std::string& text, const RescuePlan& plan,
               const RescuePlan& other) {
  WhatIf row;
  row.change = change;
  row.text = text;
  row.loss = Summarize(other.loss);
  const auto count = static_cast<double>(plan.loss.size());
  double squares = 0.0;
  for (std::size_t member = 0; member < plan.loss.size(); ++member) {
    const double by =
        static_cast<double>(other.loss[member]) - static_cast<double>(plan.loss[member]);
    row.difference += by / count;
    squares += by * by / count;
    row.devices_home += other.home_count[member] / count;
    row.all_home += other.home_count[member] == plan.devices.size() ? 1.0 / count : 0.0;
  }
  const double variance = std::max(0.0, squares - row.difference * row.difference);
  const double half = kNormal95 * std::sqrt(variance / count);
  row.difference_low = row.difference - half;
  row.difference_high = row.difference + half;
  return row;
}

class Changes {
 public:
  Changes(const RescueProblem& problem, const Ensemble& ensemble, const RescuePlan& plan)
      : problem_(problem), ensemble_(ensemble), plan_(plan) {
    AddShip();
    RemoveShip();
    for (const int hours : {3, 6, 12}) Depart(hours);
    for (std::size_t port = 0; port < problem.ports.size(); ++port) ClosePort(port);
    RescueProblem larger = problem;
    for (RescueShip& ship : larger.ships) ++ship.capacity;
    if (!larger.ships.empty()) {
      rows_.push_back(Compare("capacity+1", "every ship carries one more device", plan,
                              PlanMore(larger, Plan(larger))));
    }
    std::stable_sort(rows_.begin(), rows_.end(), [](const WhatIf& a, const WhatIf& b) {
      if (a.is_possible != b.is_possible) return a.is_possible;
      return a.loss.mean < b.loss.mean;
    });
    rows_.insert(rows_.begin(), Compare("none", "the plan without a change", plan, plan));
  }
  std::vector<WhatIf> Take() { return std::move(rows_); }

 private:
  RescuePlan Plan(const RescueProblem& changed) const {
    return PlanRescue(changed, ensemble_, kAverseRoundsToCompare);
  }
  // Does the same as Plan, but with the cache. `changed` must differ only in ships without devices
  // aboard.
  RescuePlan PlanShips(const RescueProblem& changed) {
    return PlanRescue(changed, ensemble_, kAverseRoundsToCompare, cache_);
  }
  // Returns `found`. With risk_averse, returns the original plan if it is better: the change still
  // permits it, and the short search may find a worse plan.
  RescuePlan PlanMore(const RescueProblem& changed, RescuePlan found) const {
    const double share = changed.risk_averse;
    if (share <= 0.0) return found;
    RescuePlan kept = PlayRescue(changed, ensemble_, plan_);
    const auto value = [share](const RescuePlan& plan) {
      return MeanOfWorst(plan.loss, share) + plan.cost;
    };
    return value(kept) < value(found) ? kept : found;
  }
  void Add(const std::string& change, const std::string& text, const RescueProblem& changed) {
    rows_.push_back(Compare(change, text, plan_, Plan(changed)));
  }
  void AddImpossible(const std::string& change, const std::string& text) {
    WhatIf row;
    row.change = change;
    row.text = text;
    row.is_possible = false;
    rows_.push_back(row);
  }

  // Returns the ship to add: a copy of the first ship that has no devices aboard. If every ship has
  // devices aboard, copies the first ship, removes its devices and makes it ready at depart_s or
  // later.
  RescueShip OneMore() const {
    const auto is_empty = [](const RescueShip& ship) { return ship.aboard.empty(); };
    const auto& ships = problem_.ships;
    const auto found = std::find_if(ships.begin(), ships.end(), is_empty);
    RescueShip more = found == ships.end() ? ships.front() : *found;
    if (found == ships.end()) more.ready_s = std::max(more.ready_s, problem_.depart_s);
    more.aboard.clear();
    return more;
  }

  // Adds a ship at the port where it reduces the mean loss most.
  void AddShip() {
    std::optional<WhatIf> best;
    for (const RescuePort& port : problem_.ports) {
      if (!port.is_open || problem_.ships.empty()) continue;
      RescueProblem changed = problem_;
      changed.ships.push_back(OneMore());
      changed.ships.back().cell = port.cell;
      WhatIf row = Compare("ships+1", "one ship more, at " + port.name, plan_,
                           PlanMore(changed, PlanShips(changed)));
      if (!best || row.loss.mean < best->loss.mean) best = std::move(row);
    }
    if (best) rows_.push_back(std::move(*best));
  }

  // Removes the ship whose absence increases the mean loss least.
  void RemoveShip() {
    if (problem_.ships.size() < 2) {
      return AddImpossible("ships-1", "one ship fewer: no ship is left");
    }
    std::optional<WhatIf> best;
    for (std::size_t ship = 0; ship < problem_.ships.size(); ++ship) {
      if (!problem_.ships[ship].aboard.empty()) continue;  // it must deliver its devices
      RescueProblem changed = problem_;
      changed.ships.erase(changed.ships.begin() + static_cast<std::ptrdiff_t>(ship));
      WhatIf row = Compare("ships-1", "one ship fewer, without " + problem_.ships[ship].name, plan_,
                           PlanShips(changed));
      if (!best || row.loss.mean < best->loss.mean) best = std::move(row);
    }
    if (best) return rows_.push_back(std::move(*best));
    AddImpossible("ships-1", "one ship fewer: every ship has devices aboard");
  }

  void Depart(int hours) {
    RescueProblem changed = problem_;
    bool all_wait = true;
    for (RescueShip& ship : changed.ships) {
      if (ship.aboard.empty()) ship.ready_s += 3600.0 * hours;
      all_wait = all_wait && ship.aboard.empty();
    }
    Add("depart+" + std::to_string(hours) + "h",
        (all_wait ? "all ships leave " : "all ships without devices aboard leave ") +
            std::to_string(hours) + " hours later",
        changed);
  }

  void ClosePort(std::size_t port) {
    RescueProblem changed = problem_;
    changed.ports[port].is_open = false;
    const std::string change = "port_closed:" + std::to_string(port);
    const std::string text = problem_.ports[port].name + " takes no devices";
    const bool is_possible = std::any_of(changed.ports.begin(), changed.ports.end(),
                                         [](const RescuePort& one) { return one.is_open; });
    is_possible ? Add(change, text, changed) : AddImpossible(change, text + ": no port is left");
  }

  const RescueProblem& problem_;
  const Ensemble& ensemble_;
  const RescuePlan& plan_;
  TripCache cache_;  // for PlanShips
  std::vector<WhatIf> rows_;
};

}  // namespace

std::vector<WhatIf> CompareChanges(const RescueProblem& problem, const Ensemble& ensemble,
                                   const RescuePlan& plan) {
  return Changes(problem, ensemble, plan).Take();
}

}  // namespace aquafarm::agents
