// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/scene/pairing.h"

#include "aquafarm_viz/base/checks.h"

namespace aquafarm_viz {

std::string Pairing::AddSpec(const aquafarm_msgs::FarmSpecConstPtr& spec) {
  if (auto fault = CheckSpec(*spec); !fault.empty()) return fault;
  specs_.push_back(spec);
  if (specs_.size() > kSpecs) specs_.pop_front();
  Pair();
  return "";
}

std::string Pairing::AddState(const aquafarm_msgs::FarmStateConstPtr& state) {
  if (auto fault = CheckState(*state); !fault.empty()) return fault;
  newest_ = state;
  Pair();
  return "";
}

void Pairing::Pair() {
  if (newest_ == nullptr) return;
  // After a reset with the same seed, several specs may be of this episode. The last one is valid.
  for (auto spec = specs_.rbegin(); spec != specs_.rend(); ++spec) {
    if (!SameEpisode(**spec, *newest_)) continue;
    shown_ = {*spec, newest_};
    return;
  }
}

std::string Pairing::Waiting() const {
  if (newest_ == nullptr || newest_ == shown_.state) return "";
  std::string line = "got a state of episode " + std::to_string(newest_->episode) + " with seed " +
                     std::to_string(newest_->seed) + ", but ";
  if (specs_.empty()) return line + "no spec; nothing is drawn until its spec arrives";
  return line + "the last spec is of episode " + std::to_string(specs_.back()->episode) +
         " with seed " + std::to_string(specs_.back()->seed) + "; waiting for the matching spec";
}

}  // namespace aquafarm_viz
