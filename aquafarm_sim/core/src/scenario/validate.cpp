// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/scenario/validate.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "scenario/schema.h"

namespace aquafarm {
namespace {

using internal::At;
using internal::FieldError;
using internal::Format;

// Checks the number, radii and risks of rings. If `waypoint`, no ring may be smaller than the ring
// inside it, and radius 0 means that the ring is absent at that time. If not `waypoint`, each ring
// must be larger than the ring inside it. Risks must be sorted, the worst first.
void CheckRings(const std::string& path, const std::vector<float>& radii,
                const std::vector<float>& risks, std::size_t rings, bool waypoint) {
  const std::string radii_path = internal::Join(path, "radii");
  if (radii.size() != rings) {
    throw FieldError(radii_path,
                     "got " + std::to_string(radii.size()) +
                         " entries, expected as many as risks: " + std::to_string(rings));
  }
  if (risks.size() != rings) {
    throw FieldError(
        internal::Join(path, "risks"),
        "got " + std::to_string(risks.size()) +
            " entries, expected as many as risks of the disaster: " + std::to_string(rings));
  }
  for (std::size_t i = 0; i < rings; ++i) {
    const float inner = i == 0 ? 0.0F : radii[i - 1];
    if (!waypoint && radii[i] <= inner) {
      throw FieldError(At(radii_path, i), "got " + Format(radii[i]) + ", expected more than " +
                                              (i == 0 ? "0" : At("radii", i - 1) + " = ") +
                                              (i == 0 ? "" : Format(inner)));
    }
    if (radii[i] < inner) {
      throw FieldError(At(radii_path, i), "got " + Format(radii[i]) + ", expected at least " +
                                              At("radii", i - 1) + " = " + Format(inner));
    }
    if (i > 0 && risks[i] < risks[i - 1]) {
      throw FieldError(At(internal::Join(path, "risks"), i),
                       "got " + Format(risks[i]) + ", expected at least " + At("risks", i - 1) +
                           " = " + Format(risks[i - 1]) + ", the worst first");
    }
  }
}

// Checks rings by quadrant. If `expected`, there must be one entry per ring, else no entry. Each
// radius must be the largest quadrant of its ring. No quadrant may be larger in an inner ring than
// in an outer one.
void CheckQuadrants(const std::string& path, const std::vector<QuadrantRadii>& quadrants,
                    const std::vector<float>& radii, bool expected) {
  const std::string here = internal::Join(path, "quadrants");
  if (quadrants.empty() == expected || (expected && quadrants.size() != radii.size())) {
    throw FieldError(
        here, "got " + std::to_string(quadrants.size()) +
                  " rings, expected quadrants for every ring at every point of the disaster, "
                  "or at no point");
  }
  for (std::size_t i = 0; i < quadrants.size(); ++i) {
    for (std::size_t q = 0; q < quadrants[i].size(); ++q) {
      if (i == 0 || quadrants[i][q] >= quadrants[i - 1][q]) continue;
      throw FieldError(At(At(here, i), q),
                       "got " + Format(quadrants[i][q]) +
                           ", expected at least the radius of the inner ring, " +
                           Format(quadrants[i - 1][q]));
    }
  }
  if (expected && internal::Largest(quadrants) != radii) {
    throw FieldError(
        here, "got radii that differ from the largest quadrant of each ring, expected equal ones");
  }
}

// Checks that forecasts are in order of issue. The points of each forecast must be in order of time
// and after its issue. Either all of its points or none of them must have rings.
void CheckForecasts(const std::string& path, const DisasterSpec& disaster) {
  const std::vector<IssuedForecast>& forecasts = disaster.forecasts;
  const auto check = [](const std::string& here, float step, float last, const std::string& what) {
    if (step > last) return;
    throw FieldError(
        internal::Join(here, "step"),
        "got " + Format(step) + ", expected more than the step of " + what + Format(last));
  };
  for (std::size_t i = 0; i < forecasts.size(); ++i) {
    const std::string here = At(path, i);
    if (i > 0) check(here, forecasts[i].step, forecasts[i - 1].step, At("forecasts", i - 1) + ", ");
    const std::vector<Waypoint>& points = forecasts[i].points;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const std::string point = At(internal::Join(here, "points"), k);
      if (points[k].radii.empty() != points[0].radii.empty()) {
        throw FieldError(point + ".radii",
                         points[k].radii.empty()
                             ? "missing, expected radii because points[0] has radii"
                             : "got radii, expected none because points[0] has none");
      }
      if (!points[k].radii.empty()) {
        CheckRings(point, points[k].radii, points[k].risks, disaster.risks.size(), true);
        CheckQuadrants(point, points[k].quadrants, points[k].radii, !disaster.quadrants.empty());
      }
      check(At(internal::Join(here, "points"), k), points[k].step,
            k == 0 ? forecasts[i].step : points[k - 1].step,
            k == 0 ? "its issue, " : At("points", k - 1) + ", ");
    }
  }
}

// Checks the constraints between the keys of a disaster.
void CheckDisaster(const std::string& path, const DisasterSpec& disaster) {
  const std::size_t rings = disaster.risks.size();
  for (std::size_t i = 0; i < disaster.track.size(); ++i) {
    const Waypoint& waypoint = disaster.track[i];
    const std::string here = At(internal::Join(path, "track"), i);
    CheckRings(here, waypoint.radii, waypoint.risks, rings, true);
    CheckQuadrants(here, waypoint.quadrants, waypoint.radii, !disaster.quadrants.empty());
    if (i == 0 || waypoint.step > disaster.track[i - 1].step) continue;
    throw FieldError(internal::Join(here, "step"),
                     "got " + Format(waypoint.step) + ", expected more than the step of " +
                         At("track", i - 1) + ", " + Format(disaster.track[i - 1].step));
  }
  const std::vector<std::int32_t>& winds = disaster.ring_winds_kt;
  const std::string winds_path = internal::Join(path, "ring_winds_kt");
  if (!winds.empty() && winds.size() != rings) {
    throw FieldError(winds_path, "got " + std::to_string(winds.size()) +
                                     " entries, expected one per ring: " + std::to_string(rings));
  }
  for (std::size_t i = 1; i < winds.size(); ++i) {
    if (winds[i] < winds[i - 1]) continue;
    throw FieldError(At(winds_path, i), "got " + std::to_string(winds[i]) +
                                            ", expected less than " + At("ring_winds_kt", i - 1) +
                                            " = " + std::to_string(winds[i - 1]));
  }
  const std::string forecasts = internal::Join(path, "forecasts");
  if (disaster.track.empty() && !disaster.forecasts.empty()) {
    throw FieldError(forecasts, "is used only if 'track' is set");
  }
  CheckForecasts(forecasts, disaster);
  CheckRings(path, disaster.radii, disaster.risks, rings, !disaster.track.empty());
  CheckQuadrants(path, disaster.quadrants, disaster.radii, !disaster.quadrants.empty());
}

// Returns whether a name is valid as a variable of expressions and as part of a topic name.
bool IsLayerName(const std::string& name) {
  const auto letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && letter(name[0]) && std::all_of(name.begin(), name.end(), [&](char c) {
    return letter(c) || (c >= '0' && c <= '9') || c == '_';
  });
}

void CheckCellCount(const std::string& path, std::size_t values, const Scenario& scenario) {
  const auto cells = static_cast<std::size_t>(scenario.CellCount());
  if (values == cells) return;
  throw FieldError(path, "got " + std::to_string(values) +
                             " values, expected one per cell: " + std::to_string(cells));
}

// Checks one value per cell. Values computed by a rule were also checked when the rule was read.
void CheckValues(const char* path, const std::vector<float>& values, const Scenario& scenario,
                 internal::Interval<float> range) {
  if (values.empty()) return;
  CheckCellCount(path, values.size(), scenario);
  internal::CheckPerCell(path, values, scenario.width, range);
}

void CheckSeas(const Scenario& scenario) {
  if (!scenario.seas) return;
  const SeaSpec& seas = *scenario.seas;
  std::size_t values = seas.risk.size() + seas.device_value.size();
  for (std::size_t i = 0; i < seas.layers.size(); ++i) {
    const SeaLayer& layer = seas.layers[i];
    const std::string path = At("seas.layers", i);
    if (!IsLayerName(layer.name)) {
      throw FieldError(path + ".name",
                       "got '" + layer.name + "', expected a-z, 0-9 and _, starting with a letter");
    }
    const auto same = [&layer](const SeaLayer& other) { return other.name == layer.name; };
    if (std::count_if(seas.layers.begin(), seas.layers.end(), same) > 1) {
      throw FieldError(path + ".name", "got '" + layer.name + "' twice, expected it once");
    }
    CheckCellCount(path + ".values", layer.values.size(), scenario);
    values += layer.values.size();
  }
  if (values > internal::kMaxSeaValues) {
    throw FieldError("seas", "got " + std::to_string(values) + " values, expected at most " +
                                 std::to_string(internal::kMaxSeaValues));
  }
  CheckValues("seas.risk_values", seas.risk, scenario, internal::kRisk);
  CheckValues("seas.device_values", seas.device_value, scenario, internal::kDeviceValue);
}

// Records the object on each cell and rejects a second object on a cell. Only islands may overlap
// each other.
class Occupancy {
 public:
  enum Thing : std::uint8_t { kNothing, kIsland, kRock, kPort, kDevice };

