// SPDX-License-Identifier: BSD-3-Clause
// Commands of single ships: exactly-once execution, pace, lockstep barrier and claims.
#include "aquafarm_sim/server/farm_server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <future>
#include <thread>
#include <utility>
#include <vector>

#include "farm_server_fixture.h"

namespace aquafarm_sim {
namespace {

using namespace test;  // NOLINT: the fixture
using std::chrono::milliseconds;

TEST(FarmServer, ACommandMovesTheShipAndReturnsTheNextStep) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  const CommandResult result = ranch->Command({0, kNorth, 0, 0, 1});
  EXPECT_TRUE(result.ok);
  EXPECT_EQ(Outcome::OK, result.code);
  EXPECT_EQ(1U, result.step);
  EXPECT_FLOAT_EQ(-1.0F, result.reward);
  EXPECT_FLOAT_EQ(-1.0F, result.terms.step);
  EXPECT_EQ(StateOf(*ranch).hash, result.hash);
  EXPECT_EQ(1, StateOf(*ranch).ships[0].y);
}

TEST(FarmServer, RepeatingTheLastAcceptedCommandMovesNothing) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  ranch->Command({0, kNorth, 0, 0, 1});
  const CommandResult first = ranch->Command({0, kNorth, 0, 1, 0});
  const CommandResult again = ranch->Command({0, kNorth, 0, 1, 0});
  EXPECT_EQ(first, again);
  EXPECT_EQ(2U, StateOf(*ranch).step);
}

TEST(FarmServer, ATokenIdentifiesARetryOfTheFirstCommand) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  const CommandResult first = ranch->Command({0, kNorth, 0, 0, 77});
  EXPECT_EQ(first, ranch->Command({0, kNorth, 0, 0, 77}));
  EXPECT_EQ(1U, StateOf(*ranch).step);
}

TEST(FarmServer, WithoutNumbersEachCommandCounts) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  ranch->Command({0, kNorth, 0, 0, 0});
  ranch->Command({0, kNorth, 0, 0, 0});
  EXPECT_EQ(2, StateOf(*ranch).ships[0].y);
}

TEST(FarmServer, AnotherStepOrEpisodeIsStale) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  ranch->Command({0, kNorth, 0, 0, 0});
  ranch->Command({0, kNorth, 0, 0, 0});
  const std::uint64_t hash = StateOf(*ranch).hash;
  const CommandResult past = ranch->Command({0, kNorth, 0, 1, 0});
  EXPECT_EQ(Outcome::STALE, past.code);
  EXPECT_EQ("meant for episode 0 step 1, the farm is at episode 0 step 2", past.message);
  EXPECT_EQ(Outcome::STALE, ranch->Command({0, kNorth, 0, 3, 0}).code);
  EXPECT_EQ(Outcome::STALE, ranch->Command({0, kNorth, 1, 2, 0}).code);
  EXPECT_EQ(hash, StateOf(*ranch).hash);
}

TEST(FarmServer, UnknownShipsDirectionsAndActionsAreRefused) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  const std::uint64_t hash = StateOf(*ranch).hash;
  EXPECT_EQ(Outcome::UNKNOWN_SHIP, ranch->Command({1, kNorth, 0, 0, 0}).code);
  EXPECT_EQ(Outcome::UNKNOWN_SHIP, ranch->Command({-1, kNorth, 0, 0, 0}).code);
  EXPECT_EQ(Outcome::BAD_ACTION, ranch->Command({0, 11, 0, 0, 0}).code);
  const CommandResult bad = ranch->MoveShip({0, 250, 0, 0, 0});
  EXPECT_EQ(Outcome::BAD_DIRECTION, bad.code);
  EXPECT_EQ("direction: got 250, expected [0, 7]", bad.message);
  EXPECT_EQ(Outcome::BAD_DIRECTION, ranch->MoveShip({0, kPickup, 0, 0, 0}).code);
  EXPECT_EQ(hash, StateOf(*ranch).hash);
}

TEST(FarmServer, AfterTheEndCommandsAreAnsweredEpisodeOver) {
  aquafarm::Scenario scenario = aquafarm::test::TinyScenario();
  scenario.step_limit = 1;
  const auto ranch = MakeRanch(scenario);
  const CommandResult last = ranch->Command({0, kNorth, 0, 0, 0});
  EXPECT_TRUE(last.truncated);
  EXPECT_FALSE(last.terminated);
  EXPECT_EQ(aquafarm_msgs::FarmState::STEP_LIMIT, last.reason);
  EXPECT_EQ(Outcome::EPISODE_OVER, ranch->Command({0, kNorth, 0, 0, 0}).code);
  EXPECT_EQ(1U, StateOf(*ranch).step);
}

