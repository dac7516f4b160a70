// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// All keys of a scenario and their domains, declared once. An archive is a class that visits them:
///
///   YamlReader    fills the structs from a file and rejects unknown keys
///   YamlWriter    writes the structs and omits unused keys
///   FieldChecker  checks structs created in code or received in messages
///
/// Archives provide Field, Renamed (a key that has an old name), Struct, Optional, Structs (a list
/// of blocks), and Has (whether a key is given). When(used, condition) sets whether the keys after
/// it are in use. Always ends the effect of When.

#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/scenario/limits.h"
#include "scenario/domains.h"
#include "scenario/ranges.h"
#include "scenario/schema_disaster.h"
#include "scenario/schema_family.h"
#include "scenario/schema_kinds.h"

namespace aquafarm::internal {

/// Reference to a field of a netCDF file. Resolve converts it to the values of a SeaLayer.
struct SeaSource {
  std::string file;
  std::string variable;
  double depth_m{};
  /// UTC [s since 1970]. If unset, time.start of the scenario is used. If that is unset too, the
  /// first time of the file is used.
  std::optional<std::int64_t> time;
};

/// Reads a field and interpolates it at the cells of a farm.
/// @throws FieldError if the scenario has no origin, if the file cannot be read or has no such
///   field, or if the field has no value on the farm
void Resolve(const SeaSource& source, const WorldFrame& frame, const std::string& path,
             std::int32_t width, std::int32_t height, SeaLayer& layer);
/// Evaluates an expression of the sea's layers at every cell, [H · W].
/// @throws FieldError if `rule` is not a valid expression, or if there are no layers or layers of
///   different sizes
std::vector<float> ByRule(const std::string& rule, const std::vector<SeaLayer>& layers,
                          const std::string& path);
/// Checks one value per cell. @throws FieldError unless each value is 0, NaN or in `range`
void CheckPerCell(const std::string& path, const std::vector<float>& values, std::int32_t width,
                  Interval<float> range);

template <typename Archive, typename S>
void VisitIslands(Archive& a, S& s) {
  a.Structs("islands", s.islands, {0, kMaxListed}, [](auto& b, auto& island) {
    b.Field("x", island.south_west.x, kAlong, Need::kRequired);
    b.Field("y", island.south_west.y, kAlong, Need::kRequired);
    b.Field("width", island.width, kSide);
    b.Field("height", island.height, kSide);
  });
}

template <typename Archive, typename S>
void VisitRocksAndPorts(Archive& a, S& s) {
  a.Struct("rocks", [&](auto& b) {
    const bool chosen = b.Has("cells", !s.rocks.cells.empty());
    b.When(!chosen, "'cells' is not set");
    b.Field("count", s.rocks.count, Interval<std::int32_t>{0, kMaxSide * kMaxSide});
    b.When(chosen, "'cells' is set");
    b.Field("cells", s.rocks.cells, ListOf<AnyCell>{{}, chosen ? 1U : 0U, kMaxListed});
    b.Always();
    b.Field("reward", s.rocks.reward, kPenalty);
  });
  a.Struct("ports", [&](auto& b) {
    const bool chosen = b.Has("cells", !s.ports.cells.empty());
    b.When(!chosen, "'cells' is not set");
    b.Field("count", s.ports.count, Interval<std::int32_t>{1, kMaxPorts});
    b.When(chosen, "'cells' is set");
    b.Field("cells", s.ports.cells, ListOf<AnyCell>{{}, chosen ? 1U : 0U, kMaxPorts});
    b.Always();
  });
}

template <typename Archive, typename S>
void VisitDevices(Archive& a, S& s) {
  a.Struct("devices", [&](auto& b) {
    auto& devices = s.devices;
    b.Field("placement", devices.placement, OneOfNames{});
    const bool chosen = devices.placement == DevicePlacement::kExplicit;
    b.When(!chosen, "'placement' is not explicit");
    b.Field("count", devices.count, Interval<std::int32_t>{1, kMaxDevices});
    b.Field("kinds", devices.kinds, ListOf<OneOfNames>{{}, 1, kMaxDevices});
    b.Field("self_propelled", devices.self_propelled, Interval<std::int32_t>{0, kMaxDevices});
    b.Always();
    b.Field("value", devices.value, kDeviceValue);
    b.Field("health", devices.health, Interval<float>{0.0F, 1.0F, true});
    b.When(chosen, "'placement' is explicit");
    b.Structs("sites", devices.sites, {0, kMaxDevices}, [](auto& c, auto& site) {
      c.Field("cell", site.cell, AnyCell{}, Need::kRequired);
      c.Field("kind", site.kind, OneOfNames{}, Need::kRequired);
      c.Field("value", site.value, kDeviceValue);
      c.Field("self_propelled", site.self_propelled, AnyFlag{});
      c.Field("insured_value", site.insured_value, kAmount);
    });
    b.Always();
  });
}

template <typename Archive, typename S>
void VisitRewardsAndDamage(Archive& a, S& s) {
  a.Struct("rewards", [&](auto& b) {
    VisitRewardWeights(
        [&b](const RewardKey& key, auto& weight) {
          b.Field(key.name, weight, key.is_penalty ? kPenalty : kReward);
        },
        s.rewards);
    b.Field("sharing", s.rewards.sharing, OneOfNames{});
  });
  a.Struct("damage", [&](auto& b) {
    b.Field("crash_probability", s.damage.crash_probability, kShare);
    b.Field("island_damage", s.damage.island_damage, kShare);
    b.Field("exposure_damage", s.damage.exposure_damage, kShare);
    VisitDamageKinds(b, s.damage);
  });
}

template <typename Archive, typename F>
void VisitEnergyFigures(Archive& a, F& figures, bool carries) {
  constexpr Interval<double> kEnergy{0.0, 1.0e6};
  constexpr Interval<double> kFactor{0.0, 1000.0};
  a.Field("per_km", figures.per_km, kEnergy);
  if (carries) a.Field("per_device", figures.per_device, kFactor);
  a.Field("rough_sea", figures.rough_sea, kFactor);
  a.Field("idle_per_step", figures.idle_per_step, kEnergy);
}

template <typename Archive, typename S>
void VisitEnergy(Archive& a, S& s) {
  a.Optional("energy", s.energy, [](auto& b, auto& energy) {
    b.Field("weight", energy.weight, Interval<double>{0.0, 1000.0});
    VisitEnergyFigures(b, energy.ships, true);
    b.Struct("self_propelled",
             [&](auto& c) { VisitEnergyFigures(c, energy.self_propelled, false); });
  });
}

template <typename Archive, typename S>
void VisitView(Archive& a, S& s) {
  a.Struct("view", [&](auto& b) {
    b.Field("mode", s.view.mode, OneOfNames{});
    b.When(s.view.mode == ViewMode::kPartial, "'mode' is partial");
    b.Field("sensor_radius", s.view.sensor_radius, kRadius);
    b.Field("bulletin_period", s.view.bulletin_period, Interval<std::int32_t>{0, kMaxSteps});
    b.Field("bulletin_noise", s.view.bulletin_noise, Interval<float>{0.0F, 1000.0F});
    b.Field("shared_sight", s.view.shared_sight, AnyFlag{});
    b.When(Archive::kReads || !s.view.forecast_error_km.empty(), "");
    b.Field("forecast_error_km", s.view.forecast_error_km,
            ListOf<Interval<float>>{{0.0F, 10000.0F}, Archive::kReads ? 3U : 0U, 3});
    b.Always();
    b.Renamed("routes", "waterways", s.view.routes, AnyFlag{});
    b.Renamed("lookahead_risk", "courses", s.view.lookahead_risk, AnyFlag{});
    VisitViewKinds(b, s.view);
    b.When(Archive::kReads || s.view.disaster_slots > 0, "");
    b.Field("disaster_slots", s.view.disaster_slots, Interval<std::int32_t>{0, kMaxDisasters});
    b.When(s.view.disaster_slots > 0, "'disaster_slots' is above 0");
    b.Field("forecast_leads_h", s.view.forecast_leads_h,
            ListOf<Interval<float>>{{0.0F, 240.0F, true}, 0, kMaxLeads});
    b.Always();
  });
}

/// Visits one number per cell. A file contains either the numbers, under `key`, or an expression of
/// the layers, under `rule_key`; it may also contain neither. The writer writes the numbers.
template <typename Archive, typename Values>
void VisitPerCell(Archive& a, const char* rule_key, const char* key, const char* condition,
                  const Scenario& scenario, Interval<float> range, Values& values) {
  bool ruled = false;
  if constexpr (Archive::kReads) {
    std::string rule;
    ruled = a.Has(rule_key, false);
    a.Field(rule_key, rule, TextOf{1, 1000});
    const std::string path = Join(a.path(), rule_key);
    if (ruled) values = ByRule(rule, scenario.seas->layers, path);
    const bool one_a_cell = values.size() == static_cast<std::size_t>(scenario.CellCount());
    if (ruled && one_a_cell) CheckPerCell(path, values, scenario.width, range);
  }
  a.When(Archive::kReads ? !ruled : !values.empty(), condition);
  a.Field(key, values, ListOf<NumberOrNone>{{}, 0, kMaxSeaValues});
  a.Always();
}

template <typename Archive, typename S>
void VisitSeas(Archive& a, S& s, const WorldFrame& frame) {
  a.Optional("seas", s.seas, [&](auto& b, auto& sea) {
    b.Structs("layers", sea.layers, {0, kMaxLayers}, [&](auto& c, auto& layer) {
      c.Field("name", layer.name, TextOf{1, 60}, Need::kRequired);
      const bool from_file = c.Has("file", false);
      c.When(!from_file, "'file' is not set");
      c.Field("units", layer.units, TextOf{0, 60});
      c.Field("values", layer.values, ListOf<NumberOrNone>{{}, 1, kMaxSeaValues}, Need::kRequired);
      if constexpr (Archive::kReads) {
        SeaSource source;
        c.When(from_file, "'file' is set");
        c.Field("file", source.file, TextOf{1, 1000}, Need::kRequired);
        c.Field("variable", source.variable, TextOf{1, 200}, Need::kRequired);
        c.Field("depth_m", source.depth_m, Interval<double>{0.0, 12000.0});
        c.Field("time", source.time, UtcTime{});
        if (from_file) Resolve(source, frame, c.path(), s.width, s.height, layer);
      }
      c.Always();
    });
    VisitPerCell(b, "risk", "risk_values", "'risk' is not set", s, kRisk, sea.risk);
    VisitPerCell(b, "device_value", "device_values", "'device_value' is not set", s, kDeviceValue,
                 sea.device_value);
  });
}

template <typename Archive, typename S>
void VisitMoney(Archive& a, S& s) {
  a.Optional("money", s.money, [](auto& b, auto& money) {
    b.Field("currency", money.currency, TextOf{1, 10});
    b.Struct("device_values", [&](auto& c) {
      for (std::size_t kind = 0; kind < money.device_values.size(); ++kind) {
        const std::string key(ToString(static_cast<DeviceKind>(kind)));
        c.Field(key.c_str(), money.device_values[kind], kAmount);
      }
    });
    b.Field("ship_hour", money.ship_hour, kAmount);
    b.Field("kwh", money.kwh, Interval<double>{0.0, 1.0e6});
    b.Field("at_sea_loss", money.at_sea_loss, Interval<double>{0.0, 1.0});
  });
}

/// @param frame set once grid and time are visited; the keys of disasters and of the sea use it
template <typename Archive, typename S>
void VisitScenario(Archive& a, S& s, WorldFrame& frame) {
  a.Field("name", s.name, TextOf{1, 100}, Need::kRequired);
  a.Field("description", s.description, TextOf{0, 4000});
  a.Struct("grid", [&](auto& b) {
    b.Field("width", s.width, kSide);
    b.Field("height", s.height, kSide);
    b.Field("cell_size_m", s.cell_size_m, Interval<double>{0.01, 1.0e6});
    b.Optional("origin", s.origin, [](auto& c, auto& point) { VisitGeoPoint(c, point); });
  });
  a.Struct("time", [&](auto& b) {
    b.Field("step_duration_s", s.step_duration_s, Interval<double>{0.001, 1.0e6});
    b.Field("start", s.start_time, UtcTime{});
    b.Field("step_limit", s.step_limit, Interval<std::int32_t>{1, kMaxSteps});
  });
  frame = {s.origin ? std::optional<GeoFrame>(GeoFrame(*s.origin, s.cell_size_m)) : std::nullopt,
           s.start_time,
           s.step_duration_s,
           s.cell_size_m,
           frame.folder,
           (s.width - 1) / 2.0,
           (s.height - 1) / 2.0};
  a.Struct("layout", [&](auto& b) {
    b.Field("mode", s.layout, OneOfNames{});
    b.When(s.layout == LayoutMode::kFixed, "'mode' is fixed");
    b.Field("seed", s.layout_seed, Interval<std::uint64_t>{0, UINT64_MAX});
    b.Always();
    VisitIslands(b, s);
    VisitRocksAndPorts(b, s);
    VisitDevices(b, s);
  });
  a.Struct("ships", [&](auto& b) {
    b.Field("count", s.ships.count, Interval<std::int32_t>{0, kMaxShips});
    b.Field("capacity", s.ships.capacity, Interval<std::int32_t>{1, kMaxDevices});
  });
  a.Structs("disasters", s.disasters, {0, kMaxDisasters},
            [&](auto& b, auto& disaster) { VisitDisaster(b, disaster, &frame); });
  VisitRewardsAndDamage(a, s);
  VisitEnergy(a, s);
  VisitView(a, s);
  VisitSeas(a, s, frame);
  VisitMoney(a, s);
  VisitFamily(a, s);
}

/// Archive that checks the values of structs, including values of keys that are not in use.
class FieldChecker {
 public:
  static constexpr bool kReads = false;
  explicit FieldChecker(std::string path = "") : path_(std::move(path)) {}
  static bool Has(const char*, bool fallback) { return fallback; }
  static void When(bool, const char*) {}
  static void Always() {}
  const std::string& path() const { return path_; }

  template <typename T, typename Domain>
  void Field(const char* key, const T& value, const Domain& domain, Need = Need::kOptional) const {
    Check(Join(path_, key), value, domain);
  }
  template <typename T, typename Domain>
  void Renamed(const char* key, const char*, const T& value, const Domain& domain) const {
    Check(Join(path_, key), value, domain);
  }
  template <typename Visit>
  void Struct(const char* key, const Visit& visit) const {
    FieldChecker child(Join(path_, key));
    visit(child);
  }
  template <typename T, typename Visit>
  void Optional(const char* key, const std::optional<T>& value, const Visit& visit) const {
    FieldChecker child(Join(path_, key));
    if (value) visit(child, *value);
  }
  template <typename T, typename Visit>
  void Structs(const char* key, const std::vector<T>& values, std::array<std::size_t, 2> sizes,
               const Visit& visit) const {
    const std::string path = Join(path_, key);
    CheckSize(path, values.size(), sizes);
    for (std::size_t i = 0; i < values.size(); ++i) {
      FieldChecker child(At(path, i));
      visit(child, values[i]);
    }
  }

 private:
  std::string path_;
};

}  // namespace aquafarm::internal
