// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/make_actor_critic.h"

#include <utility>

#include "aquafarm/base/check.h"
#include "ppo/central_actor_critic.h"
#include "ppo/feed_forward.h"
#include "ppo/lstm_actor_critic.h"
#include "ppo/token_actor_critic.h"
#include "ppo/token_layout.h"

namespace aquafarm::agents {

std::unique_ptr<ActorCritic> MakeActorCritic(const EnvironmentSpec& spec, const PpoOptions& options,
                                             std::uint64_t seed) {
  const auto hidden = static_cast<std::size_t>(options.hidden_size);
  if (!HasTokens(spec)) {
    if (options.HasTeacher() && options.teacher_policy == TeacherPolicy::kRule) {
      throw InputError("teacher: got " + ToString(options.teacher) +
                       ", expected 0 in a scenario without view.tokens, which the rule reads; set "
                       "teacher_policy=planner, teacher=0, or, for ppo, view.tokens");
    }
    if (options.augment || options.symmetric) {
      throw InputError(std::string(options.augment ? "augment" : "symmetric") +
                       ": got true, expected false in a scenario without view.tokens: only "
                       "observations as tokens can be rotated; set view.tokens, or false");
    }
    if (options.max_visits > 0) {
      throw InputError("max_visits: got " + std::to_string(options.max_visits) +
                       ", expected 0 in a scenario without view.tokens, which contain the routes; "
                       "set view.tokens, or max_visits=0");
    }
    const auto features = static_cast<std::size_t>(spec.feature_count);
    if (!options.central) return MakeActorCritic(features, hidden, options.recurrent, {seed});
    return MakeCentralActorCritic(features, static_cast<std::size_t>(spec.agents), hidden,
                                  options.recurrent, seed);
  }
  if (options.central) {
    throw InputError(
        "algorithm: got mappo in a scenario with view.tokens, expected ppo, whose network reads "
        "entity tokens; set algorithm ppo, or use a scenario without view.tokens");
  }
  if (options.recurrent) {
    throw InputError(
        "recurrent: got true, expected false in a scenario with view.tokens, whose network has no "
        "memory; use recurrent=false, or a scenario without view.tokens");
  }
  return std::make_unique<TokenActorCritic>(LayoutOfTokens(spec.feature_names), hidden, seed);
}

std::unique_ptr<ActorCritic> MakeActorCritic(std::size_t features, std::size_t hidden,
                                             bool recurrent, const WeightOrigin& origin) {
  if (recurrent) return std::make_unique<LstmActorCritic>(features, hidden, origin);
  return std::make_unique<FeedForward>(features, hidden, origin);
}

std::unique_ptr<ActorCritic> MakeCentralActorCritic(std::size_t features, std::size_t agents,
                                                    std::size_t hidden, bool recurrent,
                                                    std::uint64_t seed) {
  constexpr std::uint32_t kCriticNetwork = 1;
  auto policy = MakeActorCritic(features, hidden, recurrent, {seed});
  const WeightOrigin origin{seed, kCriticNetwork, policy->weights().size()};
  auto critic = MakeActorCritic(features * agents, hidden, recurrent, origin);
  return std::make_unique<CentralActorCritic>(agents, std::move(policy), std::move(critic));
}

}  // namespace aquafarm::agents
