// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/rollout.h"

#include <algorithm>
#include <numeric>
#include <type_traits>
#include <utility>

#include "aquafarm/base/check.h"
#include "learning/saved_numbers.h"
#include "ppo/ppo_loss.h"

namespace aquafarm::agents {
namespace {

float TeamReward(const StepResults& results, std::size_t first, std::size_t agents) {
  const auto begin = results.rewards.begin() + static_cast<std::ptrdiff_t>(first);
  return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(agents), 0.0F);
}

// Returns exactly `own` for a share of 0.
float Blend(float own, float team, float share) {
  return share == 0.0F ? own : own + share * (team - own);
}

}  // namespace

Rollout::Rollout(const Shape& shape)
    : shape_(shape),
      features_(samples() * shape.features),
      states_((shape.steps + shape.sequence_length - 1) / shape.sequence_length * shape.slots *
              shape.state_size),
      masks_(samples()),
      actions_(samples()),
      is_first_(samples()),
      log_probs_(samples()),
      values_(samples() + shape.slots),
      rewards_(samples()),
      ends_(samples(), StepEnd::kNoTransition),
      labels_(shape.has_labels ? samples() : 0, kNoLabel) {}

void Rollout::Complete(const StepResults& results, const Rewards& rewards) {
  if (!is_open_) return;
  is_open_ = false;
  float team = 0.0F;
  const std::size_t first = (steps_ - 1) * shape_.slots;
  for (std::size_t slot = 0; slot < shape_.slots; ++slot) {
    const std::size_t farm = slot / shape_.agents;
    StepEnd& end = ends_[first + slot];
    if (slot % shape_.agents == 0) team = TeamReward(results, slot, shape_.agents);
    rewards_[first + slot] = rewards.scale * Blend(results.rewards[slot], team, rewards.team_share);
    if (end == StepEnd::kNoTransition) continue;
    if (results.is_first[farm] != 0) {
      end = StepEnd::kNoTransition;  // the farm was lost and replaced by a new one
    } else if (shape_.is_team ? IsTerminated(static_cast<EndReason>(results.end_reasons[farm]))
                              : results.IsDone(slot, farm)) {
      end = StepEnd::kTerminated;
    } else if (static_cast<EndReason>(results.end_reasons[farm]) != EndReason::kNone) {
      end = StepEnd::kTruncated;
    }
  }
}

void Rollout::Add(const StepResults& results, const std::vector<ActionMask>& masks,
                  const std::vector<std::uint8_t>& actions, const std::vector<float>& log_probs,
                  const std::vector<float>& values, const std::vector<float>& state) {
  AQUAFARM_CHECK_LT(steps_, shape_.steps);
  const std::size_t first = steps_ * shape_.slots;
  const auto at = static_cast<std::ptrdiff_t>(first);
  std::copy_n(results.features.begin(), shape_.slots * shape_.features,
              features_.begin() + at * static_cast<std::ptrdiff_t>(shape_.features));
  std::copy(masks.begin(), masks.end(), masks_.begin() + at);
  std::copy(actions.begin(), actions.end(), actions_.begin() + at);
  std::copy(log_probs.begin(), log_probs.end(), log_probs_.begin() + at);
  std::copy(values.begin(), values.end(), values_.begin() + at);
  if (!labels_.empty()) std::fill_n(labels_.begin() + at, shape_.slots, kNoLabel);
  if (steps_ % shape_.sequence_length == 0) {
    const std::size_t block = steps_ / shape_.sequence_length * state.size();
    std::copy(state.begin(), state.end(), states_.begin() + static_cast<std::ptrdiff_t>(block));
  }
  for (std::size_t slot = 0; slot < shape_.slots; ++slot) {
    const std::size_t farm = slot / shape_.agents;
    const bool is_active = (shape_.is_team || results.active[slot] != 0) &&
                           static_cast<EndReason>(results.end_reasons[farm]) == EndReason::kNone;
    ends_[first + slot] = is_active ? StepEnd::kContinues : StepEnd::kNoTransition;
    is_first_[first + slot] = results.is_first[farm];
  }
  ++steps_;
  is_open_ = true;
}

