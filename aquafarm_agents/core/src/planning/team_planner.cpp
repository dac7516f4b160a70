// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/planning/team_planner.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "planning/water_distance.h"

namespace aquafarm::agents {
namespace {

// Steps of a plan for a ship without work, which only avoids risks.
constexpr std::int32_t kIdleSteps = 30;
// Weight of the sum of all ships' times in the cost of an assignment. The time of the ship that
// finishes last has weight 1.
constexpr double kWorkWeight = 1e-3;

// Returns the max number of devices that are assigned to one ship: the average per ship, rounded
// up, plus two. It is in [1, number of devices]; 1 without devices.
std::int32_t MaxDevices(const Scenario& scenario) {
  const std::int32_t devices = scenario.devices.Total();
  const std::int32_t ships = std::max(1, scenario.ships.count);
  return std::max(1, std::min(devices, (devices + ships - 1) / ships + 2));
}

/// Estimates how many steps ships need for their devices in quiet water.
class TravelCostModel {
 public:
  explicit TravelCostModel(const Farm& farm)
      : farm_(farm), capacity_(farm.scenario().ships.capacity) {
    const auto from = [&](const std::vector<Cell>& sources) {
      return WaterDistance(farm.layout(), sources);
    };
    port_ = from(farm.layout().ports);
    for (const Device& device : farm.devices()) device_.push_back(from({device.cell}));
  }

  /// Returns the estimated steps in which a ship fetches the deployed devices of `share`. Each
  /// device counts as a round trip from its nearest port, divided by the capacity. The first trip
  /// starts at the ship's cell. A ship with devices aboard first sails to a port.
  double Time(std::int32_t ship, const std::vector<std::int32_t>& share) const {
    const Ship& one = farm_.ships()[static_cast<std::size_t>(ship)];
    const std::size_t here = Index(one.cell);
    double time = one.aboard > 0 ? port_[here] + 1.0 : 0.0;
    double best_start = -static_cast<double>(kUnreachable);
    for (const std::int32_t id : share) {
      const auto& distance = device_[static_cast<std::size_t>(id)];
      const double to_port = ToPort(id);
      time += (2.0 * to_port + 2.0) / capacity_;
      if (one.aboard == 0) best_start = std::max(best_start, to_port - distance[here]);
    }
    return share.empty() || one.aboard > 0 ? time : time - best_start;
  }
  double ToPort(std::int32_t device) const {
    return port_[Index(farm_.devices()[static_cast<std::size_t>(device)].cell)];
  }

 private:
  std::size_t Index(Cell cell) const {
    return static_cast<std::size_t>(LinearIndex(cell, farm_.scenario().width));
  }

  const Farm& farm_;
  double capacity_;
  std::vector<std::int32_t> port_;                 // [H, W] moves to the nearest port
  std::vector<std::vector<std::int32_t>> device_;  // by device: [H, W] moves to it
};

using Shares = std::vector<std::vector<std::int32_t>>;

double Cost(const TravelCostModel& work, const Shares& shares) {
  double last = 0.0;
  double sum = 0.0;
  for (std::size_t ship = 0; ship < shares.size(); ++ship) {
    const double time = work.Time(static_cast<std::int32_t>(ship), shares[ship]);
    last = std::max(last, time);
    sum += time;
  }
  return last + kWorkWeight * sum;
}

/// Moves and swaps devices between ships while this reduces the cost.
class LocalSearch {
 public:
  /// @param room by ship: max number of devices in its share
  LocalSearch(const TravelCostModel& work, const std::vector<std::size_t>& room, Shares& shares)
      : work_(work), room_(room), shares_(shares), cost_(Cost(work, shares)) {}
  void Run() {
    while (Improve()) {
    }
  }

 private:
  bool Improve() {
    for (std::size_t a = 0; a < shares_.size(); ++a) {
      for (std::size_t i = 0; i < shares_[a].size(); ++i) {
        for (std::size_t b = 0; b < shares_.size(); ++b) {
          if (b != a && (TryMove(a, i, b) || TrySwaps(a, i, b))) return true;
        }
      }
    }
    return false;
  }
  bool TryMove(std::size_t a, std::size_t i, std::size_t b) {
    if (shares_[b].size() >= room_[b]) return false;
    Shares changed = shares_;
    changed[b].push_back(changed[a][i]);
    changed[a].erase(changed[a].begin() + static_cast<std::ptrdiff_t>(i));
    return TakeIfBetter(changed);
  }
  bool TrySwaps(std::size_t a, std::size_t i, std::size_t b) {
    for (std::size_t k = 0; k < shares_[b].size(); ++k) {
      Shares changed = shares_;
      std::swap(changed[a][i], changed[b][k]);
      if (TakeIfBetter(changed)) return true;
    }
    return false;
  }
  bool TakeIfBetter(Shares& changed) {
    const double cost = Cost(work_, changed);
    if (cost >= cost_ - 1e-9) return false;
    cost_ = cost;
    shares_ = std::move(changed);
    return true;
  }

