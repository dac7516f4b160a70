// SPDX-License-Identifier: BSD-3-Clause
#include "networks/repetition_penalty.h"

#include <algorithm>
#include <string>

#include "aquafarm/agents/base/text.h"
#include "aquafarm/base/hash.h"
#include "networks/farm_rows.h"

namespace aquafarm::agents {
namespace {

constexpr unsigned kActionBits = 4;
static_assert(kActionCount < 1 << kActionBits);

// Returns whether a feature is part of the situation. @param name as in Encoder::feature_names
// @param has_cell whether the features contain the ship's cell; if not, the relative positions of
// the ports identify the cell
bool DescribesSituation(const std::string& name, bool has_cell) {
  if (name == "self.x" || name == "self.y" || EndsWith(name, "free_capacity")) return true;
  if (name.rfind("device", 0) == 0) return EndsWith(name, ".deployed") || EndsWith(name, ".aboard");
  return !has_cell && name.rfind("port", 0) == 0 &&
         (EndsWith(name, ".east") || EndsWith(name, ".north"));
}

}  // namespace

RepetitionPenalty::RepetitionPenalty(const EnvironmentSpec& spec, double penalty)
    : agents_(static_cast<std::size_t>(spec.agents)), penalty_(static_cast<float>(penalty)) {
  if (penalty == 0.0) return;
  const std::vector<std::string>& names = spec.feature_names;
  const bool has_cell = std::find(names.begin(), names.end(), "self.x") != names.end();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (DescribesSituation(names[i], has_cell)) described_.push_back(i);
  }
  steps_.resize(SlotCount(spec));
  done_.resize(steps_.size() * kRemembered);
}

// Returns the hash of the situation, shifted to leave the low bits free for an action.
std::uint64_t RepetitionPenalty::SituationOf(const float* features) const {
  Hasher situation;
  for (const std::size_t feature : described_) situation.Add(features[feature], 0.0F);
  return situation.value() << kActionBits;
}

void RepetitionPenalty::Begin(const StepResults& results) {
  for (std::size_t slot = 0; slot < steps_.size(); ++slot) {
    if (results.is_first[slot / agents_] != 0) steps_[slot] = 0;
  }
}

const float* RepetitionPenalty::Penalize(const float* values, const float* features,
                                         std::size_t slot) {
  if (steps_.empty()) return values;
  situation_ = SituationOf(features);
  std::copy_n(values, kActionCount, values_.begin());
  const std::uint64_t* const done = done_.data() + slot * kRemembered;
  const std::size_t count = std::min<std::size_t>(steps_[slot], kRemembered);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t action = done[i] ^ situation_;
    if (action < kActionCount) values_[action] -= penalty_;
  }
  return values_.data();
}

void RepetitionPenalty::Add(std::uint8_t action, std::size_t slot) {
  if (steps_.empty()) return;
  done_[slot * kRemembered + steps_[slot]++ % kRemembered] = situation_ | action;
}

void RepetitionPenalty::Save(Checkpoint& checkpoint) const {
  if (steps_.empty()) return;
  checkpoint.SetArray("repetitions", done_);
  checkpoint.SetArray("repetition_turns", steps_);
}

void RepetitionPenalty::Load(const Checkpoint& checkpoint) {
  if (steps_.empty()) return;
  checkpoint.GetArray("repetitions", done_.size(), done_);
  checkpoint.GetArray("repetition_turns", steps_.size(), steps_);
}

}  // namespace aquafarm::agents
