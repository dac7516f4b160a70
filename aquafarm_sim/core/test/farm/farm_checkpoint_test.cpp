// SPDX-License-Identifier: BSD-3-Clause
// Hashing, saving and loading of an episode, and disasters that arrive during it.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "aquafarm/base/check.h"
#include "aquafarm/base/hash.h"
#include "aquafarm/base/version.h"
#include "aquafarm/farm/farm.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

using nlohmann::json;
using test::Act;
using test::CrowdedScenario;
using test::MakeFarm;
using test::RandomSteps;
using test::StillDisaster;
using test::TinyScenario;

TEST(SaveLoad, ContinuesBitIdentically) {
  Farm farm = MakeFarm(CrowdedScenario(2));
  farm.Reset(11, 4);
  RandomSteps(farm, 37, 1);
  const std::string bytes = farm.Save();
  const std::uint64_t hash = farm.Hash();
  RandomSteps(farm, 60, 2);
  const std::uint64_t expected = farm.Hash();
  Farm other = MakeFarm(CrowdedScenario(2));
  other.Load(bytes);
  EXPECT_EQ(other.Hash(), hash);
  EXPECT_EQ(other.Save(), bytes);
  RandomSteps(other, 60, 2);
  EXPECT_EQ(other.Hash(), expected);
}

TEST(SaveLoad, DamagedBytesAreRefusedAndChangeNothing) {
  Farm farm = MakeFarm(CrowdedScenario(2));
  RandomSteps(farm, 20, 1);
  const std::string bytes = farm.Save();
  const std::uint64_t hash = farm.Hash();
  for (std::size_t cut = 0; cut < bytes.size(); cut += 13) {
    EXPECT_THROW(farm.Load(bytes.substr(0, cut)), InputError) << "cut at " << cut;
  }
  for (std::size_t flip = 0; flip < bytes.size(); ++flip) {
    std::string bad = bytes;
    bad[flip] = static_cast<char>(bad[flip] ^ 0x10);
    EXPECT_THROW(farm.Load(bad), InputError) << "byte " << flip;
  }
  EXPECT_EQ(farm.Hash(), hash);
}

TEST(SaveLoad, AnotherScenarioIsRefusedWithWhatDiffers) {
  Farm farm = MakeFarm(CrowdedScenario(2));
  Farm tiny = MakeFarm(TinyScenario());
  try {
    tiny.Load(farm.Save());
    FAIL() << "was let through";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "state: scenario: got crowded, expected tiny");
  }
}

/// Expects that a copy of a farm continues as the farm does, also in the next episode.
void ExpectCopy(Farm copy, Farm& farm) {
  copy.CopyStateFrom(farm);
  EXPECT_EQ(copy.Save(), farm.Save());
  EXPECT_EQ(copy.StartHash(), farm.StartHash()) << "the layout is the same";
  for (int i = 0; i < 20; ++i) {
    RandomSteps(farm, 1, static_cast<std::uint64_t>(i));
    RandomSteps(copy, 1, static_cast<std::uint64_t>(i));
    ASSERT_EQ(copy.Hash(), farm.Hash()) << "step " << i;
  }
  farm.Reset(farm.seed(), farm.episode() + 1);
  copy.Reset(copy.seed(), copy.episode() + 1);
  EXPECT_EQ(copy.Save(), farm.Save());
}

TEST(CopyStateFrom, ContinuesBitIdenticallyInEveryLayoutMode) {
  for (const LayoutMode mode : {LayoutMode::kFixed, LayoutMode::kPerEpisode}) {
    Scenario scenario = CrowdedScenario(2);
    scenario.layout = mode;
    Farm farm = MakeFarm(scenario);
    farm.Reset(11, 4);
    RandomSteps(farm, 37, 1);
    ExpectCopy(MakeFarm(scenario), farm);
    ExpectCopy(Farm(farm.shared_scenario(), farm.shared_layout()), farm);
  }
}

TEST(CopyStateFrom, CopiesDisastersAndForecastsThatArrived) {
  Scenario scenario = CrowdedScenario(1);
  DisasterSpec spec = StillDisaster(3, 3, {2}, {-20});
  spec.start.reset();
  spec.track = {{0, 1, 1, 1, {2}, {-20}}, {60, 9, 5, 1, {2}, {-20}}};
  spec.forecasts = {{0, {{30, 4, 4, 1, {}, {}}}}};
  Farm copy = MakeFarm(scenario);
  {
    Farm farm = MakeFarm(scenario);
    RandomSteps(farm, 5, 1);
    farm.SetDisaster(0, spec);
    farm.SetDisaster(2, StillDisaster(5, 5, {2}, {-10}));
    copy.CopyStateFrom(farm);
    EXPECT_EQ(copy.Save(), farm.Save());
    EXPECT_EQ(copy.forecasts()[0]->size(), 1U);
    ExpectCopy(MakeFarm(scenario), farm);
  }
  RandomSteps(copy, 10, 2);  // the original and its scenario no longer exist
  EXPECT_EQ(copy.disasters().size(), 3U);
}

