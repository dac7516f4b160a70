// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/planning/team_bound.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/agents/planning/risk_source.h"
#include "aquafarm/base/check.h"
#include "aquafarm/farm/energy.h"
#include "planning/water_distance.h"

namespace aquafarm::agents {
namespace {

const double kDiagonal = MoveLength(Action::kNorthEast);
constexpr double kNever = -std::numeric_limits<double>::infinity();

/// Searches the best trip for one device (team_bound.h), forward in time.
class Trip {
 public:
  Trip(const Farm& farm, std::size_t id, const std::vector<std::int32_t>& to_port)
      : scenario_(farm.scenario()),
        layout_(farm.layout()),
        device_(farm.devices()[id]),
        to_port_(to_port),
        site_(Index(device_.cell)),
        health_(device_.health),
        empty_(to_port.size(), kNever),
        laden_(to_port.size(), kNever),
        bare_(to_port.size(), kNever),
        next_(to_port.size()),
        wait_(to_port.size()) {
    shares_way_ = scenario_.ships.capacity > 1 && !device_.self_propelled;
    move_ = shares_way_ ? 0.0 : static_cast<double>(scenario_.rewards.step);
    if (device_.self_propelled) {
      laden_[site_] = value();
      bare_[site_] = 0.0;
    }
    ListWaits(farm.ships().size() > 1);
    if (!scenario_.energy || shares_way_) return;
    energy_ = device_.self_propelled ? scenario_.energy->self_propelled : scenario_.energy->ships;
    weight_ = scenario_.energy->weight;
  }

  DeviceKind kind() const { return device_.kind; }

  /// Advances by one step.
  /// @param risk [H, W] risk in this step
  /// @param damaging [H, W] risk in this step that damages the device
  void Step(const Grid<float>& risk, const Grid<float>& damaging) {
    StartTrips();
    PickUpAndDropOff(risk, damaging);
    const double exposure = static_cast<double>(scenario_.damage.exposure_damage);
    const std::int32_t aboard = device_.self_propelled ? 0 : 1;
    Spread(risk, nullptr, 0.0, 0, empty_);
    Spread(risk, &damaging, exposure * static_cast<double>(device_.value), aboard, laden_);
    Spread(risk, nullptr, 0.0, aboard, bare_);
    laden_[site_] = std::max(laden_[site_], picked_up_for_value_);
    bare_[site_] = std::max(bare_[site_], picked_up_bare_);
    if (!device_.self_propelled) {
      health_ = std::max(0.0F, health_ + scenario_.damage.exposure_damage * damaging.data()[site_]);
    }
  }

  double best() const { return best_; }

  /// Returns whether the search is complete: trips that end later cannot exceed the best one, even
  /// if all disasters end now.
  bool IsOver() const {
    // A risk replaces the step reward. A mild risk may therefore cost less than a step.
    const double move = shares_way_ ? 0.0 : std::max(move_, kMildestRisk);
    double best_case = kNever;
    for (std::size_t cell = 0; cell < laden_.size(); ++cell) {
      const double held = std::max(laden_[cell], bare_[cell]);
      best_case = std::max(best_case, held + drop_off() + move * to_port_[cell]);
    }
    if (!device_.self_propelled) {
      const double pickup = static_cast<double>(scenario_.rewards.pickup);
      const double way = move * to_port_[site_];
      best_case = std::max({best_case, pickup + value() + drop_off() + 2.0 * way,
                            pickup + way});  // the last one without a delivery
    }
    return best_case <= best_;
  }

 private:
  std::size_t Index(Cell cell) const {
    return static_cast<std::size_t>(LinearIndex(cell, scenario_.width));
  }
  double value() const { return static_cast<double>(health_) * static_cast<double>(device_.value); }
  double drop_off() const { return static_cast<double>(scenario_.rewards.drop_off); }

