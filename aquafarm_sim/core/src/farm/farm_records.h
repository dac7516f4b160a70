// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The records of a saved episode. The fields of each record are listed once, for writing and for
// reading.
#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/farm.h"

namespace aquafarm {

// A disaster with its last bulletin, as one record of a saved state.
struct SavedDisaster : Disaster {
  Bulletin bulletin;
};

}  // namespace aquafarm

namespace aquafarm::internal {

using nlohmann::json;

template <typename Enum>
std::int32_t Int(Enum value) {
  return static_cast<std::int32_t>(value);
}

// Returns whether the rings of a bulletin must be stored, because the rings of the disaster may
// have grown or shrunk since the bulletin was issued. A disaster with a track does not need stored
// rings, because views compute them from its waypoints.
inline bool RingsMayHaveChanged(const Disaster& disaster, const Bulletin& bulletin) {
  return disaster.radius_growth != 0.0F && bulletin.step != kNone;
}

// The two archives: Writer writes a record to JSON, and Reader reads it back.
// FieldsOf<Record>::Visit lists the fields of a record for both.

class Writer {
 public:
  static constexpr bool kReads = false;
  template <typename T>
  void Field(const char* key, const T& value) {
    state[key] = ToJson(value);
  }
  /// Writes several values as a list under one key.
  template <typename... T>
  void Fields(const char* key, const T&... values) {
    state[key] = json::array({ToJson(values)...});
  }
  /// Writes a field that saved states of older versions lack. If a field is missing, Reader::Added
  /// does not change the value.
  template <typename T>
  void Added(const char* key, const T& value) {
    Field(key, value);
  }

  json state = json::object();

 private:
  template <typename T>
  static json ToJson(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      return Int(value);
    } else if constexpr (std::is_same_v<T, Cell>) {
      return json::array({value.x, value.y});
    } else {
      return value;
    }
  }
};

class Reader {
 public:
  static constexpr bool kReads = true;
  explicit Reader(const json& from) : state(from) {}
  template <typename T>
  void Field(const char* key, T& value) {
    FromJson(state.at(key), value);
  }
  template <typename... T>
  void Fields(const char* key, T&... values) {
    const json& list = state.at(key);
    std::size_t i = 0;
    (FromJson(list.at(i++), values), ...);
  }
  template <typename T>
  void Added(const char* key, T& value) {
    if (state.contains(key)) Field(key, value);
  }

  const json& state;

 private:
  template <typename T>
  static void FromJson(const json& j, T& value) {
    if constexpr (std::is_enum_v<T>) {
      const int code = j.get<int>();
      if (code < 0 || code >= CountOf(value)) {
        throw InputError("state: got an unknown code of an enumeration; use another saved state");
      }
      value = static_cast<T>(code);
    } else if constexpr (std::is_same_v<T, Cell>) {
      value = {j.at(0).get<std::int32_t>(), j.at(1).get<std::int32_t>()};
    } else {
      j.get_to(value);
    }
  }
  static int CountOf(Action) { return kActionCount + 1; }
  static int CountOf(Outcome) { return kOutcomeCount; }
  static int CountOf(DeviceKind) { return kDeviceKindCount; }
  static int CountOf(DeviceStatus) { return kDeviceStatusCount; }
  static int CountOf(DisasterKind) { return kDisasterKindCount; }
  static int CountOf(Border) { return kBorderCount; }
  static int CountOf(EndReason) { return kEndReasonCount; }
};

// Lists the fields of a record in saved states, for both archives.
template <typename Record>
struct FieldsOf;

inline std::array<float, kRewardTermCount> Numbers(const RewardTerms& terms) {
  std::array<float, kRewardTermCount> numbers{};
  std::memcpy(numbers.data(), &terms, sizeof(terms));
  return numbers;
}

inline RewardTerms TermsOf(const std::array<float, kRewardTermCount>& numbers) {
  RewardTerms terms;
  std::memcpy(static_cast<void*>(&terms), numbers.data(), sizeof(terms));
  return terms;
}