TEST(CopyStateFrom, DrawsRoutesThatTheOtherFarmHasNot) {
  Scenario scenario = CrowdedScenario(1);
  scenario.layout = LayoutMode::kPerEpisode;
  Farm farm = MakeFarm(scenario);
  farm.Reset(3, 8);
  RandomSteps(farm, 5, 1);
  scenario.view.routes = true;
  Farm copy = MakeFarm(scenario);
  copy.CopyStateFrom(farm);
  EXPECT_EQ(copy.StartHash(), farm.StartHash());
  Farm drawn = MakeFarm(scenario);
  drawn.Reset(3, 8);
  EXPECT_FALSE(copy.layout().routes.empty());
  EXPECT_EQ(copy.layout().route_count(), drawn.layout().route_count());
  ASSERT_EQ(copy.layout().routes.size(), drawn.layout().routes.size());
  for (std::size_t i = 0; i < drawn.layout().routes.size(); ++i) {
    EXPECT_EQ(copy.layout().routes[i].steps, drawn.layout().routes[i].steps);
  }
}

TEST(CopyStateFrom, AFarmOfAnotherScenarioIsAProgrammingError) {
  Farm tiny = MakeFarm(TinyScenario());
  EXPECT_THROW(tiny.CopyStateFrom(MakeFarm(CrowdedScenario(2))), LogicError);
}

TEST(SetDisaster, ReplacesOneInPlay) {
  Farm farm = MakeFarm(CrowdedScenario(1));
  RandomSteps(farm, 5, 1);
  DisasterSpec spec = StillDisaster(3, 3, {2}, {-20});
  farm.SetDisaster(0, spec);
  EXPECT_EQ(farm.disasters()[0].x, 3.0F);
  EXPECT_EQ(farm.disasters()[0].risk[0], -20.0F);
  spec.start.reset();
  spec.speed = 1.0F;
  spec.heading_deg = 90;
  farm.SetDisaster(0, spec);
  EXPECT_EQ(farm.disasters()[0].x, 3.0F) << "without a start the centre stays";
  RandomSteps(farm, 1, 2);
  EXPECT_EQ(farm.disasters()[0].x, 4.0F);
}

TEST(SetDisaster, AddsOneAndTheNextEpisodeIsTheScenariosAgain) {
  Farm farm = MakeFarm(CrowdedScenario(1));
  farm.SetDisaster(2, StillDisaster(3, 3, {2}, {-20}));
  EXPECT_EQ(farm.disasters().size(), 3U);
  const std::string bytes = farm.Save();
  Farm other = MakeFarm(CrowdedScenario(1));
  other.Load(bytes);
  EXPECT_EQ(other.Hash(), farm.Hash());
  farm.Reset(0, 1);
  EXPECT_EQ(farm.disasters().size(), 2U);
}

TEST(SetDisaster, OutOfRangeIsRefusedAndChangesNothing) {
  Farm farm = MakeFarm(CrowdedScenario(1));
  const std::uint64_t hash = farm.Hash();
  DisasterSpec spec = StillDisaster(3, 3, {2}, {-20});
  EXPECT_THROW(farm.SetDisaster(3, spec), InputError);
  EXPECT_THROW(farm.SetDisaster(-1, spec), InputError);
  spec.start = {{std::numeric_limits<float>::quiet_NaN(), 0.0F}};
  EXPECT_THROW(farm.SetDisaster(0, spec), InputError);
  spec = StillDisaster(3, 3, {2, 1}, {-20, -5});
  EXPECT_THROW(farm.SetDisaster(0, spec), InputError);
  EXPECT_EQ(farm.Hash(), hash);
}

/// Returns a farm's saved state after a change, with a matching checksum.
std::string Forge(const Farm& farm, const std::function<void(json&)>& change) {
  const json sealed = json::from_cbor(farm.Save());
  const auto& binary = sealed.at("state").get_binary();
  json state = json::from_cbor(std::string(binary.begin(), binary.end()));
  change(state);
  std::string payload;
  json::to_cbor(state, payload);
  std::string bytes;
  json::to_cbor(
      {{"checksum", HashBytes(payload)}, {"state", json::binary({payload.begin(), payload.end()})}},
      bytes);
  return bytes;
}

TEST(SaveLoad, AStateOfAnotherVersionIsRefusedWithBoth) {
  Farm farm = MakeFarm(CrowdedScenario(2));
  const std::uint64_t hash = farm.Hash();
  try {
    farm.Load(Forge(farm, [](json& s) { s["version"] = "0.0.7"; }));
    FAIL() << "it was let through";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              std::string("state: version: got 0.0.7, expected ") + kVersion);
  }
  EXPECT_EQ(farm.Hash(), hash);
}