  // Computes for each cell the max reward of one step of waiting in quiet water. A crash, a
  // collision or an illegal action replaces the step reward (Farm::Reward). The damage of a crash
  // is ignored.
  void ListWaits(bool has_others) {
    const RewardSpec& rewards = scenario_.rewards;
    const float anywhere =
        std::max({rewards.step, rewards.illegal, has_others ? rewards.collision : rewards.illegal});
    for (std::int32_t y = 0; y < scenario_.height; ++y) {
      for (std::int32_t x = 0; x < scenario_.width; ++x) {
        float best_case = anywhere;
        ForEachNeighbour({x, y}, [&](Cell to) {
          if ((layout_.bits(to) & kBlockedBits) == 0) return;
          best_case = std::max(best_case, layout_.crash_reward(to.y, to.x));
        });
        wait_[Index({x, y})] = shares_way_ ? 0.0 : static_cast<double>(best_case);
      }
    }
  }

  template <typename Visit>
  void ForEachNeighbour(Cell at, const Visit& visit) const {
    for (const Cell by : kMoves) {
      const Cell to{at.x + by.x, at.y + by.y};
      const bool on_map =
          to.x >= 0 && to.y >= 0 && to.x < scenario_.width && to.y < scenario_.height;
      if (on_map) visit(to);
    }
  }

  void StartTrips() {
    if (device_.self_propelled) return;
    for (const Cell port : layout_.ports) empty_[Index(port)] = std::max(empty_[Index(port)], 0.0);
  }

  void PickUpAndDropOff(const Grid<float>& risk, const Grid<float>& damaging) {
    for (const Cell port : layout_.ports) {
      const auto here = static_cast<double>(risk(port.y, port.x));
      const double held = std::max(laden_[Index(port)], bare_[Index(port)]);
      best_ = std::max(best_, held + drop_off() + Risk(here) - EnergyCost(0.0, 0, 0.0F));
    }
    picked_up_for_value_ = picked_up_bare_ = kNever;
    if (device_.self_propelled || empty_[site_] == kNever) return;
    const auto here = static_cast<double>(risk.data()[site_]);
    const double wear = static_cast<double>(scenario_.damage.exposure_damage * device_.value) *
                        static_cast<double>(damaging.data()[site_]);
    picked_up_bare_ = empty_[site_] + static_cast<double>(scenario_.rewards.pickup) + Risk(here) -
                      EnergyCost(0.0, 0, 0.0F);
    picked_up_for_value_ = picked_up_bare_ + value() + wear;
    best_ = std::max(best_, picked_up_bare_);  // without a delivery
  }

  // Takes one move or one step of waiting from every cell. Each cell keeps the max return of all
  // routes to it.
  // @param damaging nullptr if no damage counts
  // @param aboard number of devices aboard
  void Spread(const Grid<float>& risk, const Grid<float>* damaging, double value_per_risk,
              std::int32_t aboard, std::vector<double>& values) {
    std::fill(next_.begin(), next_.end(), kNever);
    for (std::int32_t y = 0; y < scenario_.height; ++y) {
      for (std::int32_t x = 0; x < scenario_.width; ++x) {
        const double value = values[Index({x, y})];
        if (value == kNever) continue;
        const auto wear = [&](Cell at) {
          return damaging == nullptr
                     ? 0.0
                     : static_cast<double>((*damaging)(at.y, at.x)) * value_per_risk;
        };
        Raise({x, y}, value + Price(risk, {x, y}, wait_[Index({x, y})]) + wear({x, y}) -
                          EnergyCost(0.0, aboard, 0.0F));
        ForEachNeighbour({x, y}, [&](Cell to) {
          if ((layout_.bits(to) & kBlockedBits) != 0) return;
          const double km = (to.x != x && to.y != y ? kDiagonal : 1.0) * cell_km_;
          Raise(to, value + Price(risk, to, move_) + wear(to) -
                        EnergyCost(km, aboard, risk(to.y, to.x)));
        });
      }
    }
    values.swap(next_);
  }
  // Returns the reward of a step that ends in `to`, without energy.
  // @param quiet reward of the step in quiet water
  double Price(const Grid<float>& risk, Cell to, double quiet) const {
    const auto here = static_cast<double>(risk(to.y, to.x));
    return here < 0.0 ? Risk(here) : quiet;
  }
  // Returns the cost of the energy of a step; 0 if shares_way_ is set.
  double EnergyCost(double km, std::int32_t aboard, float risk) const {
    return weight_ == 0.0 ? 0.0 : weight_ * EnergyOf(energy_, km, aboard, risk);
  }
  // Returns the reward of a risk; 0 if shares_way_ is set. A ship that fetches several devices on
  // one route pays the risk only once.
  double Risk(double here) const { return shares_way_ ? 0.0 : here; }
  void Raise(Cell cell, double value) {
    double& known = next_[Index(cell)];
    known = std::max(known, value);
  }

