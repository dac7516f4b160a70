// SPDX-License-Identifier: BSD-3-Clause
// Joint steps, episodes, saved states and pace.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "aquafarm/base/rng.h"
#include "aquafarm/observation/view.h"
#include "farm_server_fixture.h"

namespace aquafarm_sim {
namespace {

using namespace test;  // NOLINT: the fixture
using aquafarm_msgs::StepResult;

aquafarm_msgs::Step::Response StepAll(FarmServer& ranch, const std::vector<std::uint8_t>& actions,
                                      std::uint8_t observation_types = 0,
                                      std::uint64_t sequence = 0) {
  aquafarm_msgs::Step::Request request;
  request.actions = actions;
  request.observation_types = observation_types;
  request.sequence = sequence;
  return ranch.Step(request);
}

/// Takes joint steps with random actions. Returns the hashes of all farms after each step.
std::vector<std::uint64_t> Play(FarmServer& ranch, std::size_t actions, int steps,
                                std::uint64_t seed) {
  aquafarm::RandomStream random({seed, 0, aquafarm::RngStream::kExploration, 0});
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < steps; ++i) {
    std::vector<std::uint8_t> joint(actions);
    for (std::uint8_t& action : joint) action = static_cast<std::uint8_t>(random.Below(10));
    const auto answer = StepAll(ranch, joint, StepResult::HASHES);
    EXPECT_TRUE(answer.ok) << answer.message;
    hashes.insert(hashes.end(), answer.result.hashes.begin(), answer.result.hashes.end());
  }
  return hashes;
}

TEST(FarmServerServices, AJointStepEqualsTheBatchInProcess) {
  const aquafarm::Scenario scenario = aquafarm::test::CrowdedScenario(2);
  const auto ranch = MakeRanch(scenario, 5);
  aquafarm::FarmBatch batch(std::make_shared<const aquafarm::Scenario>(scenario), 5);
  batch.Reset(5, 0, {});
  const std::size_t entries = 5 * static_cast<std::size_t>(scenario.AgentCount());
  aquafarm::RandomStream random({1, 0, aquafarm::RngStream::kExploration, 0});
  const auto features = static_cast<std::size_t>(batch.encoder().feature_count());
  std::vector<float> rewards(entries);
  std::vector<float> vectors(entries * features);
  std::vector<std::uint8_t> planes(entries * batch.encoder().planes_size());
  std::vector<std::uint64_t> hashes(5);
  aquafarm::BatchOutput output;
  output.rewards = rewards.data();
  output.features = vectors.data();
  output.planes = planes.data();
  output.hashes = hashes.data();
  for (int i = 0; i < 300; ++i) {
    std::vector<std::uint8_t> joint(entries);
    for (std::uint8_t& action : joint) action = static_cast<std::uint8_t>(random.Below(10));
    const auto answer =
        StepAll(*ranch, joint, StepResult::HASHES | StepResult::FEATURES | StepResult::PLANES);
    batch.Step(joint.data(), output);
    ASSERT_EQ(hashes, answer.result.hashes);
    ASSERT_EQ(rewards, answer.result.rewards);
    ASSERT_EQ(vectors, answer.result.features);
    ASSERT_EQ(planes, answer.result.planes);
  }
}

TEST(FarmServerServices, ArraysHaveTheStatedLengths) {
  const auto ranch = MakeRanch(TwoShips(), 3);
  const auto bare = StepAll(*ranch, std::vector<std::uint8_t>(6, kHold)).result;
  EXPECT_EQ(3, bare.farms);
  EXPECT_EQ(2, bare.agents);
  EXPECT_EQ(6U, bare.rewards.size());
  EXPECT_EQ(6U, bare.legal.size());
  EXPECT_EQ(3U, bare.terminated.size());
  EXPECT_TRUE(bare.terms.empty() && bare.index.empty() && bare.planes.empty());
  const auto full = StepAll(*ranch, std::vector<std::uint8_t>(6, kHold), 31).result;
  EXPECT_EQ(48U, full.terms.size());
  EXPECT_EQ(6U, full.energy.size());
  EXPECT_EQ(6U, full.distance.size());
  EXPECT_EQ(6U, full.index.size());
  EXPECT_EQ(3U, full.hashes.size());
}

TEST(FarmServerServices, RepeatingTheLastSequenceStepsNothing) {
  const auto ranch = MakeRanch(TwoShips(), 2);
  const auto first = StepAll(*ranch, {0, 1, 2, 3}, StepResult::HASHES, 41);
  const auto refused = StepAll(*ranch, {0}, StepResult::HASHES, 42);
  EXPECT_FALSE(refused.ok);
  EXPECT_EQ(first, StepAll(*ranch, {0, 1, 2, 3}, StepResult::HASHES, 41));
  EXPECT_EQ(1U, StateOf(*ranch).step);
}

TEST(FarmServerServices, TheNumbersOfAnotherClientAreNoRepeats) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  aquafarm_msgs::Step::Request step;
  step.actions = {kNorth};
  step.sequence = 1;
  EXPECT_EQ(1U, (ranch->Step(step, "/one"), StateOf(*ranch).step));
  EXPECT_EQ(2U, (ranch->Step(step, "/two"), StateOf(*ranch).step));
  EXPECT_EQ(2U, (ranch->Step(step, "/two"), StateOf(*ranch).step));
  aquafarm_msgs::Reset reset;
  reset.request.sequence = 1;
  for (const char* caller : {"/one", "/two", "/two"}) {
    ranch->Reset(reset.request, reset.response, caller);
    EXPECT_TRUE(reset.response.ok);
  }
  EXPECT_EQ(2U, StateOf(*ranch).episode);
}

