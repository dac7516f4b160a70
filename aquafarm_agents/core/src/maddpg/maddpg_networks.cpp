// SPDX-License-Identifier: BSD-3-Clause
#include "maddpg/maddpg_networks.h"

#include <string>

namespace aquafarm::agents {

namespace nn = torch::nn;

ActorTeam::ActorTeam(const EnvironmentSpec& spec, const MaddpgOptions& options)
    : recurrent_size_(options.recurrent ? 2 * options.hidden_size : 0) {
  DeepOptions layers;
  layers.hidden_size = options.hidden_size;
  const std::int32_t count = options.shared ? 1 : spec.agents;
  for (std::int32_t i = 0; i < count; ++i) {
    const std::string name = "actor" + std::to_string(i);
    if (options.recurrent) {
      recurrent_.push_back(register_module(
          name,
          std::make_shared<RecurrentNetwork>(spec.feature_count, options.hidden_size, false)));
    } else {
      plain_.push_back(register_module(name, MakeNetwork(spec, layers, 0)));
    }
  }
}

torch::Tensor ActorTeam::Forward(const torch::Tensor& observations, const torch::Tensor& keeps,
                                 torch::Tensor& recurrent_state) {
  const std::size_t networks = plain_.size() + recurrent_.size();
  if (networks == 1) return ForwardOne(0, observations, keeps, recurrent_state);
  std::vector<torch::Tensor> logits;
  std::vector<torch::Tensor> states;
  for (std::size_t i = 0; i < networks; ++i) {
    const auto agent = static_cast<std::int64_t>(i);
    torch::Tensor own =
        recurrent_state.defined() ? recurrent_state.narrow(1, agent, 1) : recurrent_state;
    logits.push_back(
        ForwardOne(i, observations.narrow(2, agent, 1), keeps.narrow(2, agent, 1), own));
    states.push_back(own);
  }
  if (recurrent_state.defined()) recurrent_state = torch::cat(states, 1);
  return torch::cat(logits, 1);
}

torch::Tensor ActorTeam::ForwardOne(std::size_t network, const torch::Tensor& observations,
                                    const torch::Tensor& keeps, torch::Tensor& recurrent_state) {
  const std::int64_t steps = observations.size(0);
  const std::int64_t farms = observations.size(1);
  const std::int64_t agents = observations.size(2);
  const torch::Tensor rows = observations.reshape({steps, farms * agents, -1});
  if (recurrent_.empty()) {
    return plain_[network]->Forward(rows[steps - 1]).view({farms, agents, kActionCount});
  }
  const std::int64_t hidden = recurrent_size_ / 2;
  const torch::Tensor both = recurrent_state.reshape({1, farms * agents, 2, hidden});
  RecurrentNetwork::State state{both.select(2, 0).contiguous(), both.select(2, 1).contiguous()};
  const torch::Tensor keep = keeps.reshape({steps, 1, farms * agents, 1});
  torch::Tensor logits;
  for (std::int64_t t = 0; t < steps; ++t) {
    state = {state.first * keep[t], state.second * keep[t]};
    if (t + 1 < steps) {
      recurrent_[network]->WarmUp(rows.narrow(0, t, 1), state);
    } else {
      logits = recurrent_[network]->Forward(rows.narrow(0, t, 1), state);
    }
  }
  recurrent_state =
      torch::stack({state.first, state.second}, 2).view({farms, agents, recurrent_size_});
  return logits.view({farms, agents, kActionCount});
}

JointCritic::JointCritic(const EnvironmentSpec& spec, std::int64_t hidden)
    : first_(register_module(
          "first",
          nn::Linear(spec.agents * spec.feature_count + (spec.agents - 1) * kActionCount, hidden))),
      second_(register_module("second", nn::Linear(hidden, hidden))),
      head_(register_module("head", nn::Linear(hidden, kActionCount))) {}

// In each row of the input, the evaluated agent comes first. The other agents follow in cyclic
// order. One network can thus evaluate every agent.
torch::Tensor JointCritic::Forward(const torch::Tensor& observations,
                                   const torch::Tensor& actions) {
  const std::int64_t count = observations.size(0);
  const std::int64_t agents = observations.size(1);
  const torch::Tensor ids =
      torch::arange(agents, torch::TensorOptions(torch::kLong).device(observations.device()));
  const torch::Tensor turn = (ids.unsqueeze(1) + ids.unsqueeze(0)).remainder(agents);
  const torch::Tensor seen = observations.index_select(1, turn.flatten()).view({count, agents, -1});
  if (agents == 1) return head_(second_(first_(seen).relu_()).relu_());
  const torch::Tensor others = turn.narrow(1, 1, agents - 1).flatten();
  const torch::Tensor done = actions.index_select(1, others).view({count, agents, -1});
  return head_(second_(first_(torch::cat({seen, done}, 2)).relu_()).relu_());
}

}  // namespace aquafarm::agents
