// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/farm_batch.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <numeric>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/validate.h"
#include "count_allocations.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

using test::CrowdedScenario;

// Buffers for all outputs of a batch.
struct Buffers {
  explicit Buffers(const FarmBatch& batch) {
    const auto n = static_cast<std::size_t>(batch.farms());
    const auto k = n * static_cast<std::size_t>(batch.agents());
    rewards.resize(k);
    terms.resize(k * kRewardTermCount);
    energy.resize(k);
    distance.resize(k);
    outcomes.resize(k);
    legal.resize(k);
    active.resize(k);
    end_reasons.resize(n);
    is_first.resize(n);
    hashes.resize(n);
    index.resize(k);
    features.resize(k * static_cast<std::size_t>(batch.encoder().feature_count()));
    planes.resize(k * batch.encoder().planes_size());
  }
  BatchOutput View() {
    return {rewards.data(), terms.data(),    energy.data(),      distance.data(), outcomes.data(),
            legal.data(),   active.data(),   end_reasons.data(), is_first.data(), hashes.data(),
            index.data(),   features.data(), planes.data()};
  }
  std::vector<float> rewards, terms, energy, distance, features;
  std::vector<std::uint8_t> outcomes, active, end_reasons, is_first, planes;
  std::vector<ActionMask> legal;
  std::vector<std::uint64_t> hashes;
  std::vector<std::uint32_t> index;
};

std::shared_ptr<const Scenario> Shared(Scenario scenario) {
  ValidateScenario(scenario);
  return std::make_shared<const Scenario>(std::move(scenario));
}

// Returns the n-th joint action of a test; depends only on n.
std::vector<std::uint8_t> Actions(const FarmBatch& batch, std::uint64_t number) {
  std::vector<std::uint8_t> actions(static_cast<std::size_t>(batch.farms() * batch.agents()));
  RandomStream rng({99, number, RngStream::kExploration, 0});
  for (std::uint8_t& action : actions) {
    action = static_cast<std::uint8_t>(rng.Below(kActionCount));
  }
  return actions;
}

TEST(FarmBatch, EveryFarmIsThatFarmAlone) {
  const auto scenario = Shared(CrowdedScenario(2));
  FarmBatch batch(scenario, 5);
  Buffers buffers(batch);
  batch.Reset(3, 0, buffers.View());
  std::vector<Farm> alone;
  for (std::uint64_t i = 0; i < 5; ++i) {
    alone.emplace_back(scenario);
    alone.back().Reset(3, i);
  }
  for (std::uint64_t step = 0; step < 700; ++step) {
    const auto actions = Actions(batch, step);
    batch.Step(actions.data(), buffers.View());
    for (std::size_t i = 0; i < 5; ++i) {
      Farm& farm = alone[i];
      const bool starts = farm.over();
      if (starts) {
        farm.Reset(3, farm.episode() + 5);
      } else {
        farm.Step(actions.data() + i * 3);
      }
      ASSERT_EQ(buffers.hashes[i], farm.Hash()) << "farm " << i << " step " << step;
      ASSERT_EQ(buffers.is_first[i] != 0, starts);
      ASSERT_EQ(buffers.end_reasons[i], static_cast<std::uint8_t>(farm.reason()));
      for (std::size_t ship = 0; ship < 3; ++ship) {
        ASSERT_EQ(buffers.rewards[i * 3 + ship], farm.ships()[ship].reward);
        ASSERT_EQ(buffers.legal[i * 3 + ship], farm.LegalActions(static_cast<std::int32_t>(ship)));
      }
    }
  }
}

TEST(FarmBatch, FarmsWithoutDisastersStepNextToEachOther) {
  Scenario scenario = CrowdedScenario(2);
  scenario.disasters.clear();
  const auto shared = Shared(std::move(scenario));
  FarmBatch batch(shared, 3);
  Buffers buffers(batch);
  batch.Reset(3, 0, buffers.View());
  Farm last(shared);
  last.Reset(3, 2);
  for (std::uint64_t step = 0; step < 20; ++step) {
    const auto actions = Actions(batch, step);
    batch.Step(actions.data(), buffers.View());
    last.Step(actions.data() + std::ptrdiff_t{2} * batch.agents());
    ASSERT_EQ(buffers.hashes[2], last.Hash()) << step;
  }
}