TEST(FarmServerServices, AStepForFarmsThatAnotherHasMovedIsStale) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  aquafarm_msgs::Step::Request mine;
  mine.actions = {kNorth};
  mine.state_id = ResetTo(*ranch, 3).result.state_id;
  mine.state_id = ranch->Step(mine).result.state_id;
  aquafarm_msgs::SaveState saved;
  ranch->SaveState(saved.response);
  mine.state_id = ranch->Step(mine).result.state_id;
  ASSERT_EQ(2U, StateOf(*ranch).step) << "its own steps are no others'";
  const std::vector<std::function<void()>> others{
      [&] {
        ranch->Command({0, kNorth, 0, 0, 1});
      },
      [&] { StepAll(*ranch, {kNorth}); },
      [&] { ResetTo(*ranch, 3); },
      [&] {
        aquafarm_msgs::LoadState load;
        load.request.data = saved.response.data;
        ranch->LoadState(load.request, load.response);
        EXPECT_TRUE(load.response.ok);
      },
  };
  for (std::size_t i = 0; i < others.size(); ++i) {
    others[i]();
    const std::uint64_t hash = StateOf(*ranch).hash;
    const auto stale = ranch->Step(mine);
    EXPECT_EQ(Outcome::STALE, stale.code) << i;
    EXPECT_NE(std::string::npos, stale.message.find("another client has stepped or reset them"))
        << i;
    EXPECT_EQ(hash, StateOf(*ranch).hash) << i;
    mine.state_id = StepAll(*ranch, {kHold}).result.state_id;
  }
}

TEST(FarmServerServices, PausesAndBulletinsMakeNoStepStale) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  aquafarm_msgs::Step::Request mine;
  mine.actions = {kNorth};
  mine.state_id = ResetTo(*ranch, 3).result.state_id;
  for (const bool paused : {true, false}) {
    aquafarm_msgs::Pause pause;
    pause.request.paused = paused;
    ranch->Pause(pause.request, pause.response);
  }
  aquafarm_msgs::SetDisaster bulletin;
  bulletin.request.info.grade = 3;
  bulletin.request.info.radii = {1.0F};
  bulletin.request.info.risks = {-20.0F};
  bulletin.request.info.duration = 50;
  bulletin.request.info.has_start = true;
  ranch->SetDisaster(bulletin.request, bulletin.response);
  ASSERT_TRUE(bulletin.response.ok) << bulletin.response.message;
  EXPECT_TRUE(ranch->Step(mine).ok);
}

