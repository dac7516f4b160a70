// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/scenario/family.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "aquafarm/base/check.h"
#include "aquafarm/base/rng.h"
#include "aquafarm/scenario/validate.h"

namespace aquafarm {
namespace {

constexpr float kMinReach = 2.0F;           // min radius of a disaster's largest ring [cells]
constexpr float kMaxReachShare = 0.3F;      // max radius / shorter side of the map
constexpr float kMaxSpeed = 0.8F;           // [cells/step]
constexpr float kMaxTurns = 0.2F;           // max turn_probability
constexpr float kMaxGrowth = 0.02F;         // max |radius_growth| [cells/step]
constexpr std::int32_t kMinDuration = 300;  // [steps]

std::int32_t Whole(RandomStream& rng, Range<std::int32_t> range) {
  const auto count = static_cast<std::uint32_t>(range.max - range.min + 1);
  return range.min + static_cast<std::int32_t>(rng.Below(count));
}

float Number(RandomStream& rng, Range<float> range) { return rng.Uniform(range.min, range.max); }

void DrawCoast(RandomStream& rng, Scenario& ranch) {
  const std::uint32_t side = rng.Below(4);
  const bool is_level = side < 2;
  const std::int32_t along = is_level ? ranch.width : ranch.height;
  const std::int32_t across = is_level ? ranch.height : ranch.width;
  const std::int32_t segment = std::max(2, along / 6);
  for (std::int32_t begin = 0; begin < along; begin += segment) {
    const std::int32_t depth = Whole(rng, {1, std::max(1, across / 8)});
    const std::int32_t length = std::min(segment, along - begin);
    const std::int32_t at = side % 2 == 0 ? 0 : across - depth;
    const IslandBlock level{{begin, at}, length, depth};
    const IslandBlock upright{{at, begin}, depth, length};
    ranch.islands.push_back(is_level ? level : upright);
  }
}

void DrawIslands(RandomStream& rng, const FamilySpec& family, Scenario& ranch) {
  ranch.islands.clear();
  if (rng.Unit() < family.coast_share) DrawCoast(rng, ranch);
  const std::int32_t count = Whole(rng, family.islands);
  for (std::int32_t i = 0; i < count; ++i) {
    IslandBlock block;
    block.width = Whole(rng, {1, std::max(1, ranch.width / 5)});
    block.height = Whole(rng, {1, std::max(1, ranch.height / 5)});
    block.south_west = {Whole(rng, {0, ranch.width - block.width}),
                        Whole(rng, {0, ranch.height - block.height})};
    ranch.islands.push_back(block);
  }
}

void DrawDevices(RandomStream& rng, const FamilySpec& family, Scenario& ranch) {
  constexpr std::array<DevicePlacement, 4> kPlacements{
      DevicePlacement::kRandom, DevicePlacement::kRandom, DevicePlacement::kUniform,
      DevicePlacement::kLinear};
  DeviceSpec& devices = ranch.devices;
  devices.placement = kPlacements[rng.Below(kPlacements.size())];
  devices.count = Whole(rng, family.devices);
  devices.kinds.clear();
  const std::uint32_t first = rng.Below(kDeviceKindCount);
  const std::uint32_t stride = rng.Below(2) == 0 ? 1 : 3;  // both visit all four kinds
  for (std::uint32_t i = 0; i < kDeviceKindCount; ++i) {
    devices.kinds.push_back(static_cast<DeviceKind>((first + i * stride) % kDeviceKindCount));
  }
}

DisasterSpec DrawDisaster(RandomStream& rng, std::int32_t shorter_side, std::int32_t duration) {
  DisasterSpec disaster;
  disaster.kind = static_cast<DisasterKind>(rng.Below(kDisasterKindCount));
  disaster.grade = Whole(rng, {1, 4});
  const float reach = Number(
      rng, {kMinReach, std::max(kMinReach, kMaxReachShare * static_cast<float>(shorter_side))});
  const std::int32_t rings = Whole(rng, {1, 3});
  const float worst = Number(rng, {kWorstRisk, -8.0F});
  disaster.radii.clear();
  disaster.risks.clear();
  for (std::int32_t ring = 1; ring <= rings; ++ring) {
    const auto part = static_cast<float>(ring) / static_cast<float>(rings);
    disaster.radii.push_back(reach * part);
    const float between =
        rings == 1 ? 0.0F : static_cast<float>(ring - 1) / static_cast<float>(rings - 1);
    disaster.risks.push_back(worst + between * (kMildestRisk - worst));
  }
  disaster.speed = Number(rng, {0.0F, kMaxSpeed});
  disaster.turn_probability = Number(rng, {0.0F, kMaxTurns});
  const float growth = Number(rng, {-kMaxGrowth, kMaxGrowth});
  disaster.radius_growth = rng.Below(4) == 0 ? growth : 0.0F;
  disaster.border = rng.Below(4) == 0 ? Border::kWrap : Border::kReflect;
  disaster.duration = duration;
  return disaster;
}

// Returns a rough estimate of the steps that one ship needs to fetch all devices, clamped to
// [kMinDuration, kMaxRanchSteps / 2].
std::int32_t WorkOf(const Scenario& ranch) {
  const std::int32_t trips =
      (ranch.devices.count + ranch.ships.capacity - 1) / ranch.ships.capacity;
  const std::int32_t steps = 100 + trips * (ranch.width + ranch.height);
  return std::min(kMaxRanchSteps / 2, std::max(kMinDuration, steps));
}

}  // namespace

Scenario DrawRanch(const Scenario& family, std::uint64_t seed, std::uint64_t episode,
                   std::uint32_t attempt) {
  AQUAFARM_CHECK_EQ(family.family.has_value(), true);
  const FamilySpec& spec = *family.family;
  RandomStream rng({seed, episode, RngStream::kRanch, attempt});
  Scenario ranch = family;
  ranch.family.reset();
  ranch.name = family.name + '_' + std::to_string(episode);
  ranch.width = Whole(rng, spec.width);
  ranch.height = Whole(rng, spec.height);
  ranch.layout = LayoutMode::kFixed;
  ranch.layout_seed = (static_cast<std::uint64_t>(rng.Next()) << 32U) | rng.Next();
  DrawIslands(rng, spec, ranch);
  const float rocks = Number(rng, spec.rocks) * static_cast<float>(ranch.CellCount());
  ranch.rocks.count.min = ranch.rocks.count.max = static_cast<std::int32_t>(rocks);
  ranch.ports.count = Whole(rng, spec.ports);
  ranch.ships.capacity = Whole(rng, spec.capacity);
  DrawDevices(rng, spec, ranch);
  ranch.damage.exposure_damage = Number(rng, spec.exposure_damage);
  const auto steps = static_cast<float>(WorkOf(ranch));
  const auto duration = static_cast<std::int32_t>(rng.Uniform(steps, 2.0F * steps));
  const std::int32_t disasters = Whole(rng, spec.disasters);
  const bool keeps_disasters = rng.Unit() < spec.storm_share && !ranch.disasters.empty();
  if (!keeps_disasters) {
    ranch.step_limit = duration;
    ranch.disasters.clear();
    for (std::int32_t i = 0; i < disasters; ++i) {
      ranch.disasters.push_back(DrawDisaster(rng, std::min(ranch.width, ranch.height), duration));
    }
  }
  ValidateScenario(ranch);
  // Identifies the ranch in saved states. HashScenario would be much slower.
  ranch.hash = family.hash ^ ranch.layout_seed;
  return ranch;
}

}  // namespace aquafarm