  explicit Occupancy(const Scenario& scenario)
      : scenario_(scenario), what_(static_cast<std::size_t>(scenario.CellCount()), kNothing) {}

  void PutIsland(const std::string& path, const IslandBlock& block) {
    const Cell first = block.south_west;
    const Cell last{first.x + block.width - 1, first.y + block.height - 1};
    CheckOnMap(path, first);
    CheckOnMap(path, last);
    for (std::int32_t y = first.y; y <= last.y; ++y) {
      for (std::int32_t x = first.x; x <= last.x; ++x) At({x, y}) = kIsland;
    }
  }

  void Put(const std::string& path, Cell cell, Thing what) {
    CheckOnMap(path, cell);
    if (At(cell) != kNothing) {
      constexpr std::array<const char*, 5> kNames{"nothing", "an island", "a rock", "a port",
                                                  "a device"};
      throw FieldError(
          path, "got " + Name(cell) + ", expected a free cell; there is " + kNames[At(cell)]);
    }
    At(cell) = what;
  }

  std::int32_t FreeCells() const {
    return static_cast<std::int32_t>(std::count(what_.begin(), what_.end(), kNothing));
  }

 private:
  static std::string Name(Cell cell) { return "(" + Format(cell.x) + ", " + Format(cell.y) + ")"; }
  void CheckOnMap(const std::string& path, Cell cell) const {
    if (cell.x >= 0 && cell.x < scenario_.width && cell.y >= 0 && cell.y < scenario_.height) return;
    throw FieldError(path, "got " + Name(cell) + ", expected a cell of the map, (0, 0) to " +
                               Name({scenario_.width - 1, scenario_.height - 1}));
  }
  Thing& At(Cell cell) {
    return what_[static_cast<std::size_t>(cell.y * scenario_.width + cell.x)];
  }

