// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/convert/conversions.h"

#include <aquafarm_msgs/Outcome.h>
#include <gtest/gtest.h>
#include <tf2/LinearMath/Matrix3x3.h>
#include <tf2/LinearMath/Quaternion.h>

#include <cmath>
#include <limits>

#include "aquafarm/base/check.h"
#include "aquafarm/base/version.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_sim/convert/observation.h"
#include "tiny_farms.h"

namespace aquafarm_sim {
namespace {

using aquafarm::Action;
using aquafarm::Farm;
using aquafarm::Scenario;

MessageContext Context() {
  MessageContext context;
  context.stamp = ros::Time(12, 500);
  return context;
}

std::string RefusalOf(const aquafarm_msgs::DisasterInfo& info) {
  try {
    FromMsg(info);
  } catch (const aquafarm::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Conversions, CodesOfOutcomesEqualTheCores) {
  using aquafarm::Outcome;
  using Message = aquafarm_msgs::Outcome;
  EXPECT_EQ(static_cast<int>(Outcome::kOk), Message::OK);
  EXPECT_EQ(static_cast<int>(Outcome::kEdge), Message::EDGE);
  EXPECT_EQ(static_cast<int>(Outcome::kCrash), Message::CRASH);
  EXPECT_EQ(static_cast<int>(Outcome::kCollision), Message::COLLISION);
  EXPECT_EQ(static_cast<int>(Outcome::kIllegalPickup), Message::ILLEGAL_PICKUP);
  EXPECT_EQ(static_cast<int>(Outcome::kIllegalDropOff), Message::ILLEGAL_DROP_OFF);
  EXPECT_EQ(static_cast<int>(Outcome::kHeld), Message::HELD);
  EXPECT_EQ(static_cast<int>(Outcome::kOutOfPlay), Message::OUT_OF_PLAY);
}

TEST(Conversions, ReasonsKindsAndStatusEqualTheCores) {
  using aquafarm::DeviceKind;
  using aquafarm::EndReason;
  EXPECT_EQ(static_cast<int>(EndReason::kAllRetrieved), aquafarm_msgs::FarmState::ALL_RETRIEVED);
  EXPECT_EQ(static_cast<int>(EndReason::kDisasterEnded), aquafarm_msgs::FarmState::DISASTER_ENDED);
  EXPECT_EQ(static_cast<int>(EndReason::kStepLimit), aquafarm_msgs::FarmState::STEP_LIMIT);
  EXPECT_EQ(static_cast<int>(DeviceKind::kDeepWaterBreeding),
            aquafarm_msgs::DeviceState::DEEP_WATER_BREEDING);
  EXPECT_EQ(static_cast<int>(aquafarm::DeviceStatus::kDelivered),
            aquafarm_msgs::DeviceState::DELIVERED);
  EXPECT_EQ(static_cast<int>(aquafarm::DisasterKind::kChemicalSpill),
            aquafarm_msgs::DisasterState::CHEMICAL_SPILL);
  EXPECT_EQ(static_cast<int>(aquafarm::Border::kLeave), aquafarm_msgs::DisasterInfo::LEAVE);
}

TEST(Conversions, StateSaysWhatTheFarmIs) {
  Farm farm = aquafarm::test::MakeFarm(aquafarm::test::TinyScenario());
  farm.Reset(7, 3);
  aquafarm::test::StepOne(farm, Action::kNorth);
  aquafarm::test::StepOne(farm, Action::kNorth);
  aquafarm::test::StepOne(farm, Action::kPickup);
  aquafarm_msgs::FarmState state;
  ToMsg(farm, Context(), state);
  EXPECT_EQ("map", state.header.frame_id);
  EXPECT_EQ(ros::Time(12, 500), state.header.stamp);
  EXPECT_EQ(7U, state.seed);
  EXPECT_EQ(3U, state.episode);
  EXPECT_EQ(3U, state.step);
  EXPECT_EQ(-1, state.observer);
  ASSERT_EQ(1U, state.ships.size());
  EXPECT_EQ(2, state.ships[0].x);
  EXPECT_EQ(2, state.ships[0].y);
  EXPECT_EQ(std::vector<std::int32_t>{0}, state.ships[0].aboard);
  EXPECT_FLOAT_EQ(20.0F, state.ships[0].terms.pickup);
  EXPECT_FLOAT_EQ(20.0F, state.joint_reward);
  EXPECT_FLOAT_EQ(18.0F, state.joint_return);
  ASSERT_EQ(1U, state.devices.size());
  EXPECT_EQ(aquafarm_msgs::DeviceState::ABOARD, state.devices[0].status);
  EXPECT_EQ(0, state.devices[0].carrier);
  EXPECT_EQ(farm.Hash(), state.hash);
}

TEST(Conversions, SpecInMidEpisodeDescribesTheStart) {
  auto scenario = std::make_shared<Scenario>(aquafarm::test::CrowdedScenario(2));
  Farm farm(scenario);
  farm.Reset(4, 7);
  const aquafarm::Encoder encoder(*scenario);
  aquafarm_msgs::FarmSpec start;
  ToMsg(farm, encoder, 1, "x", Context(), start);
  ASSERT_EQ(2U, start.disasters.size());
  EXPECT_FLOAT_EQ(farm.disasters()[0].x, start.disasters[0].x);
  aquafarm::test::RandomSteps(farm, 60, 5);
  farm.SetDisaster(2, aquafarm::test::StillDisaster(1, 1, {1}, {-5}));
  aquafarm_msgs::FarmSpec later;
  ToMsg(farm, encoder, 1, "x", Context(), later);
  EXPECT_EQ(start.devices, later.devices);
  EXPECT_EQ(start.disasters, later.disasters);
  EXPECT_EQ(start.ports, later.ports);
}

TEST(Conversions, SpecCarriesChartDevicesAndScenario) {
  auto scenario = std::make_shared<const Scenario>(aquafarm::test::TinyScenario());
  const Farm farm(scenario);
  const aquafarm::Encoder encoder(*scenario);
  aquafarm_msgs::FarmSpec spec;
  ToMsg(farm, encoder, 4, "name: tiny", Context(), spec);
  EXPECT_EQ(aquafarm::kVersion, spec.version);
  EXPECT_EQ("tiny", spec.scenario_name);
  EXPECT_EQ("name: tiny", spec.scenario_yaml);
  EXPECT_EQ(4, spec.farms);
  EXPECT_EQ(4U, spec.islands.size());
  ASSERT_EQ(1U, spec.rocks.size());
  EXPECT_EQ(3, spec.rocks[0].cell.x);
  EXPECT_FLOAT_EQ(-4.0F, spec.rocks[0].reward);
  ASSERT_EQ(1U, spec.ports.size());
  EXPECT_EQ(2, spec.ports[0].cell.x);
  EXPECT_FLOAT_EQ(80.0F, spec.devices.at(0).value);
  EXPECT_EQ(encoder.state_count(), spec.state_count);
  EXPECT_EQ(static_cast<std::size_t>(spec.feature_count), spec.feature_names.size());
  EXPECT_EQ(static_cast<std::size_t>(spec.plane_count), spec.plane_names.size());
  EXPECT_FLOAT_EQ(-20.0F, spec.rewards.island_crash);
}

TEST(Conversions, PartialObservationHidesWhatIsFar) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.view = {aquafarm::ViewMode::kPartial, 1.0F, 0, 0.0F};
  scenario.disasters = {aquafarm::test::StillDisaster(0.0F, 4.0F, {0.5F}, {-20.0F})};
  Farm farm = aquafarm::test::MakeFarm(scenario);
  farm.Reset(1, 0);
  aquafarm::View view;
  aquafarm::Observe(farm, 0, view);
  aquafarm_msgs::FarmState seen;
  ToMsg(farm, view, Context(), seen);
  EXPECT_EQ(0, seen.observer);
  EXPECT_EQ(0U, seen.hash);
  ASSERT_EQ(1U, seen.devices.size());
  EXPECT_FALSE(seen.devices[0].health_known);
  EXPECT_EQ(2, seen.devices[0].x);
  ASSERT_EQ(1U, seen.disasters.size());
  EXPECT_FALSE(seen.disasters[0].known);
  EXPECT_TRUE(seen.disasters[0].radii.empty());
}

// The View that an agent restores from its observation is bit-identical to that of its training.
TEST(Conversions, AnObservationBringsTheViewBack) {
  for (const bool full : {true, false}) {
    aquafarm::Scenario scenario = aquafarm::test::CrowdedScenario(3, 2);
    scenario.view.mode = full ? aquafarm::ViewMode::kFull : aquafarm::ViewMode::kPartial;
    scenario.view.sensor_radius = 3.0F;
    scenario.view.bulletin_period = 7;
    scenario.view.bulletin_noise = 1.5F;
    scenario.view.kinds = true;
    scenario.energy = aquafarm::EnergySpec{0.1, {1.0, 0.5, 0.5, 0.2}, {2.0, 0.0, 0.5, 0.1}};
    aquafarm::Farm farm = aquafarm::test::MakeFarm(scenario);
    const aquafarm::Encoder encoder(farm.scenario());
    const auto features = static_cast<std::size_t>(encoder.feature_count());
    std::vector<float> expected(features);
    std::vector<float> got(features);
    std::vector<std::uint8_t> planes(encoder.planes_size());
    std::vector<std::uint8_t> got_planes(encoder.planes_size());
    aquafarm::View view;
    aquafarm::View back;
    aquafarm_msgs::FarmState message;
    for (std::uint64_t episode = 0; episode < 10; ++episode) {
      farm.Reset(5, episode);
      for (int step = 0; step < 20 && !farm.over(); ++step) {
        aquafarm::test::RandomSteps(farm, 3, episode * 100 + static_cast<std::uint64_t>(step));
        for (std::int32_t ship = 0; ship < 5; ++ship) {
          Observe(farm, ship, view);
          ToMsg(farm, view, {}, message);
          FromMsg(message, farm.scenario(), farm.layout(), back);
          encoder.Features(view, expected.data());
          encoder.Features(back, got.data());
          ASSERT_EQ(got, expected) << "ship " << ship << " step " << farm.step();
          encoder.Planes(view, planes.data());
          encoder.Planes(back, got_planes.data());
          ASSERT_EQ(got_planes, planes);
          ASSERT_EQ(encoder.Index(back), encoder.Index(farm, ship));
        }
      }
    }
  }
}

TEST(Conversions, AnObservationOfAnotherFarmIsRefused) {
  const aquafarm::Farm farm = aquafarm::test::MakeFarm(aquafarm::test::TinyScenario());
  aquafarm_msgs::FarmState message;
  aquafarm::View view;
  ToMsg(farm, {}, message);
  const auto words = [&] {
    try {
      FromMsg(message, farm.scenario(), farm.layout(), view);
    } catch (const aquafarm::InputError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  EXPECT_EQ(words(), "observation: got observer -1 of 1 ships and 1 devices, expected 1 and 1");
  message.observer = 0;
  EXPECT_EQ(words(), "taken");
  message.devices[0].self_propelled = 1;
  EXPECT_EQ(words(), "observation: device 0 is self-propelled, expected one that a ship fetches");
  message.ships[0].x = 40;
  EXPECT_EQ(words(), "observation: got ship 0 at (40, 0), expected a cell of 5 x 5");
}

TEST(Conversions, FullObservationEqualsTheStateButForItsObserver) {
  Farm farm = aquafarm::test::MakeFarm(aquafarm::test::TinyScenario());
  aquafarm::test::StepOne(farm, Action::kNorth);
  aquafarm::View view;
  aquafarm::Observe(farm, 0, view);
  aquafarm_msgs::FarmState state;
  aquafarm_msgs::FarmState seen;
  ToMsg(farm, Context(), state);
  ToMsg(farm, view, Context(), seen);
  seen.observer = -1;
  EXPECT_EQ(state, seen);
}

TEST(Conversions, ChartRunsFromTheSouthWestCorner) {
  const Farm farm = aquafarm::test::MakeFarm(aquafarm::test::TinyScenario());
  const nav_msgs::OccupancyGrid chart = ChartToMsg(farm, Context());
  ASSERT_EQ(25U, chart.data.size());
  EXPECT_EQ(100, chart.data[0]);          // island at (0, 0)
  EXPECT_EQ(0, chart.data[2]);            // port at (2, 0)
  EXPECT_EQ(100, chart.data[3 * 5 + 3]);  // rock at (3, 3)
  EXPECT_EQ(0, chart.data[4 * 5]);        // water at (0, 4)
  EXPECT_DOUBLE_EQ(-500.0, chart.info.origin.position.x);
  EXPECT_FLOAT_EQ(1000.0F, chart.info.resolution);
}

TEST(Conversions, RiskIsAHundredAtMinusTwenty) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.disasters = {aquafarm::test::StillDisaster(0.0F, 4.0F, {0.5F, 1.5F}, {-20.0F, -5.0F})};
  const Farm farm = aquafarm::test::MakeFarm(scenario);
  nav_msgs::OccupancyGrid risk;
  RiskToMsg(farm.disasters(), scenario, Context(), risk);
  EXPECT_EQ(100, risk.data[4 * 5]);
  EXPECT_EQ(25, risk.data[4 * 5 + 1]);
  EXPECT_EQ(0, risk.data[4 * 5 + 2]);
}

TEST(Conversions, AShipThatFacesNorthHasAYawOfNinetyDegrees) {
  const Scenario scenario = aquafarm::test::TinyScenario();
  const auto pose = PoseToMsg("ship_0", 2, 3, 0, scenario, Context());
  EXPECT_EQ("map", pose.header.frame_id);
  EXPECT_EQ("ship_0", pose.child_frame_id);
  EXPECT_DOUBLE_EQ(2000.0, pose.transform.translation.x);
  EXPECT_DOUBLE_EQ(3000.0, pose.transform.translation.y);
  EXPECT_NEAR(std::sqrt(0.5), pose.transform.rotation.z, 1e-12);
  EXPECT_NEAR(std::sqrt(0.5), pose.transform.rotation.w, 1e-12);
}

TEST(Conversions, BearingsOfMovesFollowTheirCells) {
  for (int i = 0; i < aquafarm::kMoveCount; ++i) {
    const aquafarm::Cell by = aquafarm::kMoves[static_cast<std::size_t>(i)];
    const double degrees = std::atan2(by.x, by.y) * 180.0 / 3.14159265358979323846;
    const auto expected = static_cast<int>(std::lround(degrees + 360.0)) % 360;
    EXPECT_EQ(expected, BearingOf(static_cast<Action>(i), -1)) << i;
  }
  EXPECT_EQ(77, BearingOf(Action::kPickup, 77));
}

TEST(Conversions, UpAtTheOriginPointsAwayFromTheEarth) {
  const auto frame = EarthToMsg({30.2, 122.7}, "earth", Context());
  EXPECT_EQ("earth", frame.header.frame_id);
  EXPECT_EQ("map", frame.child_frame_id);
  const auto& t = frame.transform.translation;
  EXPECT_NEAR(6372.8e3, std::sqrt(t.x * t.x + t.y * t.y + t.z * t.z), 3e3);
  const auto& r = frame.transform.rotation;
  const tf2::Matrix3x3 matrix(tf2::Quaternion(r.x, r.y, r.z, r.w));
  const double latitude = 30.2 * 3.14159265358979323846 / 180.0;
  const tf2::Vector3 up = matrix * tf2::Vector3(0, 0, 1);
  EXPECT_NEAR(std::sin(latitude), up.z(), 1e-9);
  const tf2::Vector3 east = matrix * tf2::Vector3(1, 0, 0);
  EXPECT_NEAR(0.0, east.z(), 1e-9);
}

TEST(Conversions, DisasterInfoComesBackAsASpec) {
  aquafarm_msgs::DisasterInfo info;
  info.kind = aquafarm_msgs::DisasterState::OIL_SPILL;
  info.grade = 2;
  info.radii = {1.0F, 3.0F};
  info.risks = {-20.0F, -5.0F};
  info.speed = 0.25F;
  info.has_heading = true;
  info.heading_deg = 270;
  info.border = aquafarm_msgs::DisasterInfo::WRAP;
  info.duration = 40;
  info.has_start = true;
  info.x = 4.5F;
  info.y = -1.0F;
  const aquafarm::DisasterSpec spec = FromMsg(info);
  EXPECT_EQ(aquafarm::DisasterKind::kOilSpill, spec.kind);
  EXPECT_EQ(2, spec.grade);
  EXPECT_EQ(info.radii, spec.radii);
  EXPECT_EQ(270, spec.heading_deg.value());
  EXPECT_EQ(aquafarm::Border::kWrap, spec.border);
  EXPECT_EQ(40, spec.duration);
  EXPECT_FLOAT_EQ(-1.0F, spec.start.value()[1]);
  info.has_heading = false;
  info.has_start = false;
  EXPECT_FALSE(FromMsg(info).heading_deg.has_value());
  EXPECT_FALSE(FromMsg(info).start.has_value());
}

TEST(Conversions, DisasterInfoOutOfRangeIsRefusedWithWords) {
  aquafarm_msgs::DisasterInfo info;
  info.radii.assign(1000000, 1.0F);
  EXPECT_EQ("info.radii: got 1000000 entries, expected at most 4", RefusalOf(info));
  info.radii.clear();
  info.kind = 6;
  EXPECT_EQ("info.kind: got 6, expected [0, 5]", RefusalOf(info));
  info.kind = 0;
  info.border = 3;
  EXPECT_EQ("info.border: got 3, expected [0, 2]", RefusalOf(info));
  info.border = 0;
  info.track.resize(2);
  info.track[1].risks.resize(5);
  EXPECT_EQ("info.track[1].risks: got 5 entries, expected at most 4", RefusalOf(info));
  info.track.resize(kMaxWaypoints + 1);
  EXPECT_EQ("info.track: got 10001 entries, expected at most 10000", RefusalOf(info));
}

TEST(Conversions, WorldTimeCountsFromTheScenariosStart) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.step_duration_s = 180.0;
  EXPECT_EQ(ros::Time(360), WorldTime(scenario, 2));
  scenario.start_time = 1627084800;
  EXPECT_EQ(ros::Time(1627084980), WorldTime(scenario, 1));
  scenario.start_time = -5000;
  EXPECT_EQ(ros::Time(0), WorldTime(scenario, 1));
}

TEST(Conversions, SummaryGivesTheMeanHealthOfWhatWasDelivered) {
  aquafarm::EpisodeRecord record;
  record.delivered = 2;
  record.delivered_health = 1.5F;
  record.reason = aquafarm::EndReason::kStepLimit;
  const auto summary = ToMsg(record, std::nullopt, 3, Context());
  EXPECT_EQ(3, summary.farm);
  EXPECT_FLOAT_EQ(0.75F, summary.delivered_health);
  EXPECT_TRUE(summary.truncated);
  EXPECT_FALSE(summary.terminated);
  EXPECT_FALSE(summary.success);
  EXPECT_TRUE(summary.ledgers.empty()) << "a scenario without money has no accounts";
}

TEST(Conversions, SummaryGivesTheMoneyOfEachKindOfDevice) {
  aquafarm::Accounts accounts;
  accounts.by_kind[static_cast<std::size_t>(aquafarm::DeviceKind::kMonitoring)] = {450, 300, 100,
                                                                                   50};
  accounts.ship_cost = 1234;
  accounts.energy_cost = 56;
  const auto summary = ToMsg(aquafarm::EpisodeRecord{}, accounts, 0, Context());
  ASSERT_EQ(static_cast<std::size_t>(aquafarm::kDeviceKindCount), summary.ledgers.size());
  const aquafarm_msgs::Ledger& buoys = summary.ledgers[aquafarm_msgs::DeviceState::MONITORING];
  EXPECT_EQ(450, buoys.insured);
  EXPECT_EQ(300, buoys.saved);
  EXPECT_EQ(100, buoys.damaged);
  EXPECT_EQ(50, buoys.lost);
  EXPECT_EQ(0, summary.ledgers[aquafarm_msgs::DeviceState::DEEP_WATER_BREEDING].insured);
  EXPECT_EQ(1234, summary.ship_cost);
  EXPECT_EQ(56, summary.energy_cost);
}

}  // namespace
}  // namespace aquafarm_sim