  const TravelCostModel& work_;
  const std::vector<std::size_t>& room_;
  Shares& shares_;
  double cost_;
};

}  // namespace

class TeamPlanner::Impl {
 public:
  Impl(const Scenario& scenario, Foresight foresight)
      : scenario_(scenario), foresight_(foresight), planner_(scenario, MaxDevices(scenario)) {}

  void Act(const Farm& farm, PlanState& plan, std::uint8_t* actions) {
    if (!FollowsPlan(farm, plan)) MakePlan(farm, plan);
    const auto at = static_cast<std::size_t>(farm.step() - plan.start);
    for (std::size_t id = 0; id < plan.actions.size(); ++id) {
      actions[id] = at < plan.actions[id].size() ? plan.actions[id][at] : 0;
    }
  }

  Shares Assign(const Farm& farm) const {
    const TravelCostModel work(farm);
    const auto max_devices = static_cast<std::size_t>(MaxDevices(scenario_));
    Shares shares(static_cast<std::size_t>(scenario_.ships.count));
    // Another policy may have loaded more devices than the planner assigns to a ship.
    std::vector<std::size_t> room(shares.size());
    for (std::size_t ship = 0; ship < shares.size(); ++ship) {
      const auto aboard = static_cast<std::size_t>(farm.ships()[ship].aboard);
      room[ship] = max_devices - std::min(max_devices, aboard);
    }
    std::vector<std::int32_t> waiting;
    for (std::size_t id = 0; id < farm.devices().size(); ++id) {
      const Device& device = farm.devices()[id];
      const bool is_fetched = device.status == DeviceStatus::kDeployed && !device.self_propelled;
      if (is_fetched) waiting.push_back(static_cast<std::int32_t>(id));
    }
    // Assigns the devices with the longest trips first, each to the ship where it costs least.
    std::stable_sort(waiting.begin(), waiting.end(), [&work](std::int32_t a, std::int32_t b) {
      return work.ToPort(a) > work.ToPort(b);
    });
    for (const std::int32_t device : waiting) Give(work, device, room, shares);
    LocalSearch(work, room, shares).Run();
    for (std::size_t id = 0; id < farm.devices().size(); ++id) {
      const Device& device = farm.devices()[id];
      if (device.carrier == kNone) continue;
      auto& share = shares[static_cast<std::size_t>(device.carrier)];
      // A ship may carry more devices than its share holds. A drop-off of the plan delivers them,
      // too.
      if (share.size() < max_devices) share.push_back(static_cast<std::int32_t>(id));
    }
    for (std::size_t id = shares.size(); id < farm.ships().size(); ++id) {
      const Ship& ship = farm.ships()[id];
      shares.push_back(ship.active ? std::vector{ship.own_device} : std::vector<std::int32_t>{});
    }
    return shares;
  }

 private:
  static void Give(const TravelCostModel& work, std::int32_t device,
                   const std::vector<std::size_t>& room, Shares& shares) {
    std::size_t best = shares.size();
    double best_cost = 0.0;
    for (std::size_t ship = 0; ship < shares.size(); ++ship) {
      if (shares[ship].size() >= room[ship]) continue;
      shares[ship].push_back(device);
      const double cost = Cost(work, shares);
      shares[ship].pop_back();
      if (best != shares.size() && cost >= best_cost) continue;
      best = ship;
      best_cost = cost;
    }
    if (best != shares.size()) shares[best].push_back(device);
  }

  bool FollowsPlan(const Farm& farm, PlanState& plan) const {
    if (plan.actions.empty() || plan.seed != farm.seed() || plan.episode != farm.episode() ||
        farm.step() < plan.start) {
      return false;
    }
    const auto at = static_cast<std::size_t>(farm.step() - plan.start);
    for (std::size_t id = 0; id < farm.ships().size(); ++id) {
      const Ship& ship = farm.ships()[id];
      if (!ship.active) continue;
      if (at >= plan.actions[id].size()) return false;
      if (plan.path[id][at] != LinearIndex(ship.cell, scenario_.width)) return false;
    }
    return AreAsForeseen(farm, plan);
  }

  // Returns whether all disasters are as the plan assumed. They are not if Farm::SetDisaster
  // changed one, or if one moved differently from the forecast.
  bool AreAsForeseen(const Farm& farm, PlanState& plan) const {
    if (farm.disasters().size() != plan.disasters.size()) return false;
    for (; plan.foreseen < farm.step(); ++plan.foreseen) {
      for (std::size_t id = 0; id < plan.disasters.size(); ++id) {
        const StreamKey key{farm.seed(), farm.episode(), RngStream::kDisasterTurn,
                            static_cast<std::uint32_t>(id)};
        MoveDisaster(plan.disasters[id], plan.tracks[id], key, plan.foreseen + 1, scenario_.width,
                     scenario_.height);
      }
    }
    for (std::size_t id = 0; id < plan.disasters.size(); ++id) {
      const Disaster& real = farm.disasters()[id];
      const Disaster& foreseen = plan.disasters[id];
      const bool alike = real.x == foreseen.x && real.y == foreseen.y && real.dx == foreseen.dx &&
                         real.dy == foreseen.dy && real.radius == foreseen.radius &&
                         real.quadrant == foreseen.quadrant && real.risk == foreseen.risk &&
                         real.steps_left == foreseen.steps_left;
      if (!alike) return false;
    }
    return true;
  }