  const Scenario& scenario_;
  std::vector<Thing> what_;
};

void CheckFits(const char* path, std::int32_t wanted, std::int32_t& free, const char* of_what) {
  if (wanted > free) {
    throw FieldError(path, "got " + Format(wanted) + ", expected at most the " + Format(free) +
                               " free water cells" + of_what);
  }
  free -= wanted;
}

constexpr std::uint64_t kMaxRoutes = 16'777'216;  // 128 MiB per layout

void CheckPlaces(const Scenario& scenario) {
  // The six planes after the two that RiskBrush paints must have at least kRun - 1 bytes.
  constexpr std::int32_t kFewestCells = 4;
  if (scenario.CellCount() < kFewestCells) {
    throw FieldError("grid", "got " + Format(scenario.CellCount()) + " cells, expected at least " +
                                 Format(kFewestCells));
  }
  const std::uint64_t routes =
      static_cast<std::uint64_t>(scenario.CellCount()) *
      static_cast<std::uint64_t>(scenario.PortCount() + scenario.FetchableCount());
  if (scenario.view.NeedsRoutes() && routes > kMaxRoutes) {
    throw FieldError(scenario.view.tokens ? "view.tokens" : "view.routes",
                     "needs " + Format(routes) +
                         " routes (cells times ports and devices), expected at most " +
                         Format(kMaxRoutes));
  }
  Occupancy occupancy(scenario);
  const auto put_all = [&occupancy](const std::string& path, const auto& cells,
                                    Occupancy::Thing what) {
    for (std::size_t i = 0; i < cells.size(); ++i) occupancy.Put(At(path, i), cells[i], what);
  };
  for (std::size_t i = 0; i < scenario.islands.size(); ++i) {
    occupancy.PutIsland(At("layout.islands", i), scenario.islands[i]);
  }
  put_all("layout.rocks.cells", scenario.rocks.cells, Occupancy::kRock);
  put_all("layout.ports.cells", scenario.ports.cells, Occupancy::kPort);
  const DeviceSpec& devices = scenario.devices;
  const bool chosen = devices.placement == DevicePlacement::kExplicit;
  for (std::size_t i = 0; chosen && i < devices.sites.size(); ++i) {
    occupancy.Put(At("layout.devices.sites", i) + ".cell", devices.sites[i].cell,
                  Occupancy::kDevice);
  }
  std::int32_t free = occupancy.FreeCells();
  const bool drawn_ports = scenario.ports.cells.empty();
  CheckFits("layout.ports.count", drawn_ports ? scenario.ports.count : 0, free, "");
  CheckFits("layout.devices.count", chosen ? 0 : devices.count, free, " that the ports leave");
  CheckFits("layout.rocks.count[1]", scenario.rocks.cells.empty() ? scenario.rocks.count.max : 0,
            free, " that the ports and devices leave");
}

void CheckForecast(const Scenario& scenario) {
  const std::vector<float>& error_km = scenario.view.forecast_error_km;
  if (error_km.empty()) return;
  const std::string path = "view.forecast_error_km";
  if (error_km.size() != 3) {
    throw FieldError(path, "got " + std::to_string(error_km.size()) +
                               " numbers, expected 3: the errors after 24, 48 and 72 hours");
  }
  if (!std::is_sorted(error_km.begin(), error_km.end())) {
    throw FieldError(path, "got an error that shrinks with time, expected ascending numbers");
  }
  if (scenario.view.disaster_slots == 0 &&
      std::none_of(scenario.disasters.begin(), scenario.disasters.end(),
                   [](const DisasterSpec& one) { return !one.track.empty(); })) {
    throw FieldError(path,
                     "is used only if a disaster has a track or view.disaster_slots is above 0");
  }
  for (std::size_t i = 0; i < scenario.disasters.size(); ++i) {
    if (scenario.disasters[i].forecasts.empty()) continue;
    throw FieldError(
        path, "is used only if no disaster has forecasts, but " + At("disasters", i) + " has");
  }
}

void CheckCents(const std::string& path, double amount) {
  const double cents = amount * 100.0;
  if (std::abs(cents - std::round(cents)) < 1.0e-4) return;
  throw FieldError(path, "got " + Format(amount) + ", expected at most two decimals");
}

void CheckMoney(const Scenario& scenario) {
  const std::vector<DeviceSite>& sites = scenario.devices.sites;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (!sites[i].insured_value) continue;
    const std::string path = At("layout.devices.sites", i) + ".insured_value";
    if (!scenario.money) throw FieldError(path, "is used only if 'money' is set");
    CheckCents(path, *sites[i].insured_value);
  }
  if (!scenario.money) return;
  const auto& values = scenario.money->device_values;
  for (std::size_t kind = 0; kind < values.size(); ++kind) {
    CheckCents("money.device_values." + std::string(ToString(static_cast<DeviceKind>(kind))),
               values[kind]);
  }
}