TEST(FarmServerServices, AJointStepIsRefusedWhileAnotherHoldsAShip) {
  const auto ranch = MakeRanch(TwoShips(), 2);
  aquafarm_msgs::Claim::Response claim;
  ranch->Claim(1, "/agent", false, claim);
  aquafarm_msgs::Step::Request step;
  step.actions = {kNorth, kNorth, kNorth, kNorth};
  const auto refused = ranch->Step(step, "/trainer");
  EXPECT_EQ(Outcome::CLAIMED, refused.code);
  EXPECT_EQ("ship 1 is held by /agent", refused.message);
  EXPECT_EQ(0U, StateOf(*ranch).step);
  EXPECT_TRUE(ranch->Step(step, "/agent").ok) << "of the holder itself";
  ranch->Claim(1, "/agent", true, claim);
  EXPECT_TRUE(ranch->Step(step, "/trainer").ok);
}

// A waiting learner gets STALE only once, when it may continue.

TEST(FarmServerServices, AJointStepReportsAClaimBeforeItIsStale) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  aquafarm_msgs::Step::Request mine;
  mine.actions = {kNorth};
  mine.state_id = ResetTo(*ranch, 3).result.state_id;
  const auto set_pace = [&](const char* pace) {
    aquafarm_msgs::SetPace call;
    call.request.pace = pace;
    ranch->SetPace(call.request, call.response);
  };
  set_pace("paced");
  ranch->Tick();
  EXPECT_EQ(Outcome::WRONG_PACE, ranch->Step(mine).code);
  set_pace("lockstep");
  EXPECT_EQ(Outcome::STALE, ranch->Step(mine).code);
  mine.state_id = ResetTo(*ranch, 3).result.state_id;
  aquafarm_msgs::Claim::Response claim;
  ranch->Claim(0, "/agent", false, claim);
  aquafarm_msgs::Step::Request theirs;
  theirs.actions = {kNorth};
  EXPECT_TRUE(ranch->Step(theirs, "/agent").ok);
  EXPECT_EQ(Outcome::CLAIMED, ranch->Step(mine, "/trainer").code);
  ranch->Claim(0, "/agent", true, claim);
  EXPECT_EQ(Outcome::STALE, ranch->Step(mine, "/trainer").code);
}

TEST(FarmServerServices, EveryRefusalIsCounted) {
  const auto ranch = MakeRanch(TwoShips());
  const auto refuse = [&](auto service, auto handler) {
    const std::uint64_t before = ranch->counters().refused;
    handler(service.request, service.response);
    EXPECT_FALSE(service.response.ok);
    EXPECT_EQ(before + 1, ranch->counters().refused);
  };
  refuse(aquafarm_msgs::Step(), [&](auto& q, auto& a) { a = ranch->Step(q); });
  refuse(aquafarm_msgs::Reset(), [&](auto& q, auto& a) { q.farms = -1, ranch->Reset(q, a); });
  refuse(aquafarm_msgs::GetState(), [&](auto& q, auto& a) { q.farm = 9, ranch->GetState(q, a); });
  refuse(aquafarm_msgs::LoadState(), [&](auto& q, auto& a) { ranch->LoadState(q, a); });
  refuse(aquafarm_msgs::SetPace(), [&](auto& q, auto& a) { q.pace = "x", ranch->SetPace(q, a); });
  refuse(aquafarm_msgs::SetDisaster(), [&](auto& q, auto& a) { ranch->SetDisaster(q, a); });
}

TEST(FarmServerServices, JointStepsOutOfRangeAreRefused) {
  const auto ranch = MakeRanch(TwoShips(), 2);
  const std::uint64_t hash = StateOf(*ranch).hash;
  const auto shorter = StepAll(*ranch, {0, 1, 2});
  EXPECT_EQ(Outcome::BAD_LENGTH, shorter.code);
  EXPECT_EQ("actions: got 3 entries, expected 4 (2 farms x 2 agents)", shorter.message);
  EXPECT_EQ(Outcome::BAD_LENGTH, StepAll(*ranch, {}).code);
  EXPECT_EQ(Outcome::BAD_LENGTH, StepAll(*ranch, std::vector<std::uint8_t>(1000000)).code);
  EXPECT_EQ(Outcome::BAD_ACTION, StepAll(*ranch, {0, 1, 2, 250}).code);
  EXPECT_EQ(Outcome::BAD_VALUE, StepAll(*ranch, {0, 1, 2, 3}, 255).code);
  EXPECT_EQ(hash, StateOf(*ranch).hash);
}

