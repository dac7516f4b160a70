// SPDX-License-Identifier: BSD-3-Clause
// Farms behind ROS services are bit-identical to farms in this process.
#include "aquafarm_agents/link/ros_environment.h"

#include <aquafarm_msgs/DropOff.h>
#include <aquafarm_msgs/Move.h>
#include <aquafarm_msgs/Pause.h>
#include <aquafarm_msgs/Pickup.h>
#include <aquafarm_msgs/SetPace.h>
#include <gtest/gtest.h>
#include <ros/init.h>

#include <functional>

#include "agents_fixture.h"
#include "aquafarm_sim/names.h"
#include "environment_contract.h"

namespace aquafarm_agents {
namespace {

using namespace aquafarm::agents;        // NOLINT: used in the whole file
using namespace aquafarm::agents::test;  // NOLINT

constexpr std::uint8_t kEverything = kIndexBit | kFeaturesBit | kPlanesBit;

RosEnvironment Connect(const std::string& ranch, std::int32_t farms,
                       std::uint8_t observation_types) {
  RosEnvironmentOptions options;
  options.farms = farms;
  options.observation_types = observation_types;
  options.hashes = true;
  return {ros::NodeHandle(ranch), options};
}

/// The same scenario as the sim node's, in this process.
LocalEnvironment InProcess(const EnvironmentSpec& spec, std::uint8_t observation_types) {
  return {std::make_shared<const aquafarm::Scenario>(
              aquafarm::ParseScenario(spec.scenario_yaml, spec.scenario_name)),
          {spec.farms, observation_types, true, 1}};
}

void ExpectSameFinished(const StepResults& a, const StepResults& b) {
  ASSERT_EQ(a.finished.size(), b.finished.size());
  for (std::size_t i = 0; i < a.finished.size(); ++i) {
    EXPECT_EQ(a.finished[i].farm, b.finished[i].farm);
    EXPECT_EQ(a.finished[i].seed, b.finished[i].seed);
    EXPECT_EQ(a.finished[i].episode, b.finished[i].episode);
    EXPECT_EQ(a.finished[i].steps, b.finished[i].steps);
    EXPECT_EQ(a.finished[i].episode_return, b.finished[i].episode_return);
    EXPECT_EQ(a.finished[i].delivered, b.finished[i].delivered);
    EXPECT_EQ(a.finished[i].delivered_health, b.finished[i].delivered_health);
    EXPECT_EQ(a.finished[i].reason, b.finished[i].reason);
  }
}

/// Continues both with the same random actions. @returns the number of episodes that ended
std::size_t ExpectSameSteps(Environment& ros, Environment& local, RandomActions random, int steps) {
  std::size_t ended = 0;
  for (int step = 0; step < steps && !::testing::Test::HasFailure(); ++step) {
    const auto actions = random.Next(SlotCount(local.spec()));
    const StepResults& got = ros.Step(actions);
    const StepResults& expected = local.Step(actions);
    ExpectSame(got, expected);
    ExpectSameFinished(got, expected);
    ended += expected.finished.size();
  }
  return ended;
}

/// Plays the same episodes on both. @returns the number of episodes that ended
std::size_t ExpectSameTransitions(Environment& ros, Environment& local, int steps) {
  ExpectSame(ros.Reset(23, 4), local.Reset(23, 4));
  return ExpectSameSteps(ros, local, RandomActions(17), steps);
}

TEST(RosEnvironment, TenThousandStepsAreThoseOfThisProcess) {
  RosEnvironment ros = Connect("paper", 1, kIndexBit);
  LocalEnvironment local = InProcess(ros.spec(), kIndexBit);
  EXPECT_EQ(ros.spec().scenario_hash, local.spec().scenario_hash);
  EXPECT_EQ(ros.spec().state_count, local.spec().state_count);
  EXPECT_GE(ExpectSameTransitions(ros, local, 10000), 1U);
}

TEST(RosEnvironment, ManyFarmsAndAllObservationTypesAreThoseOfThisProcess) {
  RosEnvironment ros = Connect("procedural", 16, kFeaturesBit | kPlanesBit);
  LocalEnvironment local = InProcess(ros.spec(), kFeaturesBit | kPlanesBit);
  ExpectSameTransitions(ros, local, 500);
}

TEST(RosEnvironment, ShipsAndFarmsThatEndOftenAreThoseOfThisProcess) {
  RosEnvironment ros = Connect("pair", 5, kFeaturesBit);
  LocalEnvironment local = InProcess(ros.spec(), kFeaturesBit);
  EXPECT_GT(ExpectSameTransitions(ros, local, 2000), 100U);
}

TEST(RosEnvironment, SplitsTheTeamRewardByAgentAsInThisProcess) {
  RosEnvironment ros = Connect("team", 3, kFeaturesBit | kOwnRewardsBit);
  LocalEnvironment local = InProcess(ros.spec(), kFeaturesBit | kOwnRewardsBit);
  EXPECT_FALSE(ros.spec().team_reward);
  EXPECT_GT(ExpectSameTransitions(ros, local, 500), 10U);
  ExpectSame(ros.Load(ros.Save()), local.Load(local.Save()));
}

TEST(RosEnvironment, KeepsTheContractOfEveryEnvironment) {
  RosEnvironment environment = Connect("paper", 2, kIndexBit);
  RunEnvironmentContract(environment, 2500);
}

TEST(RosEnvironment, KeepsTheContractWithTwoShips) {
  RosEnvironment environment = Connect("pair", 3, kEverything);
  RunEnvironmentContract(environment, 600, false);
}

/// Sends one command through a ship's own service.
template <typename Service, typename Fill>
aquafarm_msgs::CommandResult Send(ros::ServiceClient& client, Fill fill) {
  Service service;
  fill(service.request);
  EXPECT_TRUE(client.call(service));
  return service.response.result;
}

TEST(ShipServices, ThousandCommandsAreThoseOfThisProcess) {
  namespace names = aquafarm_sim::names;
  ros::NodeHandle node("paper");
  RosEnvironment ros = Connect("paper", 1, kIndexBit);
  LocalEnvironment local = InProcess(ros.spec(), kIndexBit);
  ros.Reset(31);
  local.Reset(31);
  auto move = node.serviceClient<aquafarm_msgs::Move>(names::Move(0), true);
  auto pickup = node.serviceClient<aquafarm_msgs::Pickup>(names::Pickup(0), true);
  auto drop_off = node.serviceClient<aquafarm_msgs::DropOff>(names::DropOff(0), true);
  RandomActions random(5);
  for (std::uint64_t step = 0; step < 1000; ++step) {
    const auto actions = random.Next(1);
    const auto meant_for = [step](auto& request) { request.step = step; };
    aquafarm_msgs::CommandResult result;
    if (actions[0] < aquafarm::kMoveCount) {
      result = Send<aquafarm_msgs::Move>(move, [&](auto& request) {
        request.direction = actions[0];
        meant_for(request);
      });
    } else if (actions[0] == static_cast<std::uint8_t>(aquafarm::Action::kPickup)) {
      result = Send<aquafarm_msgs::Pickup>(pickup, meant_for);
    } else {
      result = Send<aquafarm_msgs::DropOff>(drop_off, meant_for);
    }
    const StepResults& expected = local.Step(actions);
    ASSERT_TRUE(result.ok) << result.message;
    ASSERT_EQ(result.hash, expected.hashes[0]) << "step " << step;
    ASSERT_EQ(result.reward, expected.rewards[0]);
    ASSERT_EQ(result.legal_actions, expected.legal[0]);
    ASSERT_EQ(result.reason, expected.end_reasons[0]);
    if (result.reason != 0) break;
  }
}

TEST(RosEnvironment, WaitsWhileTheFarmIsPaused) {
  ros::NodeHandle node("pair");
  RosEnvironmentOptions options;
  options.farms = 1;
  options.observation_types = 0;
  options.pause_limit_s = 1.0;
  std::vector<std::string> notices;
  options.on_notice = [&notices](const std::string& text) { notices.push_back(text); };
  RosEnvironment environment(node, options);
  environment.Reset(1);
  const auto pause = [&node](bool value) {
    aquafarm_msgs::Pause service;
    service.request.paused = value;
    return node.serviceClient<aquafarm_msgs::Pause>("pause").call(service) && service.response.ok;
  };
  ASSERT_TRUE(pause(true));
  EXPECT_CONTAINS(
      MessageOf<EnvironmentLost>([&] { environment.Step(std::vector<std::uint8_t>(2, 0)); }),
      "waited 1 s");
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_CONTAINS(notices[0], "waiting up to 1 s for the sim node");
  ASSERT_TRUE(pause(false));
  environment.Step(std::vector<std::uint8_t>(2, 0));
}

TEST(RosEnvironment, StartsAfreshWhenAnotherHasMovedOrResetTheFarms) {
  namespace names = aquafarm_sim::names;
  ros::NodeHandle node("paper");
  RosEnvironmentOptions options;
  options.farms = 3;
  std::vector<std::string> notices;
  options.on_notice = [&notices](const std::string& text) { notices.push_back(text); };
  RosEnvironment environment(node, options);
  environment.Reset(1, 10);
  const std::vector<std::uint8_t> actions(3, 0);
  const auto step = [&] { return environment.Step(actions).is_first[0] != 0; };
  EXPECT_FALSE(step());
  const auto foreign_reset = [&] {
    aquafarm_msgs::Reset reset;
    ASSERT_TRUE(node.serviceClient<aquafarm_msgs::Reset>(names::kReset).call(reset));
    ASSERT_TRUE(reset.response.ok) << reset.response.message;
  };
  const auto foreign_command = [&] {
    aquafarm_msgs::Move move;
    ASSERT_TRUE(node.serviceClient<aquafarm_msgs::Move>(names::Move(0)).call(move));
    ASSERT_TRUE(move.response.result.ok) << move.response.result.message;
  };
  const std::vector<std::function<void()>> others{foreign_reset, foreign_command};
  for (std::size_t i = 0; i < others.size(); ++i) {
    others[i]();
    EXPECT_TRUE(step()) << "no transition leads from one episode into another";
    EXPECT_TRUE(environment.ConsumeRestart());
    ASSERT_EQ(i + 1, notices.size());
    EXPECT_CONTAINS(notices.back(),
                    "another client has stepped or reset them, or the node has restarted");
    EXPECT_CONTAINS(notices.back(), "new episodes from number " + std::to_string(13 + 3 * i));
    EXPECT_FALSE(step());
    EXPECT_FALSE(environment.ConsumeRestart());
  }
}

TEST(RosEnvironment, AShareOfTheFarmsIsThatOfThisProcess) {
  RosEnvironmentOptions options;
  options.farms = 2;
  options.observation_types = kFeaturesBit;
  options.hashes = true;
  options.share = {4, 8};
  RosEnvironment ros(ros::NodeHandle("pair"), options);
  const auto scenario = std::make_shared<const aquafarm::Scenario>(
      aquafarm::ParseScenario(ros.spec().scenario_yaml, ros.spec().scenario_name));
  LocalEnvironment local(scenario, {2, kFeaturesBit, true, 1}, options.share);
  EXPECT_GT(ExpectSameTransitions(ros, local, 500), 10U);
  // A rank takes its part of the farms of all ranks.
  LocalEnvironment all(scenario, {8, kFeaturesBit, true, 1});
  all.Reset(9);
  ExpectSame(ros.Load(all.Save()), local.Load(all.Save()));
  EXPECT_GT(ExpectSameSteps(ros, local, RandomActions(3), 200), 5U);
}

TEST(RosEnvironment, AShareKeepsToItsEpisodesAfterALossOfTheFarms) {
  ros::NodeHandle node("pair");
  RosEnvironmentOptions options;
  options.farms = 2;
  options.observation_types = 0;
  options.share = {4, 8};
  std::vector<std::string> notices;
  options.on_notice = [&notices](const std::string& text) { notices.push_back(text); };
  RosEnvironment environment(node, options);
  environment.Reset(1, 3);
  const std::vector<std::uint8_t> actions(SlotCount(environment.spec()), 0);
  std::size_t ended = 0;
  while (ended == 0) ended = environment.Step(actions).finished.size();
  aquafarm_msgs::Reset reset;
  ASSERT_TRUE(node.serviceClient<aquafarm_msgs::Reset>("reset").call(reset));
  environment.Step(actions);
  EXPECT_TRUE(environment.ConsumeRestart());
  ASSERT_EQ(notices.size(), 1U);
  // Farms 0 to 7 have started 3 to 10; farm 4 or 5 may have started 15 or 16. 19 = 3 + 2 * 8.
  EXPECT_CONTAINS(notices.back(), "new episodes from number 19");
  aquafarm_msgs::GetState state;
  ASSERT_TRUE(node.serviceClient<aquafarm_msgs::GetState>("get_state").call(state));
  EXPECT_EQ(state.response.state.episode, 23U);
}

TEST(RosEnvironment, EndsWhereAnotherTrainsOnTheSameFarms) {
  ros::NodeHandle node("paper");
  RosEnvironment environment(node, {});
  aquafarm_msgs::Reset reset;
  auto other = node.serviceClient<aquafarm_msgs::Reset>(aquafarm_sim::names::kReset, true);
  environment.Reset(1);
  const std::vector<std::uint8_t> actions(static_cast<std::size_t>(environment.spec().farms), 0);
  EXPECT_CONTAINS(MessageOf<EnvironmentLost>([&] {
                    for (int i = 0; i < 100 && other.call(reset); ++i) environment.Step(actions);
                  }),
                  "another client keeps changing the farms");
}

TEST(RosEnvironment, RefusesFarmsThatItCannotUse) {
  ros::NodeHandle node("pair");
  RosEnvironmentOptions options;
  options.farms = 5000;
  EXPECT_CONTAINS(MessageOf<aquafarm::InputError>([&] { RosEnvironment(node, options); }),
                  "reset refused");
  aquafarm_msgs::SetPace pace;
  pace.request.pace = "paced";
  auto set_pace = node.serviceClient<aquafarm_msgs::SetPace>("set_pace");
  ASSERT_TRUE(set_pace.call(pace) && pace.response.ok) << pace.response.message;
  EXPECT_CONTAINS(MessageOf<aquafarm::InputError>([&] { RosEnvironment(node, {}); }),
                  "expected pace lockstep");
  pace.request.pace = "lockstep";
  ASSERT_TRUE(set_pace.call(pace) && pace.response.ok) << pace.response.message;
}

TEST(RosEnvironment, AMissingNodeIsReportedWithinTheLimit) {
  RosEnvironmentOptions options;
  options.wait_limit_s = 1.5;
  std::vector<std::string> notices;
  options.on_notice = [&notices](const std::string& text) { notices.push_back(text); };
  EXPECT_CONTAINS(
      MessageOf<EnvironmentLost>([&] { RosEnvironment(ros::NodeHandle("nowhere"), options); }),
      "no response from service /nowhere/get_state for 2 s");
  EXPECT_EQ(notices.size(), 1U);
}

}  // namespace
}  // namespace aquafarm_agents

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "ros_environment_test");
  const ros::NodeHandle node;  // keeps ROS up between tests
  return RUN_ALL_TESTS();
}
