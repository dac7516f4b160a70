// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/storms/presets.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "aquafarm/base/angle.h"
#include "aquafarm/base/check.h"
#include "aquafarm/scenario/validate.h"
#include "base/text.h"
#include "scenario/domains.h"

namespace aquafarm {
namespace {

using internal::Interval;

// The keys and numbers of one description. Finish rejects keys that were not queried.
class Keys {
 public:
  Keys(const std::string& text, const std::string& where) : where_(where) {
    for (std::string_view rest = text; !rest.empty();) {
      const std::size_t comma = rest.find(',');
      const std::string_view entry = rest.substr(0, comma);
      rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
      const std::size_t equals = entry.find('=');
      const auto number = equals == std::string_view::npos
                              ? std::nullopt
                              : internal::ParseNumber(entry.substr(equals + 1));
      if (!number) {
        throw InputError(where_ + "got " + internal::Quoted(entry) + ", expected KEY=NUMBER");
      }
      if (!given_.emplace(entry.substr(0, equals), *number).second) {
        throw InputError(where_ + "got " + internal::Quoted(entry.substr(0, equals)) +
                         " twice, expected it once");
      }
    }
  }

  /// @param fallback default value; nullopt if the key is required
  double Take(const std::string& key, const Interval<double>& domain,
              std::optional<double> fallback = std::nullopt) {
    known_.push_back(key);
    const auto found = given_.find(key);
    if (found == given_.end() && fallback) return *fallback;
    if (found == given_.end()) {
      throw InputError(where_ + key + ": missing, expected a number in " +
                       internal::Describe(domain));
    }
    try {
      internal::Check(key, found->second, domain);
    } catch (const InputError& error) {
      throw InputError(where_ + error.what());
    }
    return found->second;
  }

  std::int32_t TakeWhole(const std::string& key, const Interval<double>& domain,
                         std::optional<double> fallback = std::nullopt) {
    const double number = Take(key, domain, fallback);
    if (number == std::floor(number)) return static_cast<std::int32_t>(number);
    throw InputError(where_ + key + ": got " + internal::Format(number) +
                     ", expected a whole number in " + internal::Describe(domain));
  }

  void Finish() const {
    for (const auto& [key, value] : given_) {
      if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
      throw InputError(where_ + "got " + internal::Quoted(key) + ", expected one of " +
                       internal::List(known_));
    }
  }