TEST(FarmServer, TheBarrierStepsWhenTheLastShipHasSpoken) {
  const auto ranch = MakeRanch(TwoShips());
  auto first = std::async(std::launch::async, [&] { return ranch->Command({0, kNorth, 0, 0, 1}); });
  std::this_thread::sleep_for(milliseconds(50));
  EXPECT_EQ(0U, StateOf(*ranch).step);
  const CommandResult second = ranch->Command({1, kHold, 0, 0, 1});
  const CommandResult waited = first.get();
  EXPECT_EQ(Outcome::HELD, second.code);
  EXPECT_EQ(Outcome::OK, waited.code);
  EXPECT_EQ(1U, waited.step);
  EXPECT_EQ(second.hash, waited.hash);
}

TEST(FarmServer, ALoneCommandTimesOutAndIsTakenBack) {
  const auto ranch = MakeRanch(TwoShips());
  const std::uint64_t hash = StateOf(*ranch).hash;
  const CommandResult lone = ranch->Command({0, kNorth, 0, 0, 1});
  EXPECT_EQ(Outcome::TIMEOUT, lone.code);
  EXPECT_EQ("barrier timed out: no command from other ships within 1.000000 s: 1", lone.message);
  EXPECT_EQ(hash, StateOf(*ranch).hash);
  const CommandResult other = ranch->Command({1, kNorth, 0, 0, 1});
  EXPECT_EQ(Outcome::TIMEOUT, other.code);
  EXPECT_EQ(2U, ranch->counters().barrier_timeouts);
}

TEST(FarmServer, ContinuesWithoutAbsentShipsUntilTheyReturnIfConfigured) {
  ServerOptions options;
  options.barrier_timeout_s = 1.0;
  options.late_ships_hold = true;
  const auto ranch = MakeRanchOf(TwoShips(), options);
  struct Ears final : FarmListener {
    void OnChange(const ServerView&) override {}
    void OnEpisodeEnd(const aquafarm_msgs::EpisodeSummary&) override {}
    void OnPresence(const std::vector<std::int32_t>& ships, bool is_present) override {
      for (const std::int32_t ship : ships) {
        heard += (is_present ? "back " : "absent ") + std::to_string(ship) + ";";
      }
    }
    std::string heard;
  } ears;
  ranch->SetListener(&ears);
  const auto began = std::chrono::steady_clock::now();
  EXPECT_EQ(Outcome::OK, ranch->Command({0, kNorth, 0, 0, 1}).code);
  EXPECT_GE(std::chrono::steady_clock::now() - began, milliseconds(1000));
  const auto again = std::chrono::steady_clock::now();
  for (std::uint64_t token = 2; token < 12; ++token) {
    EXPECT_EQ(Outcome::HELD, ranch->Command({0, kHold, 0, 0, token}).code);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - again, milliseconds(2000)) << "it waits but once";
  EXPECT_EQ(1U, ranch->counters().late_ships);
  EXPECT_EQ(std::vector<std::int32_t>{1}, ranch->counters().absent);
  // When it is back, it joins the running episode, and the farm waits for it.
  auto back = std::async(std::launch::async, [&] { return ranch->Command({1, kHold, 0, 0, 1}); });
  std::this_thread::sleep_for(milliseconds(50));
  EXPECT_EQ(Outcome::HELD, ranch->Command({0, kHold, 0, 0, 12}).code);
  const auto answer = back.get();
  EXPECT_EQ(Outcome::HELD, answer.code);
  EXPECT_EQ(12U, answer.step);
  EXPECT_TRUE(ranch->counters().absent.empty());
  EXPECT_EQ((std::vector<std::uint64_t>{0, 1}), ranch->counters().absences);
  ranch->SetListener(nullptr);
  EXPECT_EQ("absent 1;back 1;", ears.heard) << "each at once, however short the absence was";
}

TEST(FarmServer, AShipThatIsAlwaysTooLateIsWaitedForAgain) {
  ServerOptions options;
  options.barrier_timeout_s = 1.0;
  options.late_ships_hold = true;
  const auto ranch = MakeRanchOf(TwoShips(), options);
  ranch->Command({0, kNorth, 0, 0, 1});  // ship 1 becomes absent
  EXPECT_EQ(Outcome::STALE, ranch->Command({1, kHold, 9, 9, 1}).code);
  auto waiting = std::async(std::launch::async, [&] {
    return ranch->Command({0, kHold, 0, 0, 2});
  });
  std::this_thread::sleep_for(milliseconds(50));
  EXPECT_EQ(2U, ranch->Command({1, kHold, 0, 0, 2}).step);
  EXPECT_EQ(2U, waiting.get().step);
}

