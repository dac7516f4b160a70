// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/make_actor_critic.h"

#include "aquafarm/base/check.h"
#include "ppo/feed_forward.h"
#include "ppo/lstm_actor_critic.h"
#include "ppo/token_actor_critic.h"
#include "ppo/token_layout.h"

namespace aquafarm::agents {

std::unique_ptr<ActorCritic> MakeActorCritic(const EnvironmentSpec& spec, const PpoOptions& options,
                                             std::uint64_t seed) {
  const auto hidden = static_cast<std::size_t>(options.hidden_size);
  if (!HasTokens(spec)) {
    if (options.teacher.At(0.0) > 0.0) {
      throw InputError("teacher: got " + ToString(options.teacher) +
                       ", expected 0 in a scenario without view.tokens, which the teacher reads; "
                       "set view.tokens, or teacher=0");
    }
    return MakeActorCritic(static_cast<std::size_t>(spec.feature_count), hidden, options.recurrent,
                           seed);
  }
  if (options.recurrent) {
    throw InputError(
        "recurrent: got true, expected false in a scenario with view.tokens, whose network has no "
        "memory; use recurrent=false, or a scenario without view.tokens");
  }
  return std::make_unique<TokenActorCritic>(LayoutOfTokens(spec.feature_names), hidden, seed);
}

std::unique_ptr<ActorCritic> MakeActorCritic(std::size_t features, std::size_t hidden,
                                             bool recurrent, std::uint64_t seed) {
  if (recurrent) return std::make_unique<LstmActorCritic>(features, hidden, seed);
  return std::make_unique<FeedForward>(features, hidden, seed);
}

}  // namespace aquafarm::agents
