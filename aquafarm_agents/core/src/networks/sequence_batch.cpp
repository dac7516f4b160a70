// SPDX-License-Identifier: BSD-3-Clause
#include "networks/sequence_batch.h"

#include <algorithm>

#include "networks/deep_policy.h"

namespace aquafarm::agents {

SequenceBatch::SequenceBatch(const DeepOptions& options, std::size_t features,
                             std::size_t recurrent_size)
    : burn_in_(static_cast<std::size_t>(options.burn_in)),
      steps_(static_cast<std::size_t>(options.sequence_length)),
      features_(features),
      recurrent_size_(recurrent_size) {
  const auto count = static_cast<std::size_t>(options.batch_size);
  warm_up.resize(burn_in_ * count * features);
  observations.resize((steps_ + 1) * count * features);
  recurrent_state.resize(count * recurrent_size);
  if (options.paper_tuple) recurrent_state_after.resize(count * recurrent_size);
  warms_up.resize(count);
  actions.resize(steps_ * count);
  rewards.resize(steps_ * count);
  discounts.resize(steps_ * count);
  next.resize(steps_ * count);
  allowed.resize((steps_ + 1) * count);
  weights.resize(steps_ * count);
  rows.resize(steps_ * count);
}

void SequenceBatch::Fill(std::size_t b, const Replay<float>& replay, const TransitionIndex& moment,
                         const DeepOptions& options) {
  const auto [age, slot] = moment;
  std::size_t back = 0;
  while (back < burn_in_ && back < age && !replay.is_first(replay.Row(age - back, slot))) ++back;
  const std::size_t from = age - back;
  const bool is_warmed = back == burn_in_ && !replay.is_first(replay.Row(from, slot));
  const std::size_t first = is_warmed ? age : from;
  warms_up[b] = is_warmed ? 1.0F : 0.0F;
  for (std::size_t t = 0; t < burn_in_; ++t) {
    const std::size_t row = replay.Row(is_warmed ? from + t : first, slot);
    std::copy_n(replay.observation(row), features_, warm_up.data() + (t * size() + b) * features_);
  }
  std::copy_n(replay.recurrent_state(replay.Row(from, slot)), recurrent_size_,
              recurrent_state.data() + b * recurrent_size_);
  FillRun(b, replay, {first, slot}, options);
}

void SequenceBatch::FillRun(std::size_t b, const Replay<float>& replay,
                            const TransitionIndex& first, const DeepOptions& options) {
  const auto [age, slot] = first;
  std::size_t last = 0;  // time step at which the run ends
  while (last < steps_ && replay.Begins(age + last, slot, 1)) ++last;
  if (options.paper_tuple) {
    const std::size_t row = replay.Row(age + last, slot);
    std::copy_n(replay.recurrent_state(row), recurrent_size_,
                recurrent_state_after.data() + b * recurrent_size_);
  }
  for (std::size_t t = 0; t <= steps_; ++t) {
    const std::size_t row = replay.Row(age + std::min(t, last), slot);
    std::copy_n(replay.observation(row), features_,
                observations.data() + (t * size() + b) * features_);
    allowed[t * size() + b] = LegalMask(replay.legal(row), replay.observation(row), options);
  }
  for (std::size_t t = 0; t < steps_; ++t) {
    const std::size_t i = t * size() + b;
    const bool is_learnt = t < last;
    rows[i] = replay.Row(age + std::min(t, last), slot);
    weights[i] = is_learnt ? 1.0F : 0.0F;
    actions[i] = 0;
    rewards[i] = discounts[i] = 0.0F;
    next[i] = static_cast<std::int64_t>(last);
    if (!is_learnt) continue;
    const std::size_t reach = std::min(static_cast<std::size_t>(options.n_step), last - t);
    const Transition one = replay.At(age + t, slot, reach, static_cast<float>(options.gamma));
    actions[i] = one.action;
    rewards[i] = one.reward * static_cast<float>(options.reward_scale);
    discounts[i] = one.discount;
    next[i] = static_cast<std::int64_t>(t + reach);
  }
}

}  // namespace aquafarm::agents