TEST(FarmServerServices, JointStepsNeedLockstep) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario(), 1, true);
  EXPECT_EQ(Outcome::WRONG_PACE, StepAll(*ranch, {0}).code);
}

TEST(FarmServerServices, FinishedEpisodesComeWithTheStepThatEndsThem) {
  aquafarm::Scenario scenario = aquafarm::test::TinyScenario();
  scenario.step_limit = 2;
  const auto ranch = MakeRanch(scenario, 2);
  EXPECT_TRUE(StepAll(*ranch, {kNorth, kSouth}).result.finished.empty());
  const auto last = StepAll(*ranch, {kNorth, kSouth}).result;
  ASSERT_EQ(2U, last.finished.size());
  EXPECT_EQ(1, last.finished[1].farm);
  EXPECT_EQ(1U, last.finished[1].episode);
  EXPECT_EQ(2, last.finished[1].steps);
  EXPECT_EQ(1, last.truncated[1]);
  const auto next = StepAll(*ranch, {kNorth, kSouth}).result;
  EXPECT_TRUE(next.finished.empty());
  EXPECT_EQ(1, next.is_first[0]);
  EXPECT_EQ(2U, StateOf(*ranch, 0).episode);
  EXPECT_EQ(3U, StateOf(*ranch, 1).episode);
}

TEST(FarmServerServices, ASeedReproducesAndWithoutOneTheSequenceContinues) {
  const auto ranch = MakeRanch(aquafarm::test::CrowdedScenario(2), 2);
  const std::size_t actions = 2 * static_cast<std::size_t>(ranch->agents());
  const auto first = ResetTo(*ranch, 11);
  EXPECT_EQ(0U, first.episode);
  const auto played = Play(*ranch, actions, 100, 1);
  aquafarm_msgs::Reset next;
  ranch->Reset(next.request, next.response);
  EXPECT_EQ(11U, next.response.seed);
  EXPECT_EQ(2U, next.response.episode);
  const auto second = Play(*ranch, actions, 100, 1);
  ResetTo(*ranch, 11);
  EXPECT_EQ(played, Play(*ranch, actions, 100, 1));
  ranch->Reset(next.request, next.response);
  EXPECT_EQ(second, Play(*ranch, actions, 100, 1));
}

TEST(FarmServerServices, ResetChangesTheNumberOfFarmsAndStartsWhereAsked) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  aquafarm_msgs::Reset call;
  call.request.farms = 3;
  call.request.has_episode = true;
  call.request.episode = 100;
  call.request.observation_types = StepResult::INDEX;
  call.request.with_spec = true;
  ranch->Reset(call.request, call.response);
  EXPECT_TRUE(call.response.ok) << call.response.message;
  EXPECT_EQ(3, call.response.spec.farms);
  EXPECT_EQ(std::vector<std::uint8_t>(3, 1), call.response.result.is_first);
  EXPECT_EQ(3U, call.response.result.index.size());
  EXPECT_EQ(102U, StateOf(*ranch, 2).episode);
}

TEST(FarmServerServices, ResetOutOfRangeChangesNothing) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  const std::uint64_t hash = StateOf(*ranch).hash;
  for (const std::int32_t farms : {-1, kMaxFarms + 1, std::numeric_limits<std::int32_t>::max()}) {
    aquafarm_msgs::Reset call;
    call.request.farms = farms;
    ranch->Reset(call.request, call.response);
    EXPECT_EQ(Outcome::BAD_VALUE, call.response.code);
  }
  EXPECT_EQ(hash, StateOf(*ranch).hash);
}

TEST(FarmServerServices, TooManyNewLayoutsAreRefusedAtTheStartAndByReset) {
  aquafarm::Scenario scenario = aquafarm::test::TinyScenario();
  scenario.layout = aquafarm::LayoutMode::kPerEpisode;
  scenario.width = scenario.height = 128;
  const std::string refusal =
      "farms: 4096 layouts would have 67108864 cells and routes, expected at most 64000000; use "
      "fewer farms";
  try {
    MakeRanch(scenario, kMaxFarms);
    ADD_FAILURE() << "they were accepted";
  } catch (const aquafarm::InputError& error) {
    EXPECT_EQ(refusal, error.what());
  }
  aquafarm_msgs::Reset call;
  call.request.farms = kMaxFarms;
  MakeRanch(scenario)->Reset(call.request, call.response);
  EXPECT_EQ(refusal, call.response.message);
}