 private:
  std::string where_;
  std::map<std::string, double> given_;
  std::vector<std::string> known_;
};

// Returns the number of thresholds that `value` reaches.
std::int32_t GradeFrom(double value, const std::array<double, 4>& thresholds) {
  const auto above = std::upper_bound(thresholds.begin(), thresholds.end(), value);
  return static_cast<std::int32_t>(above - thresholds.begin());
}

// Velocity to the east and to the north [m/s].
struct Flow {
  double east{};
  double north{};
};

Flow Towards(double speed_mps, double bearing_deg) {
  const double angle = bearing_deg * kPi / 180.0;
  return {speed_mps * std::sin(angle), speed_mps * std::cos(angle)};
}

Flow TakeCurrent(Keys& keys) {
  const double speed = keys.Take("current_mps", {0.0, 10.0}, 0.0);
  return Towards(speed, keys.Take("current_to_deg", {0.0, 360.0}, 0.0));
}

Flow TakeWindDrift(Keys& keys, bool south) {
  constexpr double kShare = 0.03;
  constexpr double kAside_deg = 15.0;
  const double speed = keys.Take("wind_mps", {0.0, 80.0}, 0.0);
  const double from = keys.Take("wind_from_deg", {0.0, 360.0}, 0.0);
  return Towards(kShare * speed, from + 180.0 + (south ? -kAside_deg : kAside_deg));
}

void SetDrift(const Flow& flow, const GridScale& scale, DisasterSpec& disaster) {
  const double speed_mps = std::hypot(flow.east, flow.north);
  disaster.speed = static_cast<float>(speed_mps * scale.step_duration_s / scale.cell_size_m);
  const double bearing = std::atan2(flow.east, flow.north) * 180.0 / kPi;
  disaster.heading_deg = static_cast<std::int32_t>(std::lround(bearing + 360.0)) % 360;
  // A drifting disaster leaves the map. For a stationary disaster, heading and border are unused.
  disaster.border = speed_mps > 0.0 ? Border::kLeave : Border::kReflect;
  disaster.turn_probability = 0.0F;
}

void SetRings(double radius_km, double growth_m_h, const GridScale& scale, DisasterSpec& disaster) {
  const double radius = radius_km * 1000.0 / scale.cell_size_m;
  disaster.radii = {static_cast<float>(radius / std::sqrt(2.0)), static_cast<float>(radius)};
  disaster.radius_growth =
      static_cast<float>(growth_m_h * scale.step_duration_s / 3600.0 / scale.cell_size_m);
  static const std::array<std::vector<float>, 4> kRisks{
      {{-8.0F, -5.0F}, {-12.0F, -6.0F}, {-16.0F, -8.0F}, {-20.0F, -10.0F}}};
  disaster.risks = kRisks[static_cast<std::size_t>(disaster.grade - 1)];
}

// A kind of preset: `fill` reads its keys and sets the grade, the radius and the drift.
struct Preset {
  const char* name;
  DisasterKind kind;
  void (*fill)(Keys& keys, const GridScale& scale, DisasterSpec& disaster, double& radius_km,
               Flow& flow);
};

constexpr Interval<double> kArea_km2{0.001, 1.0e6};
constexpr Interval<double> kRadius_km{0.001, 2000.0};

double RadiusOf(double area_km2) { return std::sqrt(area_km2 / kPi); }

void FillStorm(Keys& keys, const GridScale&, DisasterSpec& disaster, double& radius_km,
               Flow& flow) {
  // Lower limits of wind force 6, 8, 10 and 12 [m/s].
  disaster.grade = GradeFrom(keys.Take("wind_mps", {10.8, 120.0}), {10.8, 17.2, 24.5, 32.7});
  radius_km = keys.Take("radius_km", kRadius_km);
  flow = TakeCurrent(keys);
}

void FillSurge(Keys& keys, const GridScale&, DisasterSpec& disaster, double& radius_km,
               Flow& flow) {
  disaster.grade = GradeFrom(keys.TakeWhole("level", {1.0, 4.0}), {1.0, 2.0, 3.0, 4.0});
  radius_km = keys.Take("radius_km", kRadius_km);
  flow = TakeCurrent(keys);
}

void FillWave(Keys& keys, const GridScale&, DisasterSpec& disaster, double& radius_km, Flow& flow) {
  disaster.grade = GradeFrom(keys.Take("height_m", {2.5, 30.0}), {2.5, 3.5, 4.5, 6.0});
  radius_km = keys.Take("radius_km", kRadius_km);
  flow = TakeCurrent(keys);
}

void FillRedTide(Keys& keys, const GridScale&, DisasterSpec& disaster, double& radius_km,
                 Flow& flow) {
  const double area = keys.Take("area_km2", kArea_km2);
  disaster.grade = GradeFrom(area, {0.0, 100.0, 500.0, 1000.0});
  radius_km = RadiusOf(area);
  flow = TakeCurrent(keys);
}

void FillSpill(Keys& keys, const GridScale& scale, DisasterSpec& disaster, double& radius_km,
               Flow& flow) {
  radius_km = RadiusOf(keys.Take("area_km2", kArea_km2));
  disaster.grade = keys.TakeWhole("grade", {1.0, 4.0}, 3.0);
  flow = TakeCurrent(keys);
  const Flow drift = TakeWindDrift(keys, scale.south);
  flow = {flow.east + drift.east, flow.north + drift.north};
}

constexpr std::array<Preset, 6> kPresets{{
    {"storm", DisasterKind::kTyphoon, FillStorm},
    {"storm_surge", DisasterKind::kStormSurge, FillSurge},
    {"wave", DisasterKind::kWave, FillWave},
    {"red_tide", DisasterKind::kRedTide, FillRedTide},
    {"oil_spill", DisasterKind::kOilSpill, FillSpill},
    {"chemical_spill", DisasterKind::kChemicalSpill, FillSpill},
}};

const Preset& FindPreset(const std::string& name) {
  for (const Preset& preset : kPresets) {
    if (name == preset.name) return preset;
  }
  throw InputError("disaster: got " + internal::Quoted(name) + ", expected one of " +
                   internal::List(DisasterPresetNames()));
}

}  // namespace

std::vector<std::string> DisasterPresetNames() {
  std::vector<std::string> names;
  names.reserve(kPresets.size());
  for (const Preset& preset : kPresets) names.emplace_back(preset.name);
  return names;
}

DisasterSpec ParseDisasterPreset(const std::string& text, const GridScale& scale) {
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  const Preset& preset = FindPreset(name);
  Keys keys(colon == std::string::npos ? "" : text.substr(colon + 1), "disaster: " + name + ": ");
  DisasterSpec disaster;
  disaster.kind = preset.kind;
  double radius_km = 0.0;
  Flow flow;
  preset.fill(keys, scale, disaster, radius_km, flow);
  const double growth_m_h = keys.Take("growth_m_h", {-10000.0, 10000.0}, 0.0);
  const double duration_h = keys.Take("duration_h", {0.01, 10000.0}, 24.0);
  keys.Finish();
  SetRings(radius_km, growth_m_h, scale, disaster);
  SetDrift(flow, scale, disaster);
  const double steps = std::ceil(duration_h * 3600.0 / scale.step_duration_s);
  disaster.duration = static_cast<std::int32_t>(std::clamp(steps, 1.0, 1.0e7));
  ValidateDisaster(disaster);
  return disaster;
}

}  // namespace aquafarm