template <>
struct FieldsOf<Ship> {
  template <typename Archive, typename S>
  static void Visit(Archive& a, S& ship) {
    a.Field("cell", ship.cell);
    a.Field("own_device", ship.own_device);
    a.Field("aboard", ship.aboard);
    a.Field("in_play", ship.active);
    a.Field("action", ship.action);
    a.Field("outcome", ship.outcome);
    std::array<float, kRewardTermCount> t = Numbers(ship.terms);
    a.Fields("terms", t[0], t[1], t[2], t[3], t[4], t[5], t[6]);
    for (std::size_t i = 7; i < t.size(); ++i) {  // terms added after version 0.1.0
      a.Added((std::string(kRewardTermNames[i]) + "_term").c_str(), t[i]);
    }
    if constexpr (Archive::kReads) ship.terms = TermsOf(t);
    a.Field("reward", ship.reward);
    a.Field("return", ship.episode_return);
    a.Added("energy", ship.energy);
    a.Added("distance", ship.distance);
    a.Added("episode_energy", ship.episode_energy);
    a.Added("episode_distance", ship.episode_distance);
  }
};

template <>
struct FieldsOf<Device> {
  template <typename Archive, typename D>
  static void Visit(Archive& a, D& device) {
    a.Field("cell", device.cell);
    a.Field("value", device.value);
    a.Field("health", device.health);
    a.Field("carrier", device.carrier);
    a.Field("kind", device.kind);
    a.Field("status", device.status);
    a.Field("self_propelled", device.self_propelled);
  }
};

template <>
struct FieldsOf<EpisodeRecord> {
  template <typename Archive, typename R>
  static void Visit(Archive& a, R& record) {
    VisitEpisodeFields(
        [&a](const EpisodeField& field, auto& value) {
          // Fields of version 0.1.0 have their column names as keys.
          field.is_added ? a.Added(field.name, value) : a.Field(field.column, value);
        },
        record);
    if (Archive::kReads || record.ship_steps != 0) a.Added("ship_steps", record.ship_steps);
  }
};

// The radii by quadrant are written only for a disaster that has them. The rings of the last
// bulletin are written only if RingsMayHaveChanged. DisasterFrom reads both.
template <>
struct FieldsOf<SavedDisaster> {
  template <typename Archive, typename D>
  static void Visit(Archive& a, D& d) {
    auto& b = d.bulletin;
    a.Field("kind", d.kind);
    a.Field("border", d.border);
    a.Field("grade", d.grade);
    a.Field("rings", d.rings);
    a.Field("radius", d.radius);
    a.Field("radius_squared", d.radius_squared);
    a.Field("risk", d.risk);
    a.Fields("centre", d.x, d.y);
    a.Fields("motion", d.dx, d.dy);
    a.Field("speed", d.speed);
    a.Field("heading_deg", d.heading_deg);
    a.Field("turn_threshold", d.turn_threshold);
    a.Field("radius_growth", d.radius_growth);
    a.Field("margin", d.margin);
    a.Field("steps_left", d.steps_left);
    a.Field("waypoint", d.waypoint);
    a.Field("draws", d.draws);
    a.Fields("bulletin", b.x, b.y, b.speed);
    a.Fields("bulletin_when", b.heading_deg, b.step);
    if constexpr (!Archive::kReads) {
      if (d.by_quadrant) a.Field("quadrants", d.quadrant);
      if (RingsMayHaveChanged(d, b)) a.Fields("bulletin_rings", b.radius, b.quadrant);
    }
  }
};

// Reads a disaster.
// @throws InputError if a value is out of range or the rings of the bulletin are missing
// @throws json::exception if another field is missing or a field has the wrong type
SavedDisaster DisasterFrom(const json& j);

json TrackToJson(const std::vector<Waypoint>& track);
std::vector<Waypoint> TrackFromJson(const json& points);
json ForecastsToJson(const Forecasts& forecasts);
Forecasts ForecastsFromJson(const json& list);

template <typename Record>
json Written(const Record& record) {
  Writer writer;
  FieldsOf<Record>::Visit(writer, record);
  return std::move(writer.state);
}

template <typename Record>
json Written(const std::vector<Record>& records) {
  json list = json::array();
  for (const Record& record : records) list.push_back(Written(record));
  return list;
}

template <typename Record>
Record Read(const json& j) {
  Reader reader(j);
  Record record;
  FieldsOf<Record>::Visit(reader, record);
  return record;
}

}  // namespace aquafarm::internal
