// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/make_actor_critic.h"

#include "ppo/feed_forward.h"
#include "ppo/lstm_actor_critic.h"

namespace aquafarm::agents {

std::unique_ptr<ActorCritic> MakeActorCritic(std::size_t features, std::size_t hidden,
                                             bool recurrent, std::uint64_t seed) {
  if (recurrent) return std::make_unique<LstmActorCritic>(features, hidden, seed);
  return std::make_unique<FeedForward>(features, hidden, seed);
}

}  // namespace aquafarm::agents