TEST(FarmServerServices, FarmsOfSeveralNodesPlayEpisodesAStrideApart) {
  aquafarm::Scenario scenario = aquafarm::test::TinyScenario();
  scenario.step_limit = 1;
  const auto ranch = MakeRanch(scenario);
  aquafarm_msgs::Reset call;
  call.request.farms = 2;
  call.request.has_episode = true;
  call.request.episode = 6;
  call.request.stride = 1;
  ranch->Reset(call.request, call.response);
  EXPECT_EQ(Outcome::BAD_VALUE, call.response.code);
  EXPECT_EQ("stride: got 1, expected 0 or at least 2, the number of farms", call.response.message);
  EXPECT_EQ(0U, StateOf(*ranch).episode);
  for (const std::uint32_t stride : {8U, 0U}) {  // 0: the number of farms
    call.request.stride = stride;
    ranch->Reset(call.request, call.response);
    ASSERT_TRUE(call.response.ok) << call.response.message;
    EXPECT_EQ(6U, StateOf(*ranch).episode);
    StepAll(*ranch, {kNorth, kNorth});
    StepAll(*ranch, {kNorth, kNorth});  // starts the next episodes
    EXPECT_EQ(stride == 0 ? 8U : 14U, StateOf(*ranch).episode);
  }
}

TEST(FarmServerServices, RepeatingAResetBeginsNoFurtherEpisode) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  aquafarm_msgs::Reset call;
  call.request.sequence = 9;
  ranch->Reset(call.request, call.response);
  aquafarm_msgs::Reset again;
  again.request.sequence = 9;
  ranch->Reset(again.request, again.response);
  EXPECT_EQ(call.response, again.response);
  EXPECT_EQ(1U, StateOf(*ranch).episode);
}

TEST(FarmServerServices, AResetOnlyIfOverLeavesAnEpisodeInProgressAlone) {
  aquafarm::Scenario scenario = aquafarm::test::TinyScenario();
  scenario.step_limit = 2;
  const auto ranch = MakeRanch(scenario);
  const auto reset = [&] {
    aquafarm_msgs::Reset call;
    call.request.only_if_over = true;
    ranch->Reset(call.request, call.response);
    EXPECT_TRUE(call.response.ok) << call.response.message;
    return call.response;
  };
  const std::uint64_t state_id = StepAll(*ranch, {kNorth}).result.state_id;
  EXPECT_EQ(state_id, reset().result.state_id);
  EXPECT_EQ(0U, reset().episode);
  EXPECT_EQ(1U, StateOf(*ranch).step);
  StepAll(*ranch, {kNorth});
  EXPECT_EQ(1U, reset().episode);
  EXPECT_EQ(1U, reset().episode) << "asked for by another";
  EXPECT_EQ(0U, StateOf(*ranch).step);
}

TEST(FarmServerServices, AfterALoadANumberedResetIsDoneAgain) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  aquafarm_msgs::SaveState save;
  ranch->SaveState(save.response);
  aquafarm_msgs::Reset reset;
  reset.request.sequence = 9;
  ranch->Reset(reset.request, reset.response);
  aquafarm_msgs::LoadState load;
  load.request.data = save.response.data;
  ranch->LoadState(load.request, load.response);
  ASSERT_EQ(0U, StateOf(*ranch).episode);
  ranch->Reset(reset.request, reset.response);
  EXPECT_EQ(1U, StateOf(*ranch).episode);
}