TEST(FarmServer, APausedFarmDoesNotStepWithoutAbsentShips) {
  ServerOptions options;
  options.barrier_timeout_s = 1.0;
  options.late_ships_hold = true;
  const auto ranch = MakeRanchOf(TwoShips(), options);
  auto waiting = std::async(std::launch::async, [&] {
    return ranch->Command({0, kHold, 0, 0, 1});
  });
  std::this_thread::sleep_for(milliseconds(50));
  aquafarm_msgs::Pause::Request pause;
  aquafarm_msgs::Pause::Response paused;
  pause.paused = true;
  ranch->Pause(pause, paused);
  EXPECT_EQ(Outcome::TIMEOUT, waiting.get().code);
  EXPECT_EQ(0U, StateOf(*ranch).step);
}

TEST(FarmServer, AClaimedShipObeysItsHolderAlone) {
  ServerOptions options;
  options.claim_timeout_s = 1.0;
  const auto ranch = MakeRanchOf(aquafarm::test::TinyScenario(), options);
  const auto claim = [&](const std::string& caller, bool release) {
    aquafarm_msgs::Claim::Response response;
    ranch->Claim(0, caller, release, response);
    return response;
  };
  EXPECT_TRUE(claim("/one", false).ok);
  const auto refused = claim("/two", false);
  EXPECT_FALSE(refused.ok);
  EXPECT_EQ(Outcome::CLAIMED, refused.code);
  EXPECT_EQ("ship 0 is held by /one", refused.message);
  const auto foreign = ranch->Command({0, kNorth, 0, 0, 1, "/two"});
  EXPECT_EQ(Outcome::CLAIMED, foreign.code);
  EXPECT_EQ("ship 0 is held by /one", foreign.message);
  EXPECT_EQ(0U, foreign.step) << "the farm is untouched";
  EXPECT_EQ(Outcome::OK, ranch->Command({0, kNorth, 0, 0, 2, "/one"}).code);
  EXPECT_FALSE(claim("/two", true).ok) << "a client cannot release another client's claim";
  EXPECT_TRUE(claim("/one", true).ok);
  EXPECT_EQ("", claim("/one", true).holder);
  EXPECT_TRUE(claim("/two", false).ok);
  std::this_thread::sleep_for(milliseconds(1200));  // longer than the claim timeout
  EXPECT_TRUE(claim("/three", false).ok);
}

TEST(FarmServer, ANewerCommandOfTheSameShipSupersedesTheWaitingOne) {
  const auto ranch = MakeRanch(TwoShips());
  auto old = std::async(std::launch::async, [&] { return ranch->Command({0, kNorth, 0, 0, 1}); });
  std::this_thread::sleep_for(milliseconds(50));
  auto newer = std::async(std::launch::async, [&] { return ranch->Command({0, kHold, 0, 0, 2}); });
  EXPECT_EQ(Outcome::SUPERSEDED, old.get().code);
  ranch->Command({1, kHold, 0, 0, 1});
  EXPECT_EQ(Outcome::HELD, newer.get().code);
}

TEST(FarmServer, ACommandThatWasCarriedOutIsAnsweredSoWhateverCameAfterIt) {
  // Sends the next commands of both ships in the middle of every second step. They queue for the
  // ranch before the calls that wait for the step get its result.
  struct Sender final : FarmRecorder {
    void OnStart(const aquafarm::Farm&, std::int32_t, const MessageContext&) override {}
    void OnStep(const aquafarm::Farm& farm, std::int32_t, const std::uint8_t*) override {
      if (farm.step() % 2 == 0) return;
      for (const std::int32_t ship : {0, 1}) next.push_back(send(ship));
      std::this_thread::sleep_for(milliseconds(20));
    }
    void OnIntervention(const aquafarm::Farm&, std::int32_t) override {}
    std::function<std::future<CommandResult>(std::int32_t)> send;
    std::vector<std::future<CommandResult>> next;
  } sender;
  const auto ranch = MakeRanch(TwoShips());
  std::atomic<std::uint64_t> token{0};
  sender.send = [&](std::int32_t ship) {
    return std::async(std::launch::async, [&ranch, ship, mark = ++token] {
      return ranch->Command({ship, kHold, 0, 0, mark});
    });
  };
  ranch->SetRecorder(&sender);
  for (std::int32_t i = 0; i < 5; ++i) {
    auto first = sender.send(0);
    auto partner = sender.send(1);
    EXPECT_EQ(Outcome::HELD, first.get().code);
    EXPECT_EQ(Outcome::HELD, partner.get().code);
    for (auto& answer : std::exchange(sender.next, {})) EXPECT_EQ(Outcome::HELD, answer.get().code);
  }
  EXPECT_EQ(10U, StateOf(*ranch).step);
  EXPECT_EQ(0U, ranch->counters().superseded);
  ranch->SetRecorder(nullptr);
}

