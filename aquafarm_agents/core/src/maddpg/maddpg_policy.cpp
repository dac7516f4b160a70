// SPDX-License-Identifier: BSD-3-Clause
#include "maddpg/maddpg_policy.h"

#include <algorithm>
#include <utility>

#include "networks/deep_policy.h"

namespace aquafarm::agents {
namespace {

class MaddpgPolicy final : public Policy {
 public:
  MaddpgPolicy(EnvironmentSpec spec, const MaddpgOptions& options,
               const std::vector<float>& weights)
      : spec_(std::move(spec)),
        options_(options),
        device_(FindDevice(options.device)),
        actors_(spec_, options),
        parameters_(actors_, device_) {
    parameters_.FromVector(weights);
  }
  std::uint8_t observation_types() const override { return kFeaturesBit; }
  void Begin(std::uint64_t, std::int32_t farms) override {
    recurrent_state_.assign(
        static_cast<std::size_t>(farms * spec_.agents * actors_.recurrent_size()), 0.0F);
  }
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override {
    const torch::NoGradGuard no_grad;
    ClearStarted(results, static_cast<std::size_t>(spec_.agents * actors_.recurrent_size()),
                 recurrent_state_);
    const torch::Tensor logits = StepActors(actors_, results, spec_, recurrent_state_, device_);
    actions.resize(results.legal.size());
    const float* row = logits.data_ptr<float>();
    const float* seen = results.features.data();
    for (std::size_t i = 0; i < actions.size(); ++i, row += kActionCount) {
      actions[i] = BestOf(row, LegalMask(results.legal[i], seen, options_)).action;
      seen += spec_.feature_count;
    }
  }

 private:
  EnvironmentSpec spec_;
  MaddpgOptions options_;
  torch::Device device_;
  ActorTeam actors_;
  FlatParameters parameters_;
  std::vector<float> recurrent_state_;
};

}  // namespace

void ClearStarted(const StepResults& results, std::size_t size_of_farm,
                  std::vector<float>& recurrent_state) {
  for (std::size_t farm = 0; farm < results.is_first.size() && !recurrent_state.empty(); ++farm) {
    if (results.is_first[farm] == 0) continue;
    std::fill_n(recurrent_state.begin() + static_cast<std::ptrdiff_t>(farm * size_of_farm),
                size_of_farm, 0.0F);
  }
}

torch::Tensor StepActors(ActorTeam& actors, const StepResults& results, const EnvironmentSpec& spec,
                         std::vector<float>& recurrent_state, torch::Device device) {
  const auto slots = static_cast<std::int64_t>(results.legal.size());
  const std::int64_t farms = slots / spec.agents;
  const torch::Tensor observations =
      torch::from_blob(const_cast<float*>(results.features.data()),
                       {1, farms, spec.agents, spec.feature_count}, torch::kFloat)
          .to(device);
  torch::Tensor held;
  if (!recurrent_state.empty()) {
    held = torch::from_blob(recurrent_state.data(), {farms, spec.agents, actors.recurrent_size()},
                            torch::kFloat)
               .to(device);
  }
  const torch::Tensor keeps = torch::ones({1, farms, spec.agents}, device);
  const torch::Tensor logits = actors.Forward(observations, keeps, held);
  if (!recurrent_state.empty()) {
    const torch::Tensor after = held.cpu().contiguous();
    std::copy_n(after.data_ptr<float>(), recurrent_state.size(), recurrent_state.data());
  }
  return logits.reshape({slots, kActionCount}).cpu().contiguous();
}

std::unique_ptr<Policy> MakeActorsPolicy(const EnvironmentSpec& spec, const MaddpgOptions& options,
                                         const std::vector<float>& weights) {
  return std::make_unique<MaddpgPolicy>(spec, options, weights);
}

}  // namespace aquafarm::agents