void Rollout::SetLabels(const std::vector<std::uint8_t>& labels) {
  AQUAFARM_CHECK_EQ(labels.size(), shape_.slots);
  AQUAFARM_CHECK_EQ(labels_.size(), samples());
  const auto at = static_cast<std::ptrdiff_t>((steps_ - 1) * shape_.slots);
  std::copy(labels.begin(), labels.end(), labels_.begin() + at);
}

void Rollout::Finish(const std::vector<float>& last_values, float gamma, float lambda) {
  AQUAFARM_CHECK_EQ(last_values.size(), shape_.slots);
  std::copy(last_values.begin(), last_values.end(),
            values_.begin() + static_cast<std::ptrdiff_t>(samples()));
  EstimateAdvantages(rewards_, values_, ends_, shape_.slots, gamma, lambda, advantages_);
}

const float* Rollout::state(std::size_t sample) const {
  const std::size_t step = sample / shape_.slots;
  AQUAFARM_CHECK_EQ(step % shape_.sequence_length, 0U);
  const std::size_t block = step / shape_.sequence_length * shape_.slots + sample % shape_.slots;
  return states_.data() + block * shape_.state_size;
}

template <typename Self, typename Visit>
void Rollout::VisitNumbers(Self& self, const Visit& visit) {
  visit("steps", self.steps_);
  visit("is_open", self.is_open_);
}

void Rollout::Save(Checkpoint& checkpoint) const {
  const std::size_t used = steps_ * shape_.slots;
  const auto save = [&](const char* name, const auto& values, std::size_t each) {
    const auto count = static_cast<std::ptrdiff_t>(used * each);
    checkpoint.SetArray(std::string("rollout.") + name,
                        std::vector(values.begin(), values.begin() + count));
  };
  SaveNumbers(checkpoint, "rollout.progress",
              [this](const auto& visit) { VisitNumbers(*this, visit); });
  save("features", features_, shape_.features);
  save("masks", masks_, 1);
  save("actions", actions_, 1);
  save("started", is_first_, 1);
  save("log_probs", log_probs_, 1);
  save("values", values_, 1);
  save("rewards", rewards_, 1);
  save("ends", ends_, 1);
  if (!labels_.empty()) save("labels", labels_, 1);
  checkpoint.SetArray("rollout.states", states_);
}

void Rollout::Load(const Checkpoint& checkpoint) {
  Rollout loaded(shape_);
  LoadNumbers<std::uint64_t>(checkpoint, "rollout.progress", "rollout",
                             [&loaded](const auto& visit) { VisitNumbers(loaded, visit); });
  if (loaded.steps_ > shape_.steps) {
    throw InputError("rollout: got " + std::to_string(loaded.steps_) + " steps, expected at most " +
                     std::to_string(shape_.steps) + ": damaged, resume from another checkpoint");
  }
  const std::size_t used = loaded.steps_ * shape_.slots;
  const auto load = [&](const char* name, auto& values, std::size_t each) {
    std::remove_reference_t<decltype(values)> got;
    checkpoint.GetArray(std::string("rollout.") + name, used * each, got);
    std::copy(got.begin(), got.end(), values.begin());
  };
  load("features", loaded.features_, shape_.features);
  load("masks", loaded.masks_, 1);
  load("actions", loaded.actions_, 1);
  load("started", loaded.is_first_, 1);
  load("log_probs", loaded.log_probs_, 1);
  load("values", loaded.values_, 1);
  load("rewards", loaded.rewards_, 1);
  load("ends", loaded.ends_, 1);
  for (const std::uint8_t action : loaded.actions_) {
    if (action < kActionCount) continue;
    throw InputError("rollout.actions: got " + std::to_string(action) + ", expected at most " +
                     std::to_string(kActionCount - 1) +
                     ": damaged, resume from another checkpoint");
  }
  // Older checkpoints contain no labels. Their samples are not imitated.
  if (!labels_.empty() && checkpoint.Has("rollout.labels")) load("labels", loaded.labels_, 1);
  for (const std::uint8_t label : loaded.labels_) {
    if (label < kActionCount || label == kNoLabel) continue;
    throw InputError("rollout.labels: got " + std::to_string(label) + ", expected at most " +
                     std::to_string(kActionCount - 1) + " or " + std::to_string(kNoLabel) +
                     ": damaged, resume from another checkpoint");
  }
  checkpoint.GetArray("rollout.states", loaded.states_.size(), loaded.states_);
  *this = std::move(loaded);
}

}  // namespace aquafarm::agents
