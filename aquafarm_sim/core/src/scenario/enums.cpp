// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/scenario/enums.h"

#include <array>

#include "base/name_of.h"

namespace aquafarm {

using internal::NameOf;

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

std::string_view ToString(LayoutMode value) {
  static constexpr std::array<std::string_view, kLayoutModeCount> kNames{"fixed", "per_episode"};
  return NameOf(value, kNames);
}

std::string_view ToString(DevicePlacement value) {
  static constexpr std::array<std::string_view, kDevicePlacementCount> kNames{"uniform", "linear",
                                                                              "random", "explicit"};
  return NameOf(value, kNames);
}

std::string_view ToString(Border value) {
  static constexpr std::array<std::string_view, kBorderCount> kNames{"reflect", "wrap", "leave"};
  return NameOf(value, kNames);
}

std::string_view ToString(ViewMode value) {
  static constexpr std::array<std::string_view, kViewModeCount> kNames{"full", "partial"};
  return NameOf(value, kNames);
}

std::string_view ToString(RewardSharing value) {
  static constexpr std::array<std::string_view, kRewardSharingCount> kNames{"individual", "team"};
  return NameOf(value, kNames);
}

}  // namespace aquafarm
