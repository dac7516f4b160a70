// SPDX-License-Identifier: BSD-3-Clause
#include "networks/sequence_batch.h"

#include <set>

#include "agents_fixture.h"

namespace aquafarm::agents::test {
namespace {

constexpr std::size_t kMoments = 40;
constexpr std::size_t kSequence = 5;
constexpr std::size_t kBurnIn = 3;
constexpr float kOver = 100.0F;  // reward of an episode's last step

DeepOptions Options(std::int32_t n_step) {
  DeepOptions options;
  options.batch_size = 1;
  options.sequence_length = kSequence;
  options.burn_in = kBurnIn;
  options.n_step = n_step;
  options.gamma = 1.0;
  options.reward_scale = 1.0;
  options.mask_blocked = false;
  return options;
}

// One farm with observation {time step, episode} and recurrent state {time step}. Episodes have one
// to nine steps. Every fourth episode ends because the farm is lost.
void FillReplay(Replay<float>& replay, int moments) {
  StepResults results;
  results.legal = {kAllActions};
  results.active = {1};
  int moment = 0;
  for (int episode = 0; moment < moments; ++episode) {
    const int steps = 1 + (episode * 4) % 9;
    const bool is_lost = episode % 4 == 3;
    for (int step = 0; step <= steps && moment < moments; ++step, ++moment) {
      const bool is_over = step == steps && !is_lost;
      results.is_first = {step == 0 ? std::uint8_t{1} : std::uint8_t{0}};
      results.end_reasons = {
          static_cast<std::uint8_t>(is_over ? EndReason::kAllRetrieved : EndReason::kNone)};
      results.rewards = {is_over ? kOver : 1.0F};
      const std::vector<float> seen{static_cast<float>(moment), static_cast<float>(episode)};
      const std::vector<float> recurrent_state{step == 0 ? 0.0F : static_cast<float>(moment)};
      replay.Add(results, seen.data(), recurrent_state.data());
      replay.SetActions({static_cast<std::uint8_t>(moment % 10)});
    }
  }
}

TEST(SequenceBatch, NeverCrossesAnEpisode) {
  Replay<float> replay({kMoments, 1, 1, 2, 1});
  FillReplay(replay, 3 * kMoments);  // most time steps are overwritten
  for (const int n_step : {1, 3}) {
    const DeepOptions options = Options(n_step);
    SequenceBatch batch(options, 2, 1);
    int cold = 0;
    int warm = 0;
    for (std::size_t age = 0; age < replay.size(); ++age) {
      if (!replay.Begins(age, 0, 1)) continue;
      SCOPED_TRACE("moment " + std::to_string(age) + ", n_step " + std::to_string(n_step));
      batch.Fill(0, replay, {age, 0}, options);
      const float episode = replay.observation(replay.Row(age, 0))[1];
      const float first = batch.observations[0];
      bool is_drawn_learnt = false;
      std::size_t learnt = 0;
      for (std::size_t t = 0; t < kSequence && batch.weights[t] > 0.0F; ++t, ++learnt) {
        const float* seen = batch.observations.data() + 2 * t;
        EXPECT_EQ(seen[0], first + static_cast<float>(t));
        EXPECT_EQ(seen[1], episode);
        EXPECT_EQ(batch.actions[t], static_cast<std::int64_t>(seen[0]) % 10);
        is_drawn_learnt = is_drawn_learnt || batch.rows[t] == replay.Row(age, 0);
        const auto next = static_cast<std::size_t>(batch.next[t]);
        EXPECT_GT(next, t);
        EXPECT_LE(next, t + static_cast<std::size_t>(n_step));
        EXPECT_EQ(batch.observations[2 * next + 1], episode) << "a target from elsewhere";
        const bool ends = batch.rewards[t] >= kOver;
        EXPECT_EQ(batch.discounts[t], ends ? 0.0F : 1.0F);
        EXPECT_FLOAT_EQ(batch.rewards[t], static_cast<float>(next - t) + (ends ? kOver - 1 : 0));
      }
      EXPECT_TRUE(is_drawn_learnt);
      for (std::size_t t = learnt; t < kSequence; ++t) EXPECT_EQ(batch.weights[t], 0.0F);
      if (batch.warms_up[0] == 0.0F) {  // starts from the state stored with its first time step
        ++cold;
        const bool at_start = replay.is_first(batch.rows[0]);
        EXPECT_EQ(batch.recurrent_state[0], at_start ? 0.0F : first);
        EXPECT_TRUE(at_start || batch.rows[0] == replay.Row(0, 0));
      } else {
        ++warm;
        for (std::size_t t = 0; t < kBurnIn; ++t) {
          EXPECT_EQ(batch.warm_up[2 * t], first - static_cast<float>(kBurnIn - t));
          EXPECT_EQ(batch.warm_up[2 * t + 1], episode);
        }
        EXPECT_EQ(batch.recurrent_state[0], batch.warm_up[0]);
      }
    }
    EXPECT_GT(cold, 5);
    EXPECT_GT(warm, 5);
  }
}

TEST(ReplaySampler, IsReadyOnlyWhileATransitionCanBeDrawn) {
  Replay<float> replay({2, 1, 1, 1, 0});
  DeepOptions options = Options(1);
  options.batch_size = 1;
  options.priority_exponent = 0.0;
  ReplaySampler<float> sampler(replay, options, 1);
  StepResults results;
  results.rewards = results.features = {0};
  results.legal = {kAllActions};
  results.active = {1};
  for (int step = 0; step < 6; ++step) {  // episodes of one action
    const bool is_first = step % 2 == 0;
    results.is_first = {is_first ? std::uint8_t{1} : std::uint8_t{0}};
    results.end_reasons = {
        static_cast<std::uint8_t>(is_first ? EndReason::kNone : EndReason::kAllRetrieved)};
    replay.Add(results, results.features.data());
    sampler.Add();
    replay.SetActions({0});
    bool begins = false;
    for (std::size_t age = 0; age < replay.size(); ++age) begins |= replay.Begins(age, 0, 1);
    EXPECT_EQ(sampler.IsReady(), begins) << step;
  }
}

// Two agents; the first is done from the third time step on.
TEST(ReplaySampler, DrawsMomentsOfWholeFarmsWhileAnybodyIsAtWork) {
  constexpr std::size_t kFarms = 2;
  constexpr std::size_t kAgents = 2;
  for (const double priority : {0.0, 0.6}) {
    Replay<float> replay({8 * kFarms * kAgents, kFarms * kAgents, kAgents, 1, 0});
    DeepOptions options = Options(1);
    options.batch_size = 4;
    options.priority_exponent = priority;
    ReplaySampler<float> sampler(replay, options, 1, kAgents);
    StepResults results;
    results.rewards = results.features = {0, 0, 0, 0};
    results.legal = {kAllActions, kAllActions, kAllActions, kAllActions};
    std::set<std::size_t> over;  // rows at which the first farm's episodes are over
    RandomStream rng({1, 0, RngStream::kLearner, 1});
    for (int moment = 0; moment < 30; ++moment) {
      const int step = moment % 6;
      const std::uint8_t working = step < 2 ? 1 : 0;
      const auto reason = step == 5 ? EndReason::kAllRetrieved : EndReason::kNone;
      results.is_first = {step == 0 ? std::uint8_t{1} : std::uint8_t{0}, 0};
      results.active = {working, 1, 1, 1};
      results.end_reasons = {static_cast<std::uint8_t>(reason), 0};
      replay.Add(results, results.features.data());
      replay.SetActions({0, 0, 0, 0});
      sampler.Add();
      const std::size_t row = replay.Row(replay.size() - 1, 0);
      over.erase(row);
      if (step == 5) over.insert(row);
      if (!sampler.IsReady()) continue;
      std::set<std::size_t> drawn;
      for (int k = 0; k < 200; ++k) {
        const TransitionIndex one = sampler.Draw(rng, static_cast<std::size_t>(k) % 4);
        EXPECT_EQ(one.slot % kAgents, 0U);
        EXPECT_LT(one.age + 1, replay.size());
        drawn.insert(replay.Row(one.age, one.slot));
      }
      for (const std::size_t at : over) EXPECT_EQ(drawn.count(at), 0U) << "moment " << moment;
      const std::size_t begun = kFarms * (replay.size() - 1) - over.size() + over.count(row);
      EXPECT_EQ(drawn.size(), begun) << "moment " << moment << ", priority " << priority;
      sampler.UpdatePriority(*drawn.begin(), 1.0F);
    }
  }
}

}  // namespace
}  // namespace aquafarm::agents::test