TEST(FarmBatch, TwoBatchesShareTheEpisodesOfOne) {
  const auto scenario = Shared(CrowdedScenario(2));
  FarmBatch all(scenario, 5);
  FarmBatch first(scenario, 3);
  FarmBatch last(scenario, 2);
  Buffers whole(all);
  Buffers a(first);
  Buffers b(last);
  all.Reset(3, 7, whole.View());
  first.Reset(3, 7, a.View(), 5);
  last.Reset(3, 10, b.View(), 5);
  int is_first = 0;
  for (std::uint64_t step = 0; step < 700; ++step) {
    const auto actions = Actions(all, step);
    all.Step(actions.data(), whole.View());
    first.Step(actions.data(), a.View());
    last.Step(actions.data() + std::ptrdiff_t{3} * all.agents(), b.View());
    std::vector<std::uint64_t> hashes = a.hashes;
    hashes.insert(hashes.end(), b.hashes.begin(), b.hashes.end());
    ASSERT_EQ(hashes, whole.hashes) << "step " << step;
    for (const std::uint8_t one : whole.is_first) is_first += one;
  }
  EXPECT_GT(is_first, 5);  // also later episodes than the first ones
}

TEST(FarmBatch, ThreadsChangeNothing) {
  const auto scenario = Shared(CrowdedScenario(2));
  FarmBatch one(scenario, 16, 1);
  FarmBatch four(scenario, 16, 4);
  Buffers a(one);
  Buffers b(four);
  one.Reset(1, 0, a.View());
  four.Reset(1, 0, b.View());
  for (std::uint64_t step = 0; step < 400; ++step) {
    const auto actions = Actions(one, step);
    one.Step(actions.data(), a.View());
    four.Step(actions.data(), b.View());
    ASSERT_EQ(a.hashes, b.hashes);
    ASSERT_EQ(a.features, b.features);
    ASSERT_EQ(a.planes, b.planes);
  }
}

TEST(FarmBatch, SaveAndLoadContinueBitIdentically) {
  const auto scenario = Shared(CrowdedScenario(1));
  FarmBatch batch(scenario, 4);
  Buffers buffers(batch);
  batch.Reset(8, 0, buffers.View());
  for (std::uint64_t step = 0; step < 130; ++step) {
    batch.Step(Actions(batch, step).data(), buffers.View());
  }
  const std::string bytes = batch.Save();
  FarmBatch other(scenario, 4);
  Buffers again(other);
  other.Load(bytes);
  other.Write(again.View());
  EXPECT_EQ(again.hashes, buffers.hashes);
  EXPECT_EQ(again.features, buffers.features);
  for (std::uint64_t step = 130; step < 400; ++step) {
    batch.Step(Actions(batch, step).data(), buffers.View());
    other.Step(Actions(batch, step).data(), again.View());
    ASSERT_EQ(again.hashes, buffers.hashes);
  }
  FarmBatch fewer(scenario, 3);
  EXPECT_THROW(fewer.Load(bytes), InputError);
}