  const Scenario& scenario_;
  const Layout& layout_;
  const Device device_;
  const std::vector<std::int32_t>& to_port_;
  std::size_t site_;
  float health_;
  bool shares_way_{};  // whether a ship may fetch this device together with others
  EnergyFigures energy_;
  double weight_{0.0};  // reward subtracted per kWh
  double cell_km_{scenario_.cell_size_m / 1000.0};
  double move_{};
  double best_{0.0};           // return of the best trip; 0: the device is not fetched
  std::vector<double> empty_;  // by cell: max return so far without the device
  // By cell: max return so far with the device aboard, paid and unpaid (planner.h).
  std::vector<double> laden_;           // paid: the value is credited, damage is subtracted
  std::vector<double> bare_;            // unpaid: neither value nor damage counts
  std::vector<double> next_;            // scratch of Spread
  std::vector<double> wait_;            // by cell: reward of a step of waiting in quiet water
  double picked_up_for_value_{kNever};  // return of a pickup in this step as paid
  double picked_up_bare_{kNever};       // return of a pickup in this step as unpaid
};

}  // namespace

double TeamBound(const Farm& farm) {
  const Scenario& scenario = farm.scenario();
  const RewardSpec& rewards = scenario.rewards;
  for (const auto& [name, value] : {std::pair{"step", rewards.step},
                                    {"illegal", rewards.illegal},
                                    {"collision", rewards.collision}}) {
    if (value <= 0.0F) continue;
    throw InputError("bound: rewards." + std::string(name) +
                     ": got more than 0, expected at most 0; evaluate without the bound");
  }
  if (rewards.drop_off < 0.0F && scenario.ships.capacity > 1) {
    // Each device is charged one drop-off below, but ships can drop several off in one action.
    throw InputError("bound: rewards.drop_off: got less than 0 with ships.capacity " +
                     std::to_string(scenario.ships.capacity) +
                     ", expected at least 0, or a capacity of 1");
  }
  AQUAFARM_CHECK_EQ(farm.step(), 0);
  const std::vector<std::int32_t> to_port = WaterDistance(farm.layout(), farm.layout().ports);
  std::vector<Trip> trips;
  for (std::size_t id = 0; id < farm.devices().size(); ++id) trips.emplace_back(farm, id, to_port);
  std::vector<Disaster> disasters = farm.disasters();
  RiskLayers layers;
  layers.risk.resize(scenario.height, scenario.width);
  for (const DeviceKind kind : KindsThatMatter(farm)) {
    layers.by_kind[static_cast<std::size_t>(kind)].resize(scenario.height, scenario.width);
  }
  bool over = false;
  for (std::int32_t step = 1; step <= scenario.step_limit && !over; ++step) {
    for (std::size_t id = 0; id < disasters.size(); ++id) {
      const StreamKey key{farm.seed(), farm.episode(), RngStream::kDisasterTurn,
                          static_cast<std::uint32_t>(id)};
      MoveDisaster(disasters[id], farm.tracks()[id], key, step, scenario.width, scenario.height);
    }
    FillRisks(scenario, disasters, layers.risk, layers.by_kind);
    over = !disasters.empty() &&
           std::none_of(disasters.begin(), disasters.end(),
                        [](const Disaster& disaster) { return disaster.active(); });
    bool goes_on = false;
    for (Trip& trip : trips) {
      if (trip.IsOver()) continue;
      trip.Step(layers.risk, layers.Damaging(trip.kind()));
      goes_on = true;
    }
    over = over || !goes_on;
  }
  double bound = 0.0;
  for (const Trip& trip : trips) bound += trip.best();
  return bound;
}

}  // namespace aquafarm::agents