TEST(FarmServer, AStepWhoseNotificationFailsIsKeptForAllShips) {
  struct Deaf final : FarmListener {
    void OnChange(const ServerView& view) override {
      if (view.batch.farm(0).step() > 0) throw std::runtime_error("no memory");
    }
    void OnEpisodeEnd(const aquafarm_msgs::EpisodeSummary&) override {}
  } deaf;
  const auto ranch = MakeRanch(TwoShips());
  ranch->SetListener(&deaf);
  auto waiting = std::async(std::launch::async, [&] {
    return ranch->Command({0, kNorth, 0, 0, 1});
  });
  std::this_thread::sleep_for(milliseconds(50));
  const CommandResult last = ranch->Command({1, kHold, 0, 0, 1});
  const CommandResult first = waiting.get();
  EXPECT_TRUE(last.ok) << last.message;
  EXPECT_TRUE(first.ok) << first.message;
  EXPECT_EQ(1U, first.step);
  EXPECT_EQ(last, ranch->Command({1, kHold, 0, 0, 1}));
  EXPECT_EQ(1U, StateOf(*ranch).step);
  EXPECT_EQ(1U, ranch->counters().dropped_notifications);
  EXPECT_EQ("no memory", ranch->counters().dropped_reason);
  ranch->SetListener(nullptr);
}

TEST(FarmServer, AStepThatFailsReachesTheWaitingShipsAndTheListenerWithItsReason) {
  struct Full final : FarmRecorder {
    void OnStart(const aquafarm::Farm&, std::int32_t, const MessageContext&) override {}
    void OnStep(const aquafarm::Farm&, std::int32_t, const std::uint8_t*) override {
      throw std::runtime_error("no memory");
    }
    void OnIntervention(const aquafarm::Farm&, std::int32_t) override {}
  } full;
  struct Counter final : FarmListener {
    void OnChange(const ServerView&) override { ++changes; }
    void OnEpisodeEnd(const aquafarm_msgs::EpisodeSummary&) override {}
    int changes{};
  } counter;
  const auto ranch = MakeRanch(TwoShips());
  ranch->SetRecorder(&full);
  ranch->SetListener(&counter);
  const int before = counter.changes;
  auto waiting = std::async(std::launch::async, [&] {
    return ranch->Command({0, kNorth, 0, 0, 1});
  });
  std::this_thread::sleep_for(milliseconds(50));
  const CommandResult last = ranch->Command({1, kHold, 0, 0, 1});
  EXPECT_EQ(Outcome::INTERNAL_ERROR, last.code);
  EXPECT_EQ("no memory", last.message);
  const CommandResult first = waiting.get();
  EXPECT_EQ(Outcome::STALE, first.code);
  EXPECT_EQ("the step failed: no memory", first.message);
  EXPECT_GT(counter.changes, before);
  ranch->SetRecorder(nullptr);
  ranch->SetListener(nullptr);
}

TEST(FarmServer, AResetReleasesWaitingCommands) {
  const auto ranch = MakeRanch(TwoShips());
  auto waiting = std::async(std::launch::async, [&] {
    return ranch->Command({0, kNorth, 0, 0, 1});
  });
  std::this_thread::sleep_for(milliseconds(50));
  ResetTo(*ranch, 9);
  EXPECT_EQ(Outcome::STALE, waiting.get().code);
}

TEST(FarmServer, ShutdownReleasesWaitingCommands) {
  const auto ranch = MakeRanch(TwoShips());
  auto waiting = std::async(std::launch::async, [&] {
    return ranch->Command({0, kNorth, 0, 0, 1});
  });
  std::this_thread::sleep_for(milliseconds(50));
  ranch->Shutdown();
  EXPECT_EQ(Outcome::SHUTTING_DOWN, waiting.get().code);
  EXPECT_EQ(Outcome::SHUTTING_DOWN, ranch->Command({1, kNorth, 0, 0, 1}).code);
}

