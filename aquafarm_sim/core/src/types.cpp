// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/types.h"

#include "name_of.h"

namespace aquafarm {

using internal::NameOf;

std::string_view ToString(Action value) {
  static constexpr std::array<std::string_view, kActionCount + 1> kNames{
      "north",      "south",      "west",   "east",     "north_west", "north_east",
      "south_west", "south_east", "pickup", "drop_off", "hold"};
  return NameOf(value, kNames);
}

std::string_view ToString(Outcome value) {
  static constexpr std::array<std::string_view, kOutcomeCount> kNames{
      "ok",   "edge",       "crash", "collision", "illegal_pickup", "illegal_drop_off",
      "held", "out_of_play"};
  return NameOf(value, kNames);
}

std::string_view ToString(EndReason value) {
  static constexpr std::array<std::string_view, kEndReasonCount> kNames{
      "none", "all_retrieved", "disaster_ended", "step_limit"};
  return NameOf(value, kNames);
}

std::string_view ToString(DeviceKind value) {
  static constexpr std::array<std::string_view, kDeviceKindCount> kNames{
      "temporary_breeding", "monitoring", "breeding_release", "deep_water_breeding"};
  return NameOf(value, kNames);
}

std::string_view ToString(DeviceStatus value) {
  static constexpr std::array<std::string_view, kDeviceStatusCount> kNames{"deployed", "aboard",
                                                                           "delivered"};
  return NameOf(value, kNames);
}

std::string_view ToString(DisasterKind value) {
  static constexpr std::array<std::string_view, kDisasterKindCount> kNames{
      "typhoon", "storm_surge", "wave", "red_tide", "oil_spill", "chemical_spill"};
  return NameOf(value, kNames);
}

}  // namespace aquafarm