void CheckSlots(const Scenario& scenario) {
  const ViewSpec& view = scenario.view;
  const auto own = static_cast<std::int32_t>(scenario.disasters.size());
  if (own + view.disaster_slots > kMaxDisasters) {
    throw FieldError("view.disaster_slots", "got " + Format(view.disaster_slots) +
                                                ", expected at most " +
                                                Format(kMaxDisasters - own) + " next to the " +
                                                Format(own) + " disasters of the scenario");
  }
  const std::vector<float>& leads = view.forecast_leads_h;
  for (std::size_t i = 1; i < leads.size(); ++i) {
    if (leads[i] > leads[i - 1]) continue;
    throw FieldError(At("view.forecast_leads_h", i),
                     "got " + Format(leads[i]) + ", expected more than the previous lead, " +
                         Format(leads[i - 1]));
  }
}

void CheckAgents(const Scenario& scenario) {
  const DeviceSpec& devices = scenario.devices;
  if (devices.Total() == 0) {
    throw FieldError("layout.devices.sites", "got 0 entries, expected at least 1");
  }
  if (devices.placement != DevicePlacement::kExplicit && devices.self_propelled > devices.count) {
    throw FieldError("layout.devices.self_propelled",
                     "got " + Format(devices.self_propelled) +
                         ", expected at most layout.devices.count = " + Format(devices.count));
  }
  const std::int32_t fetched = scenario.FetchableCount();
  if (scenario.ships.count == 0 && fetched > 0) {
    throw FieldError("ships.count", "got 0, expected at least 1: " + Format(fetched) +
                                        " devices are not self-propelled");
  }
}

