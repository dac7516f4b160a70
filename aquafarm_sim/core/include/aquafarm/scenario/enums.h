// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The enumerations of a scenario: kinds of devices and disasters, and modes.

#include <cstdint>
#include <string_view>

namespace aquafarm {

/// The four kinds of breeding equipment of Fig. 1 of the paper.
enum class DeviceKind : std::uint8_t {
  kTemporaryBreeding,
  kMonitoring,
  kBreedingRelease,
  kDeepWaterBreeding
};
inline constexpr int kDeviceKindCount = 4;

/// Whether a device is in the sea, on a ship, or in a port.
enum class DeviceStatus : std::uint8_t { kDeployed, kAboard, kDelivered };
inline constexpr int kDeviceStatusCount = 3;

/// The kinds of disasters. DamageSpec::kinds has a factor of the damage for each kind of device and
/// each kind of disaster.
enum class DisasterKind : std::uint8_t {
  kTyphoon,
  kStormSurge,
  kWave,
  kRedTide,
  kOilSpill,
  kChemicalSpill
};
inline constexpr int kDisasterKindCount = 6;

/// Returns the name used in files and messages, such as "deep_water_breeding" or "red_tide".
/// @throws LogicError for a value outside the enumeration
std::string_view ToString(DeviceKind value);
std::string_view ToString(DeviceStatus value);
std::string_view ToString(DisasterKind value);

/// Whether all episodes have the layout of Scenario::layout_seed, or each episode draws its own.
enum class LayoutMode : std::uint8_t { kFixed, kPerEpisode };
inline constexpr int kLayoutModeCount = 2;
/// How the cells of devices are chosen; see `placement` in docs/scenario.md.
enum class DevicePlacement : std::uint8_t { kUniform, kLinear, kRandom, kExplicit };
inline constexpr int kDevicePlacementCount = 4;
/// What a disaster without a track does when its centre reaches the border, which is outside the
/// map; see `border` in docs/scenario.md.
enum class Border : std::uint8_t { kReflect, kWrap, kLeave };
inline constexpr int kBorderCount = 3;
/// Whether ships observe the whole map, or mainly their surroundings; see ViewSpec.
enum class ViewMode : std::uint8_t { kFull, kPartial };
inline constexpr int kViewModeCount = 2;
/// Whether each agent receives its own reward, or all agents receive the sum of all rewards.
enum class RewardSharing : std::uint8_t { kIndividual, kTeam };
inline constexpr int kRewardSharingCount = 2;
/// Returns the name used in scenario files.
std::string_view ToString(LayoutMode value);
std::string_view ToString(DevicePlacement value);
std::string_view ToString(Border value);
std::string_view ToString(ViewMode value);
std::string_view ToString(RewardSharing value);

}  // namespace aquafarm