TEST(FarmServerServices, LoadResumesBitForBit) {
  const auto ranch = MakeRanch(aquafarm::test::CrowdedScenario(2), 3);
  const std::size_t actions = 3 * static_cast<std::size_t>(ranch->agents());
  Play(*ranch, actions, 40, 1);
  aquafarm_msgs::SaveState save;
  ranch->SaveState(save.response);
  ASSERT_TRUE(save.response.ok);
  const auto expected = Play(*ranch, actions, 150, 2);
  aquafarm_msgs::LoadState load;
  load.request.data = save.response.data;
  ranch->LoadState(load.request, load.response);
  ASSERT_TRUE(load.response.ok) << load.response.message;
  EXPECT_EQ(save.response.hash, load.response.hash);
  EXPECT_EQ(expected, Play(*ranch, actions, 150, 2));
}

TEST(FarmServerServices, DamagedBytesChangeNothing) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario(), 2);
  aquafarm_msgs::SaveState save;
  ranch->SaveState(save.response);
  StepAll(*ranch, {kNorth, kNorth});
  const std::uint64_t hash = StateOf(*ranch).hash;
  for (std::size_t cut : {std::size_t{0}, std::size_t{1}, save.response.data.size() / 2}) {
    aquafarm_msgs::LoadState load;
    load.request.data.assign(save.response.data.begin(),
                             save.response.data.begin() + static_cast<std::ptrdiff_t>(cut));
    ranch->LoadState(load.request, load.response);
    EXPECT_EQ(Outcome::BAD_DATA, load.response.code) << load.response.message;
  }
  aquafarm_msgs::LoadState load;
  load.request.data = save.response.data;
  load.request.data[load.request.data.size() / 2] ^= 0x10;
  ranch->LoadState(load.request, load.response);
  EXPECT_EQ(Outcome::BAD_DATA, load.response.code) << load.response.message;
  EXPECT_EQ(hash, StateOf(*ranch).hash);
}

TEST(FarmServerServices, PaceAndRateOutOfRangeAreRefused) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario());
  for (const double rate_hz : {-1.0, 1e9, std::nan("")}) {
    aquafarm_msgs::SetPace call;
    call.request.rate_hz = rate_hz;
    ranch->SetPace(call.request, call.response);
    EXPECT_EQ(Outcome::BAD_VALUE, call.response.code);
    EXPECT_DOUBLE_EQ(10.0, call.response.rate_hz);
  }
  aquafarm_msgs::SetPace call;
  call.request.pace = "warp";
  ranch->SetPace(call.request, call.response);
  EXPECT_EQ("pace: got 'warp', expected lockstep or paced", call.response.message);
  call.request.pace = "paced";
  call.request.rate_hz = 2.0;
  ranch->SetPace(call.request, call.response);
  EXPECT_TRUE(call.response.ok);
  EXPECT_EQ(aquafarm_msgs::FarmState::PACED, StateOf(*ranch).pace);
}

TEST(FarmServerServices, UnknownFarmsAndShipsAreNotRead) {
  const auto ranch = MakeRanch(TwoShips(), 2);
  aquafarm_msgs::GetState call;
  call.request.farm = 2;
  ranch->GetState(call.request, call.response);
  EXPECT_EQ(Outcome::UNKNOWN_FARM, call.response.code);
  call.request.farm = 1;
  call.request.observation = true;
  call.request.ship = 2;
  ranch->GetState(call.request, call.response);
  EXPECT_EQ(Outcome::UNKNOWN_SHIP, call.response.code);
  call.request.ship = 1;
  ranch->GetState(call.request, call.response);
  EXPECT_TRUE(call.response.ok);
  EXPECT_EQ(1, call.response.state.observer);
}

TEST(FarmServerServices, AnIndexThatTheFarmHasNotIsRefused) {
  aquafarm::Scenario scenario = aquafarm::test::TinyScenario();
  scenario.width = scenario.height = 12;
  scenario.devices = {};
  scenario.devices.count = 20;
  const auto ranch = MakeRanch(scenario);
  aquafarm_msgs::Reset call;
  call.request.observation_types = StepResult::INDEX;
  ranch->Reset(call.request, call.response);
  EXPECT_FALSE(call.response.ok);
  EXPECT_EQ(call.response.code, Outcome::BAD_VALUE);
  call.request.observation_types = StepResult::FEATURES;
  ranch->Reset(call.request, call.response);
  EXPECT_TRUE(call.response.ok) << call.response.message;
}

}  // namespace
}  // namespace aquafarm_sim
