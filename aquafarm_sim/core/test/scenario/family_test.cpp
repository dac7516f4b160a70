// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/scenario/family.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "aquafarm/base/check.h"
#include "aquafarm/base/rng.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/observation/farm_batch.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace aquafarm::test {
namespace {

Scenario Family() {
  return LoadScenario(AQUAFARM_CORE_DIR "/../scenarios/families/ranch_family.yaml");
}

/// Smallest and largest drawn value.
struct Seen {
  void Add(std::int32_t value) {
    min = std::min(min, value);
    max = std::max(max, value);
  }
  std::int32_t min{1 << 30};
  std::int32_t max{-1};
};

TEST(Family, DrawsFillTheRangesOfTheScenario) {
  const Scenario family = Family();
  const FamilySpec& spec = *family.family;
  Seen width, height, devices, ports, capacity, disasters;
  std::set<DisasterKind> kinds;
  std::size_t storms = 0;
  for (std::uint64_t episode = 0; episode < 600; ++episode) {
    const Scenario ranch = DrawRanch(family, 1, episode, 0);
    EXPECT_FALSE(ranch.family.has_value());
    width.Add(ranch.width);
    height.Add(ranch.height);
    devices.Add(ranch.devices.count);
    ports.Add(ranch.ports.count);
    capacity.Add(ranch.ships.capacity);
    const bool has_storm = !ranch.disasters.empty() && ranch.disasters[0].storms.has_value();
    storms += has_storm ? 1 : 0;
    if (has_storm) continue;
    disasters.Add(static_cast<std::int32_t>(ranch.disasters.size()));
    EXPECT_LE(ranch.step_limit, kMaxRanchSteps);
    for (const DisasterSpec& disaster : ranch.disasters) kinds.insert(disaster.kind);
  }
  const auto fills = [](const Seen& seen, Range<std::int32_t> range) {
    EXPECT_EQ(seen.min, range.min);
    EXPECT_EQ(seen.max, range.max);
  };
  fills(width, spec.width);
  fills(height, spec.height);
  fills(devices, spec.devices);
  fills(ports, spec.ports);
  fills(capacity, spec.capacity);
  fills(disasters, spec.disasters);
  EXPECT_EQ(kinds.size(), static_cast<std::size_t>(kDisasterKindCount));
  EXPECT_NEAR(static_cast<double>(storms) / 600.0, static_cast<double>(spec.storm_share), 0.06);
}

TEST(Family, TheSameSeedDrawsTheSameRanchAndOthersDoNot) {
  const Scenario family = Family();
  const std::string text = ToYaml(DrawRanch(family, 5, 7, 0));
  EXPECT_EQ(ToYaml(DrawRanch(family, 5, 7, 0)), text);
  EXPECT_NE(ToYaml(DrawRanch(family, 5, 8, 0)), text);
  EXPECT_NE(ToYaml(DrawRanch(family, 5, 7, 1)), text);
  // Held-out ranches: those of evaluation seeds.
  EXPECT_NE(ToYaml(DrawRanch(family, 5 | kEvaluationSeedBit, 7, 0)), text);
}

TEST(Family, ADrawnRanchIsAnOrdinaryScenario) {
  const Scenario family = Family();
  for (std::uint64_t episode = 0; episode < 5; ++episode) {
    const Scenario ranch = DrawRanch(family, 2, episode, 0);
    const Scenario read = ParseScenario(ToYaml(ranch), "drawn");
    Farm drawn(std::make_shared<const Scenario>(ranch));
    Farm again(std::make_shared<const Scenario>(read));
    drawn.Reset(2, episode);
    again.Reset(2, episode);
    EXPECT_EQ(drawn.StartHash(), again.StartHash()) << episode;
  }
}

TEST(Family, OneFarmOfAFamilyIsRefused) {
  try {
    FarmBatch batch(std::make_shared<const Scenario>(Family()), 1);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("is a family of ranches"), std::string::npos);
  }
}

TEST(Family, NeedsTokens) {
  std::string text = ToYaml(Family());
  const std::string key = "tokens: true";
  text.replace(text.find(key), key.size(), "tokens: false");
  try {
    ParseScenario(text, "family");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("view.tokens"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace aquafarm::test