TEST(SaveLoad, ForgedStatesAreRefusedBeforeTheirHashIsLookedAt) {
  Farm farm = MakeFarm(CrowdedScenario(2));
  RandomSteps(farm, 20, 1);
  const std::uint64_t hash = farm.Hash();
  const auto nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::function<void(json&)>> changes{
      [](json& s) { s["disasters"] = json::array(); },
      [](json& s) { s["disasters"][0]["bulletin_when"][0] = 100000; },
      [](json& s) { s["disasters"][0]["heading_deg"] = -1; },
      [](json& s) { s["disasters"][1]["rings"] = 99; },
      [nan](json& s) { s["disasters"][1]["centre"][0] = nan; },
      [nan](json& s) { s["devices"][0]["health"] = nan; },
      [](json& s) { s["devices"][0]["status"] = 1; },
      [](json& s) { s["devices"][0]["carrier"] = 77; },
      [](json& s) { s["devices"][0]["cell"][0] = -3; },
      [](json& s) { s["ships"][0]["aboard"] = 5; },
      [](json& s) { s["ships"][0]["own_device"] = 3; },
      [](json& s) { s["ships"][1]["cell"][1] = 4096; },
      [](json& s) { s["record"]["steps"] = -1; },
      [](json& s) { s["record"]["devices"] = 900; },
      [](json& s) { s["record"]["reason"] = 9; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    try {
      farm.Load(Forge(farm, changes[i]));
      FAIL() << "change " << i << " was let through";
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find("state: hash"), std::string::npos)
          << "change " << i << ": " << error.what();
    }
  }
  farm.Load(Forge(farm, [](json&) {}));
  EXPECT_EQ(farm.Hash(), hash);
}

TEST(SaveLoad, BytesThatNestAMillionDeepAreRefused) {
  Farm farm = MakeFarm(TinyScenario());
  EXPECT_THROW(farm.Load(std::string(1000000, '\x81')), InputError);
  EXPECT_THROW(farm.Load(Forge(farm,
                               [](json& state) {
                                 for (int i = 0; i < 100; ++i) state = json::array({state});
                               })),
               InputError);
}

/// Returns a farm in partial view some steps after a bulletin of its growing tide.
Farm FarmAfterABulletin() {
  Scenario scenario = CrowdedScenario(1);
  scenario.view = {ViewMode::kPartial, 2.0F, 7, 1.5F};
  Farm farm = MakeFarm(scenario);
  RandomSteps(farm, 20, 1);
  return farm;
}

// Returns the error of loading a farm's own state after a change, or "was loaded".
std::string Refused(Farm& farm, const std::function<void(json&)>& change) {
  try {
    farm.Load(Forge(farm, change));
  } catch (const InputError& error) {
    return error.what();
  }
  return "was loaded";
}

TEST(SaveLoad, AStateOfBeforeBulletinsKeptRingsIsRefused) {
  Farm farm = FarmAfterABulletin();
  ASSERT_EQ(Refused(farm, [](json&) {}), "was loaded");
  EXPECT_EQ(
      Refused(farm, [](json& s) { s["disasters"][1].erase("bulletin_rings"); }),
      "state: disaster: bulletin_rings: missing, expected the rings of the last bulletin; states "
      "saved by older versions lack them: use another saved state");
}

TEST(Hash, DependsOnTheBulletinRingsOfAGrowingDisaster) {
  Farm farm = FarmAfterABulletin();
  const auto hash = [](const std::string& told) { return told.substr(0, 12); };
  const std::string other = "state: hash:";
  EXPECT_EQ(hash(Refused(farm, [](json& s) { s["disasters"][1]["bulletin_rings"][0][0] = 0.5F; })),
            other);
  EXPECT_EQ(hash(Refused(farm, [](json& s) { s["disasters"][1]["bulletin"][2] = 3.0F; })), other);

  DisasterSpec spec = farm.scenario().disasters[1];
  spec.start = {{3.0F, 3.0F}};
  spec.quadrants = {{1.0F, 1.0F, 1.0F, 1.0F}, {2.5F, 2.5F, 2.5F, 2.5F}};
  farm.SetDisaster(1, spec);
  EXPECT_EQ(
      hash(Refused(farm, [](json& s) { s["disasters"][1]["bulletin_rings"][1][2][0] = 0.5F; })),
      other);
}

TEST(Hash, DependsOnTheForecastOfABulletin) {
  Farm a = MakeFarm(CrowdedScenario(1));
  Farm b = MakeFarm(CrowdedScenario(1));
  DisasterSpec spec = StillDisaster(3, 3, {2}, {-20});
  spec.start.reset();
  const std::vector<float> radii{2};
  const std::vector<float> risks{-20};
  spec.track = {
      {0, 1, 1, 3, radii, risks}, {50, 2, 2, 3, radii, risks}, {99, 3, 3, 3, radii, risks}};
  a.SetDisaster(0, spec);
  spec.track[2].x = 9;
  b.SetDisaster(0, spec);
  EXPECT_NE(a.Hash(), b.Hash());
}

}  // namespace
}  // namespace aquafarm
