// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/tokens.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "count_allocations.h"
#include "token_ranch.h"

namespace aquafarm::test {
namespace {

using Tokens = std::map<std::string, float>;

/// Returns the tokens by name.
Tokens Named(const Scenario& scenario, Cell ship = kTokenShip) {
  const std::vector<float> features = TokensOf(scenario, ship);
  const std::vector<std::string> names = Encoder(scenario).feature_names();
  Tokens tokens;
  for (std::size_t i = 0; i < names.size(); ++i) tokens[names[i]] = features[i];
  return tokens;
}

/// Renames a prefix, as "device0." to "device1.".
Tokens Renamed(const Tokens& tokens, const std::map<std::string, std::string>& prefixes) {
  Tokens renamed;
  for (const auto& [name, value] : tokens) {
    const auto dot = name.find('.');
    const auto found = prefixes.find(name.substr(0, dot));
    renamed[found == prefixes.end() ? name : found->second + name.substr(dot)] = value;
  }
  return renamed;
}

void ExpectEqual(const Tokens& got, const Tokens& expected) {
  ASSERT_EQ(got.size(), expected.size());
  for (const auto& [name, value] : expected) EXPECT_NEAR(got.at(name), value, 1e-5F) << name;
}

TEST(Tokens, GroupsCoverTheNamesInOrder) {
  const std::vector<std::string>& names = TokenNames();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  const auto& groups = TokenGroups();
  std::int32_t end = 0;
  for (const TokenGroup& group : groups) {
    EXPECT_EQ(group.begin, end);
    end = group.end();
  }
  EXPECT_EQ(static_cast<std::size_t>(end), names.size());
  for (std::size_t i = 1; i < groups.size(); ++i) {
    EXPECT_NE(names[static_cast<std::size_t>(groups[i].begin)].find("0.valid"), std::string::npos);
  }
  EXPECT_EQ(names[kFirstBlockedFeature], "ship.blocked.north");
  EXPECT_EQ(Encoder(TokenScenario()).feature_names(), names);
}

TEST(Tokens, DescribeARouteAndTheRisk) {
  const Tokens tokens = Named(TokenScenario());
  EXPECT_FLOAT_EQ(tokens.at("device0.east"), 2.0F / kTokenLength);
  EXPECT_FLOAT_EQ(tokens.at("device0.north"), -1.0F / kTokenLength);
  EXPECT_FLOAT_EQ(tokens.at("device0.distance"), 2.0F / kTokenLength);
  EXPECT_EQ(tokens.at("device0.next.south_east"), 1.0F);
  EXPECT_EQ(tokens.at("device0.next.east"), 0.0F);
  EXPECT_FLOAT_EQ(tokens.at("device0.worth"), 0.8F);
  EXPECT_FLOAT_EQ(tokens.at("device0.port_distance"), 3.0F / kTokenLength);
  EXPECT_EQ(tokens.at("device0.monitoring"), 1.0F);
  // Devices are at (13, 9) and (8, 13). The shortest route between them with a port goes through
  // (9, 15), not (15, 12).
  EXPECT_FLOAT_EQ(tokens.at("device0.onward_device"), 5.0F / kTokenLength);
  EXPECT_FLOAT_EQ(tokens.at("device0.onward_port"), 0.5F * (6.0F + 2.0F) / kTokenLength);
  EXPECT_FLOAT_EQ(tokens.at("port0.onward"), 3.0F / kTokenLength);
  EXPECT_FLOAT_EQ(tokens.at("port1.onward"), 2.0F / kTokenLength);
  // The disaster moves west along y = 11 with a radius of 3.5 cells, so it never reaches (9, 15).
  EXPECT_EQ(tokens.at("port1.risk_now"), 0.0F);
  // The device at (13, 9) is inside the outer ring. Its risk is 6 of 20, and it loses 0.01 · 6 ·
  // 80.
  EXPECT_FLOAT_EQ(tokens.at("device0.risk_now"), 0.3F);
  EXPECT_FLOAT_EQ(tokens.at("device0.loss"), 4.0F);  // 4.8, clamped
  EXPECT_EQ(tokens.at("device0.rings_in"), 1.0F);
  // The disaster moves west by 0.25 cells per step. It reaches (8, 13), which is 2 cells north of
  // its path, when its centre is sqrt(3.5² − 2²) cells east of it.
  const float steps = (5.0F - std::sqrt(3.5F * 3.5F - 4.0F)) / 0.25F;
  EXPECT_NEAR(tokens.at("device1.rings_in"), 8.0F / (8.0F + steps), 1e-5F);
  EXPECT_EQ(tokens.at("ship.near_blocked.-2.1"), 1.0F);  // the rock at (9, 11)
  EXPECT_EQ(tokens.at("device2.valid"), 0.0F);
  EXPECT_EQ(tokens.at("other0.valid"), 0.0F);
}

TEST(Tokens, NothingFollowsTheLastDevice) {
  Scenario single = TokenScenario();
  single.devices.sites.pop_back();
  const Tokens tokens = Named(single);
  EXPECT_EQ(tokens.at("device0.onward_device"), 0.0F);
  EXPECT_FLOAT_EQ(tokens.at("device0.onward_port"), 0.5F * tokens.at("device0.port_distance"));
  EXPECT_FLOAT_EQ(tokens.at("port0.onward"), 3.0F / kTokenLength);
}

TEST(Tokens, ForecastRiskIsThatOfTheFarmSomeStepsLater) {
  const Scenario scenario = TokenScenario();
  const Tokens tokens = Named(scenario);
  Farm farm(std::make_shared<const Scenario>(scenario));
  farm.PlaceShip(0, kTokenShip);
  std::int32_t risky = 0;
  for (std::int32_t ahead = 0; ahead <= kTokenWindow; ++ahead) {
    for (std::int32_t y = -ahead; y <= ahead; ++y) {
      for (std::int32_t x = -ahead; x <= ahead; ++x) {
        const Cell cell{kTokenShip.x + x, kTokenShip.y + y};
        if (std::max(std::abs(x), std::abs(y)) != ahead) continue;
        if ((farm.layout().bits(cell) & kBlockedBits) != 0) continue;
        const std::string name = "ship.near_risk." + std::to_string(x) + '.' + std::to_string(y);
        EXPECT_FLOAT_EQ(tokens.at(name), -farm.RiskAt(cell) / 20.0F) << name;
        risky += farm.RiskAt(cell) < 0.0F ? 1 : 0;
      }
    }
    const std::uint8_t hold = Act(Action::kHold);
    farm.Step(&hold);
  }
  EXPECT_GT(risky, 10);
}

TEST(Tokens, AFarEntityFillsItsOwnSlotAndChangesNoOther) {
  Scenario more = TokenScenario();
  more.devices.sites.push_back({{23, 23}, DeviceKind::kTemporaryBreeding, 90.0F, false});
  more.ports.cells.push_back({0, 0});
  more.disasters.push_back(StillDisaster(22.0F, 1.0F, {1.0F}, {-9.0F}));
  const Tokens before = Named(TokenScenario());
  const Tokens after = Named(more);
  const std::set<std::string> added{"device2", "port2", "disaster1"};
  for (const auto& [name, value] : after) {
    if (added.count(name.substr(0, name.find('.'))) != 0) continue;
    EXPECT_FLOAT_EQ(value, before.at(name)) << name;
  }
  for (const std::string& slot : added) EXPECT_EQ(after.at(slot + ".valid"), 1.0F) << slot;
}

TEST(Tokens, PermutedEntitiesPermuteTheTokens) {
  Scenario swapped = TokenScenario();
  std::swap(swapped.devices.sites[0], swapped.devices.sites[1]);
  std::swap(swapped.ports.cells[0], swapped.ports.cells[1]);
  ExpectEqual(Named(swapped), Renamed(Named(TokenScenario()), {{"device0", "device1"},
                                                               {"device1", "device0"},
                                                               {"port0", "port1"},
                                                               {"port1", "port0"}}));
}

void Shift(Cell& cell, Cell by) { cell = {cell.x + by.x, cell.y + by.y}; }

TEST(Tokens, ALargerMapWithTheSameRelativePlacesGivesTheSameTokens) {
  Scenario large = TokenScenario();
  const Cell by{7, 20};
  large.width = 40;
  large.height = 60;
  Shift(large.islands[0].south_west, by);
  for (Cell& cell : large.rocks.cells) Shift(cell, by);
  for (Cell& cell : large.ports.cells) Shift(cell, by);
  for (DeviceSite& site : large.devices.sites) Shift(site.cell, by);
  large.disasters[0].start = {{20.0F, 31.0F}};
  ExpectEqual(Named(large, {kTokenShip.x + by.x, kTokenShip.y + by.y}), Named(TokenScenario()));
}

/// A quarter turn to the left, then optionally a reflection of east and west.
struct Symmetry {
  std::int32_t side;
  bool turns;
  bool reflects;
  Cell Vector(Cell v) const {
    if (turns) v = {-v.y, v.x};
    return reflects ? Cell{-v.x, v.y} : v;
  }
  Cell Place(Cell cell) const {
    const Cell twice = Vector({2 * cell.x - (side - 1), 2 * cell.y - (side - 1)});
    return {(twice.x + side - 1) / 2, (twice.y + side - 1) / 2};
  }
};

/// Returns the tokens as the symmetry transforms them: lengths by east and north, moves by name,
/// cells of the window by offset.
Tokens Transformed(const Tokens& tokens, const Symmetry& symmetry) {
  Tokens out = tokens;
  const auto ends_with = [](const std::string& name, const std::string& end) {
    return name.size() > end.size() && name.substr(name.size() - end.size()) == end;
  };
  for (const auto& [name, value] : tokens) {
    if (ends_with(name, "east") && tokens.count(name.substr(0, name.size() - 4) + "north") != 0 &&
        name.find("next.") == std::string::npos && name.find("ship.") == std::string::npos) {
      const std::string stem = name.substr(0, name.size() - 4);
      float east = value;
      float north = tokens.at(stem + "north");
      if (symmetry.turns) std::swap(east, north), east = -east;
      out[stem + "east"] = symmetry.reflects ? -east : east;
      out[stem + "north"] = north;
    }
    for (int move = 0; move < kMoveCount; ++move) {
      const std::string end = '.' + std::string(ToString(static_cast<Action>(move)));
      const std::string stem = name.substr(0, name.size() - std::min(name.size(), end.size()));
      const bool is_move = ends_with(stem, "next") || ends_with(stem, ".risk") ||
                           ends_with(stem, "blocked") || ends_with(stem, "course");
      if (!ends_with(name, end) || !is_move) continue;
      const Cell to = symmetry.Vector(kMoves[static_cast<std::size_t>(move)]);
      const auto found = std::find(kMoves.begin(), kMoves.end(), to) - kMoves.begin();
      out[stem + '.' + std::string(ToString(static_cast<Action>(found)))] = value;
    }
  }
  for (std::int32_t y = -kTokenWindow; y <= kTokenWindow; ++y) {
    for (std::int32_t x = -kTokenWindow; x <= kTokenWindow; ++x) {
      const Cell to = symmetry.Vector({x, y});
      for (const std::string what : {"ship.near_blocked.", "ship.near_risk."}) {
        out[what + std::to_string(to.x) + '.' + std::to_string(to.y)] =
            tokens.at(what + std::to_string(x) + '.' + std::to_string(y));
      }
    }
  }
  return out;
}

TEST(Tokens, TurnedAndReflectedRanchesGiveTurnedAndReflectedTokens) {
  const Tokens plain = Named(TokenScenario());
  for (const bool turns : {false, true}) {
    for (const bool reflects : {false, true}) {
      const Symmetry symmetry{24, turns, reflects};
      SCOPED_TRACE(std::string(turns ? "turned " : "") + (reflects ? "reflected" : ""));
      const auto place = [&symmetry](Cell cell) { return symmetry.Place(cell); };
      ExpectEqual(Named(TurnedTokenScenario(place), symmetry.Place(kTokenShip)),
                  Transformed(plain, symmetry));
    }
  }
}

TEST(Tokens, MoreEntitiesThanSlotsKeepTheNearest) {
  Scenario crowded = TokenScenario();
  crowded.devices.sites.clear();
  for (std::int32_t i = 0; i < kTokenDevices + 3; ++i) {
    crowded.devices.sites.push_back({{23, 23 - i}, DeviceKind::kMonitoring, 50.0F, false});
  }
  const Tokens tokens = Named(crowded, {20, 5});
  // The devices are in rows 23 to 11. The farthest three, ids 0, 1 and 2, have no slot.
  EXPECT_FLOAT_EQ(tokens.at("device0.north"), (20.0F - 5.0F) / kTokenLength);
  EXPECT_FLOAT_EQ(tokens.at("device9.north"), (11.0F - 5.0F) / kTokenLength);
}

TEST(Tokens, AStepDoesNotAllocate) {
  const Scenario scenario = TokenScenario();
  Farm farm(std::make_shared<const Scenario>(scenario));
  const Encoder encoder(scenario);
  View view;
  std::vector<float> features(static_cast<std::size_t>(encoder.feature_count()));
  Observe(farm, 0, view);
  encoder.Features(view, features.data());
  const long before = allocations;
  Observe(farm, 0, view);
  encoder.Features(view, features.data());
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace aquafarm::test
