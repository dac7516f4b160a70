// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/cell_bits.h"
#include "aquafarm/scenario/enums.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/tracks/track.h"
#include "base/constants.h"
#include "rescue/case_parts.h"
#include "rescue/csv.h"
#include "rescue/sea_routes.h"
#include "rescue/trip_search.h"

namespace aquafarm::agents {
namespace {

std::string Where(GeoPoint place) {
  return Short(std::abs(place.latitude), 4) + (place.latitude < 0.0 ? " S " : " N ") +
         Short(std::abs(place.longitude), 4) + (place.longitude < 0.0 ? " W" : " E");
}

// Returns the water cell nearest to a cell.
Cell NearestWater(const Grid<std::uint8_t>& water, Cell from) {
  Cell nearest = from;
  std::int64_t min_squared = std::numeric_limits<std::int64_t>::max();
  for (std::int32_t y = 0; y < water.rows(); ++y) {
    for (std::int32_t x = 0; x < water.cols(); ++x) {
      const std::int64_t dx = x - from.x;
      const std::int64_t dy = y - from.y;
      if (water(y, x) == 0 || dx * dx + dy * dy >= min_squared) continue;
      min_squared = dx * dx + dy * dy;
      nearest = {x, y};
    }
  }
  return nearest;
}

// Returns the cell of the latitude and longitude in a row. Throws InputError if the position is off
// the chart or not on water.
Cell WaterCell(const CsvRow& row, const std::string& name, const RescueCase& rescue) {
  const GeoPoint place{row.Number("latitude", -90.0, 90.0), row.Number("longitude", -180.0, 360.0)};
  const Grid<std::uint8_t>& water = rescue.problem.water;
  const auto fail = [&](const std::string& what) {
    throw InputError(row.where() + ": " + name + ": got " + Where(place) + ", " + what);
  };
  if (!rescue.frame.Faces(place)) fail("expected a place on the chart of the ranch");
  const std::array<double, 2> at = rescue.frame.ToGrid(place);
  const Cell cell{static_cast<std::int32_t>(std::lround(at[0])),
                  static_cast<std::int32_t>(std::lround(at[1]))};
  const bool on_map = cell.x >= 0 && cell.y >= 0 && cell.x < water.cols() && cell.y < water.rows();
  if (!on_map) {
    fail("expected a place on the chart of the ranch, " + Where(rescue.frame.ToGeo(0, 0)) + " to " +
         Where(rescue.frame.ToGeo(static_cast<double>(water.cols() - 1),
                                  static_cast<double>(water.rows() - 1))) +
         "; correct the place, or move the chart: --place is its middle");
  }
  if (water(cell.y, cell.x) == 0) {
    const Cell nearest = NearestWater(water, cell);
    fail("which is land or rock in cell (" + std::to_string(cell.x) + ", " +
         std::to_string(cell.y) + "), expected water; the nearest water is at " +
         Where(rescue.frame.ToGeo(nearest.x, nearest.y)));
  }
  return cell;
}

std::string KindOf(const CsvRow& row) {
  std::string names;
  const std::string kind = row.Text("kind");
  for (int i = 0; i < kDeviceKindCount; ++i) {
    const auto one = std::string(ToString(static_cast<DeviceKind>(i)));
    if (one == kind) return kind;
    names += (i > 0 ? ", " : "") + one;
  }
  throw InputError(row.where() + ": kind: got '" + kind + "', expected one of: " + names);
}

// Returns the factor of the damage that a typhoon does to a kind of device.
double FactorOf(const Scenario& scenario, const std::string& kind) {
  for (int i = 0; i < kDeviceKindCount; ++i) {
    const auto one = static_cast<DeviceKind>(i);
    if (ToString(one) != kind) continue;
    constexpr auto kTyphoon = static_cast<std::size_t>(DisasterKind::kTyphoon);
    return static_cast<double>(scenario.damage.FactorsOf(one)[kTyphoon]);
  }
  return 1.0;
}

// Reads name and cell of a device or ship from its row, and adds the name to `names`.
template <typename Item>
void ReadPlace(const CsvRow& row, const RescueCase& rescue, std::vector<std::string>& names,
               Item& item) {
  item.name = row.Text("name");
  if (item.name.empty() || std::find(names.begin(), names.end(), item.name) != names.end()) {
    throw InputError(row.where() + ": name: got '" + item.name +
                     "', expected a name that no other row has");
  }
  names.push_back(item.name);
  item.cell = WaterCell(row, item.name, rescue);
}

void ReadDevices(const RescueRequest& request, RescueCase& rescue) {
  std::vector<RescueDevice>& devices = rescue.problem.devices;
  if (request.devices.empty()) {
    for (const PlacedDevice& placed : rescue.layout.devices) {
      devices.push_back({"F" + std::to_string(devices.size()), std::string(ToString(placed.kind)),
                         placed.cell, static_cast<double>(placed.value),
                         1.0 - static_cast<double>(rescue.scenario->devices.health)});
    }
    return;
  }
  const CsvTable table(request.devices, {"name", "latitude", "longitude", "kind", "value"},
                       {"damaged"}, kMaxRescueDevices);
  std::vector<std::string> names;
  for (const CsvRow& row : table.rows()) {
    RescueDevice device;
    ReadPlace(row, rescue, names, device);
    device.kind = KindOf(row);
    device.value = row.Number("value", 0.0, 1.0e12);
    if (!row.Text("damaged").empty()) device.damage_before = row.Number("damaged", 0.0, 1.0);
    const SeaRoutes routes(rescue.problem.water, {device.cell, rescue.problem.ports[0].cell});
    if (!std::isfinite(routes.Length(0, 1))) {
      throw InputError(row.where() + ": " + device.name +
                       ": no way by water leads to the ports; check its position");
    }
    devices.push_back(std::move(device));
  }
}

// Returns when a ship is ready [s after the start]: the time in its row, but at least `fallback_s`.
double ReadyOf(const CsvRow& row, std::int64_t start, double fallback_s) {
  const std::string text = row.Text("ready");
  if (text.empty()) return fallback_s;
  const std::string what = row.where() + ": ready";
  const double ready_s = static_cast<double>(ParseUtc(what, text) - start);
  return std::max(ready_s, fallback_s);
}

void ReadShips(const RescueRequest& request, RescueCase& rescue) {
  const Scenario& scenario = *rescue.scenario;
  const double farm_speed_kn = scenario.cell_size_m / scenario.step_duration_s / kMpsPerKnot;
  const double speed_kn = request.speed_kn.value_or(farm_speed_kn);
  const std::int32_t capacity = request.capacity.value_or(scenario.ships.capacity);
  const auto& ports = rescue.problem.ports;
  std::vector<RescueShip>& ships = rescue.problem.ships;
  if (request.ships_file.empty()) {
    const std::int32_t count = request.ships.value_or(scenario.ships.count);
    for (std::int32_t i = 0; i < count; ++i) {
      const RescuePort& port = ports[static_cast<std::size_t>(i) % ports.size()];
      ships.push_back(
          {"ship " + std::to_string(i + 1), port.cell, speed_kn, capacity, request.depart_s});
    }
    return;
  }
  const CsvTable table(request.ships_file, {"name", "latitude", "longitude"},
                       {"speed_kn", "capacity", "ready"}, kMaxRescueDevices);
  std::vector<std::string> names;
  for (const CsvRow& row : table.rows()) {
    RescueShip ship;
    ReadPlace(row, rescue, names, ship);
    ship.speed_kn = row.Text("speed_kn").empty() ? speed_kn : row.Number("speed_kn", 0.1, 60.0);
    ship.capacity = capacity;
    if (!row.Text("capacity").empty()) {
      ship.capacity = static_cast<std::int32_t>(row.Number("capacity", 1.0, 100.0));
    }
    ship.ready_s = ReadyOf(row, rescue.start, request.depart_s);
    ships.push_back(std::move(ship));
  }
  if (request.ships && static_cast<std::size_t>(*request.ships) != ships.size()) {
    throw InputError("ships: got " + std::to_string(*request.ships) + ", expected " +
                     std::to_string(ships.size()) + ", as in " + request.ships_file);
  }
}

// Returns the energy parameters of the ranch's ships; nullopt if the scenario has none. They
// contain prices only if the devices' values come from a file and are in the currency of the
// prices. (Values of a layout are in units of the reward.)
std::optional<RescueEnergy> EnergyOf(const Scenario& scenario, const RescueRequest& request) {
  if (!scenario.energy) return std::nullopt;
  const EnergyFigures& ships = scenario.energy->ships;
  RescueEnergy energy;
  energy.per_km = ships.per_km;
  energy.per_device = ships.per_device;
  energy.idle_kw = ships.idle_per_step / (scenario.step_duration_s / kHour_s);
  const bool is_in_currency =
      scenario.money && !request.devices.empty() && request.currency == scenario.money->currency;
  if (is_in_currency) {
    energy.per_kwh = scenario.money->kwh;
    energy.per_hour = scenario.money->ship_hour;
  }
  return energy;
}

}  // namespace

double ExposureDamage(const RescueCase& rescue) {
  const Scenario& scenario = *rescue.scenario;
  return static_cast<double>(scenario.damage.exposure_damage) * rescue.ensemble.step_s /
         scenario.step_duration_s;
}

void ReadFleet(const RescueRequest& request, RescueCase& rescue) {
  rescue.problem.depart_s = request.depart_s;
  const Scenario& scenario = *rescue.scenario;
  RescueProblem& problem = rescue.problem;
  problem.water.resize(scenario.height, scenario.width);
  for (std::int32_t y = 0; y < scenario.height; ++y) {
    for (std::int32_t x = 0; x < scenario.width; ++x) {
      problem.water(y, x) = (rescue.layout.bits({x, y}) & kBlockedBits) == 0 ? 1 : 0;
    }
  }
  problem.cell_size_km = scenario.cell_size_m / 1000.0;
  for (const Cell port : rescue.layout.ports) {
    const auto letter = static_cast<char>('A' + problem.ports.size() % 26);
    const std::size_t round = problem.ports.size() / 26;
    problem.ports.push_back(
        {"port " + std::string(1, letter) + (round > 0 ? std::to_string(round + 1) : ""), port,
         true});
  }
  ReadDevices(request, rescue);
  for (RescueDevice& device : problem.devices) {
    device.damage_factor = FactorOf(scenario, device.kind);
  }
  ReadShips(request, rescue);
  problem.handling_s = scenario.step_duration_s;
  problem.exposure_damage = ExposureDamage(rescue);
  problem.risk_averse = request.risk_averse;
  problem.energy = EnergyOf(scenario, request);
}

}  // namespace aquafarm::agents