  void MakePlan(const Farm& farm, PlanState& plan) {
    const Shares shares = Assign(farm);
    const std::size_t agents = farm.ships().size();
    plan.seed = farm.seed();
    plan.episode = farm.episode();
    plan.start = farm.step();
    plan.actions.assign(agents, {});
    plan.path.assign(agents, {});
    plan.disasters = farm.disasters();
    plan.foreseen = farm.step();
    plan.tracks = Foresee(farm, foresight_, plan.disasters);
    reserved_.Clear();
    for (std::size_t id = 0; id < agents; ++id) {
      const Ship& ship = farm.ships()[id];
      if (!ship.active) continue;
      reserved_.Add(static_cast<std::int32_t>(id), farm.step(),
                    {LinearIndex(ship.cell, scenario_.width)});
    }
    DisasterRisk risks(farm, foresight_);
    for (const bool idle : {false, true}) {  // ships without work are planned last
      for (std::size_t id = 0; id < agents; ++id) {
        if (!farm.ships()[id].active || shares[id].empty() != idle) continue;
        PlanOne(farm, risks, static_cast<std::int32_t>(id), shares[id], plan);
      }
    }
  }

  void PlanOne(const Farm& farm, RiskSource& risks, std::int32_t id,
               const std::vector<std::int32_t>& share, PlanState& plan) {
    Task task;
    task.ship = id;
    task.devices = share;
    task.until = share.empty() ? farm.step() + kIdleSteps : 0;
    task.others = &reserved_;
    auto& actions = plan.actions[static_cast<std::size_t>(id)];
    auto& path = plan.path[static_cast<std::size_t>(id)];
    actions = planner_.Solve(farm, risks, task).actions;
    // There is no plan if other ships enclose this one. It then takes an arbitrary move. In the
    // next step all ships plan again.
    if (actions.empty()) actions = {static_cast<std::uint8_t>(farm.step() % kMoveCount)};
    Cell cell = farm.ships()[static_cast<std::size_t>(id)].cell;
    path.push_back(LinearIndex(cell, scenario_.width));
    for (const std::uint8_t action : actions) {
      cell = After(farm.layout(), cell, action);
      path.push_back(LinearIndex(cell, scenario_.width));
    }
    reserved_.Add(id, farm.step(), path);
  }

  Cell After(const Layout& layout, Cell cell, std::uint8_t action) const {
    if (action >= kMoveCount) return cell;
    const Cell to{cell.x + kMoves[action].x, cell.y + kMoves[action].y};
    const bool on_map = to.x >= 0 && to.y >= 0 && to.x < scenario_.width && to.y < scenario_.height;
    return on_map && (layout.bits(to) & kBlockedBits) == 0 ? to : cell;
  }

  const Scenario& scenario_;
  Foresight foresight_;
  Planner planner_;
  Reservations reserved_;
};

TeamPlanner::TeamPlanner(const Scenario& scenario, Foresight foresight)
    : impl_(std::make_unique<Impl>(scenario, foresight)) {}
TeamPlanner::~TeamPlanner() = default;
TeamPlanner::TeamPlanner(TeamPlanner&&) noexcept = default;

void TeamPlanner::Act(const Farm& farm, PlanState& plan, std::uint8_t* actions) {
  impl_->Act(farm, plan, actions);
}

std::vector<std::vector<std::int32_t>> TeamPlanner::Assign(const Farm& farm) const {
  return impl_->Assign(farm);
}

TeamPlannerPolicy::TeamPlannerPolicy(const EnvironmentSpec& spec, Foresight foresight)
    : scenario_(
          std::make_shared<const Scenario>(ParseScenario(spec.scenario_yaml, spec.scenario_name))),
      planner_(*scenario_, foresight) {}

void TeamPlannerPolicy::Begin(std::uint64_t, std::int32_t farms) {
  plans_.assign(static_cast<std::size_t>(farms), {});
}

void TeamPlannerPolicy::Act(const StepResults& results, std::vector<std::uint8_t>& actions) {
  AQUAFARM_CHECK_EQ(results.states.size(), plans_.size());
  const auto agents = static_cast<std::size_t>(scenario_->AgentCount());
  actions.assign(plans_.size() * agents, 0);
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    const Farm& farm = *results.states[i];
    if (!farm.over()) planner_.Act(farm, plans_[i], actions.data() + i * agents);
  }
}

}  // namespace aquafarm::agents