void CheckFamily(const Scenario& scenario) {
  if (!scenario.family) return;
  const auto expect = [](bool holds, const char* key, const char* what) {
    if (!holds) throw FieldError(key, std::string("expected ") + what + " in a family of ranches");
  };
  expect(scenario.view.tokens, "view.tokens", "true");
  expect(scenario.layout == LayoutMode::kPerEpisode, "layout.mode", "per_episode");
  expect(scenario.rocks.cells.empty(), "layout.rocks.cells", "no cells");
  expect(scenario.ports.cells.empty(), "layout.ports.cells", "no cells");
  expect(scenario.devices.placement != DevicePlacement::kExplicit, "layout.devices.placement",
         "random, uniform or linear");
  expect(scenario.SelfPropelledCount() == 0, "layout.devices.self_propelled", "0");
  expect(!scenario.seas, "seas", "no sea");
}

}  // namespace

void ValidateDisaster(const DisasterSpec& disaster) {
  internal::FieldChecker checker;
  internal::VisitDisaster(checker, disaster, nullptr);
  CheckDisaster("", disaster);
}

void ValidateScenario(const Scenario& scenario) {
  internal::FieldChecker checker;
  internal::WorldFrame unused;
  internal::VisitScenario(checker, scenario, unused);
  for (std::size_t i = 0; i < scenario.disasters.size(); ++i) {
    CheckDisaster(At("disasters", i), scenario.disasters[i]);
  }
  CheckAgents(scenario);
  CheckPlaces(scenario);
  CheckSeas(scenario);
  CheckForecast(scenario);
  CheckMoney(scenario);
  CheckSlots(scenario);
  CheckFamily(scenario);
}

}  // namespace aquafarm