void ExpectNoAllocation(Scenario scenario) {
  FarmBatch batch(Shared(std::move(scenario)), 3);
  Buffers buffers(batch);
  const BatchOutput output = buffers.View();
  batch.Reset(1, 0, output);
  std::vector<std::vector<std::uint8_t>> actions;
  for (std::uint64_t i = 0; i < 64; ++i) actions.push_back(Actions(batch, i));
  // The first episodes allocate the reusable memory.
  for (std::size_t i = 0; i < 1000; ++i) batch.Step(actions[i % 64].data(), output);
  const long before = allocations;
  int episodes = 0;
  for (std::size_t i = 0; i < 5000; ++i) {
    batch.Step(actions[i % 64].data(), output);
    episodes += std::accumulate(buffers.is_first.begin(), buffers.is_first.end(), 0);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(episodes, 50);
}

TEST(FarmBatch, NeitherStepsNorEpisodesAllocate) {
  ExpectNoAllocation(CrowdedScenario(2));
  Scenario charted = CrowdedScenario(2);
  charted.view.routes = charted.view.lookahead_risk = true;
  ExpectNoAllocation(charted);
  charted.view.mode = ViewMode::kPartial;
  ExpectNoAllocation(charted);
  charted.view.disaster_slots = 2;
  charted.view.forecast_leads_h = {6.0F, 24.0F};
  ExpectNoAllocation(charted);
  Scenario fixed = CrowdedScenario(1, 0);
  fixed.layout = LayoutMode::kFixed;
  ExpectNoAllocation(fixed);
}

TEST(FarmBatch, AFarmsStateIsUnder1280BytesWithoutItsChart) {
  Scenario scenario;  // sizes of the paper; all farms share one chart
  scenario.disasters.resize(1);
  ValidateScenario(scenario);
  const auto shared = std::make_shared<const Scenario>(scenario);
  const auto bytes_of = [&shared](std::int32_t farms) {
    const std::size_t before = allocated_bytes;
    FarmBatch batch(shared, farms);
    batch.Reset(1, 0, {});
    return allocated_bytes - before;
  };
  const std::size_t of_one = bytes_of(1);
  EXPECT_LT((bytes_of(101) - of_one) / 100, 1280U);
}

TEST(FarmBatch, SaysWhichAgentsAreDoneUntilTheirNextEpisode) {
  Scenario scenario = test::TinyScenario();
  scenario.devices.sites.push_back({{2, 1}, DeviceKind::kBreedingRelease, 90.0F, true});
  scenario.step_limit = 4;
  FarmBatch batch(Shared(scenario), 1);
  Buffers buffers(batch);
  batch.Reset(1, 0, buffers.View());
  EXPECT_EQ(buffers.active, (std::vector<std::uint8_t>{1, 1}));
  const auto step = [&](Action device) {
    const std::uint8_t actions[] = {test::Act(Action::kHold), test::Act(device)};
    batch.Step(actions, buffers.View());
  };
  step(Action::kSouth);
  EXPECT_EQ(buffers.active, (std::vector<std::uint8_t>{1, 1}));
  step(Action::kDropOff);
  EXPECT_EQ(buffers.active, (std::vector<std::uint8_t>{1, 0}));
  EXPECT_EQ(buffers.rewards[1], 110.0F);
  step(Action::kNorth);
  EXPECT_EQ(buffers.active, (std::vector<std::uint8_t>{1, 0}));
  step(Action::kNorth);
  EXPECT_EQ(buffers.end_reasons[0], static_cast<std::uint8_t>(EndReason::kStepLimit));
  step(Action::kNorth);
  EXPECT_EQ(buffers.is_first[0], 1);
  EXPECT_EQ(buffers.active, (std::vector<std::uint8_t>{1, 1}));
}

TEST(FarmBatch, StartsOneFarmAndKeepsItsStride) {
  const auto scenario = Shared(CrowdedScenario(2));
  FarmBatch batch(scenario, 3);
  Buffers buffers(batch);
  batch.Reset(3, 0, buffers.View());
  const std::vector<std::uint64_t> before = buffers.hashes;
  batch.Start(1, 8, 40, 1, buffers.View());
  Farm alone(scenario);
  alone.Reset(8, 40);
  EXPECT_EQ(buffers.hashes, (std::vector<std::uint64_t>{before[0], alone.Hash(), before[2]}));
  batch.StartNext(1, buffers.View());
  batch.StartNext(2, buffers.View());
  EXPECT_EQ(batch.farm(1).episode(), 41U);
  EXPECT_EQ(batch.farm(2).episode(), 5U);
  alone.Reset(8, 41);
  EXPECT_EQ(buffers.hashes[1], alone.Hash());
  batch.Reset(3, 0, buffers.View());
  batch.StartNext(1, buffers.View());
  EXPECT_EQ(batch.farm(1).episode(), 4U);
}

TEST(FarmBatch, AForkedProcessStepsOnAfterItsParentUsedThreads) {
  const auto scenario = Shared(CrowdedScenario(2));
  FarmBatch batch(scenario, 8, 2);
  Buffers buffers(batch);
  batch.Reset(1, 0, buffers.View());
  batch.Step(Actions(batch, 0).data(), buffers.View());
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    alarm(20);  // ends a child that waits for threads it does not have
    batch.Step(Actions(batch, 1).data(), buffers.View());
    _exit(batch.farm(0).step() == 2 ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace aquafarm