TEST(FarmServer, ManyThreadsMoveEachShipOnceAStep) {
  const auto ranch = MakeRanch(TwoShips());
  constexpr std::uint64_t kSteps = 500;
  const auto drive = [&](std::int32_t ship) {
    for (std::uint64_t step = 0; step < kSteps; ++step) {
      const CommandResult result =
          ranch->Command({ship, static_cast<std::uint8_t>(step % 8), 0, step, step + 1});
      ASSERT_TRUE(result.ok) << result.message;
      ASSERT_EQ(step + 1, result.step);
    }
  };
  std::thread other([&] { drive(1); });
  drive(0);
  other.join();
  EXPECT_EQ(kSteps, StateOf(*ranch).step);
}

TEST(FarmServer, PacedCommandsAreAcceptedAndCarriedOutByTheTick) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario(), 1, true);
  const CommandResult accepted = ranch->Command({0, kNorth, 0, 0, 1});
  EXPECT_EQ(Outcome::ACCEPTED, accepted.code);
  EXPECT_EQ(1U, accepted.step);
  EXPECT_EQ(0U, StateOf(*ranch).step);
  ranch->Tick();
  EXPECT_EQ(1, StateOf(*ranch).ships[0].y);
}

TEST(FarmServer, APacedShipWithoutACommandHolds) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario(), 1, true);
  ranch->Tick();
  const auto state = StateOf(*ranch);
  EXPECT_EQ(1U, state.step);
  EXPECT_EQ(0, state.ships[0].y);
  EXPECT_EQ(Outcome::HELD, state.ships[0].outcome);
  EXPECT_EQ(1U, ranch->counters().late_ships);
}

TEST(FarmServer, APacedFarmBeginsTheNextEpisodeByItself) {
  aquafarm::Scenario scenario = aquafarm::test::TinyScenario();
  scenario.step_limit = 1;
  const auto ranch = MakeRanch(scenario, 1, true);
  ranch->Tick();
  EXPECT_TRUE(StateOf(*ranch).truncated);
  EXPECT_EQ(Outcome::EPISODE_OVER, ranch->Command({0, kNorth, 0, 1, 0}).code);
  ranch->Tick();
  EXPECT_EQ(1U, StateOf(*ranch).episode);
  EXPECT_EQ(0U, StateOf(*ranch).step);
}

TEST(FarmServer, PacedRunningTakesStepsOnTime) {
  ServerOptions options;
  options.paced = true;
  options.rate_hz = 100.0;
  FarmServer ranch(std::make_shared<const aquafarm::Scenario>(aquafarm::test::TinyScenario()),
                   options);
  const auto began = std::chrono::steady_clock::now();
  std::thread pacer([&] { ranch.RunPaced(); });
  std::this_thread::sleep_for(milliseconds(500));
  aquafarm_msgs::Pause pause;
  pause.request.paused = true;
  ranch.Pause(pause.request, pause.response);
  // A busy machine may take more than half a second for this.
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  const std::uint64_t steps = StateOf(ranch).step;
  EXPECT_GT(steps, 5U);
  EXPECT_LE(static_cast<double>(steps), 100.0 * took.count() + 2.0);
  std::this_thread::sleep_for(milliseconds(50));
  EXPECT_EQ(steps, StateOf(ranch).step);
  ranch.Shutdown();
  pacer.join();
}

TEST(FarmServer, APauseMayComeAfterSoManySteps) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  aquafarm_msgs::Pause pause;
  pause.request.paused = true;
  pause.request.steps = 2;
  ranch->Pause(pause.request, pause.response);
  EXPECT_FALSE(pause.response.paused);
  EXPECT_EQ(Outcome::OK, ranch->Command({0, kNorth, 0, 0, 0}).code);
  EXPECT_FALSE(StateOf(*ranch).paused);
  EXPECT_EQ(Outcome::OK, ranch->Command({0, kSouth, 0, 0, 0}).code);
  EXPECT_TRUE(StateOf(*ranch).paused);
  EXPECT_EQ(Outcome::PAUSED, ranch->Command({0, kNorth, 0, 0, 0}).code);
}

TEST(FarmServer, WhilePausedCommandsAreAnsweredPaused) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  aquafarm_msgs::Pause pause;
  pause.request.paused = true;
  ranch->Pause(pause.request, pause.response);
  EXPECT_EQ(Outcome::PAUSED, ranch->Command({0, kNorth, 0, 0, 0}).code);
  pause.request.paused = false;
  ranch->Pause(pause.request, pause.response);
  EXPECT_EQ(Outcome::OK, ranch->Command({0, kNorth, 0, 0, 0}).code);
}

}  // namespace
}  // namespace aquafarm_sim
