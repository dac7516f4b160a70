// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/maddpg/maddpg.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "aquafarm/agents/networks/torch_runtime.h"
#include "aquafarm/base/check.h"
#include "learning/moving_error.h"
#include "learning/saved_numbers.h"
#include "maddpg/maddpg_networks.h"
#include "maddpg/maddpg_policy.h"
#include "networks/flat_adam.h"
#include "networks/replay_learner.h"

namespace aquafarm::agents {
namespace {

constexpr std::uint32_t kActorStream = 0;
constexpr std::uint32_t kCriticStream = 2;
constexpr std::uint32_t kActingStream = 3;

float Sum(const std::vector<float>& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), 0.0F);
}

float Gumbel(RandomStream& rng) {
  // Excludes 0 and 1, for which the result is infinite.
  const float unit = 0.999998F * rng.Unit() + 1e-6F;
  return -std::log(-std::log(unit));
}

void MarkOne(std::uint8_t action, float mark, float* out) {
  std::fill_n(out, kActionCount, 0.0F);
  out[action] = mark;
}

/// Inputs of the actors for B samples. A sample has T consecutive time steps of one farm with S
/// agents. Its last time step is the drawn one (from_), or the one from which the target of the
/// drawn one bootstraps (to_).
struct Window {
  std::vector<float> observations;     // [T, B, S, F]
  std::vector<float> keeps;            // [T, B, S] as in ActorTeam::Forward
  std::vector<float> recurrent_state;  // [B, S, recurrent_size] before the first step
  std::vector<float> forbidden;        // [B, S, kActionCount] from MaskLogits, at the last step
  std::vector<float> present;          // [B, S] 1 if the agent is not done at the last step
};

ReplayLearnerOptions SharedOptions(const EnvironmentSpec& spec, const MaddpgOptions& options) {
  ReplayLearnerOptions shared;
  shared.exploration = options.exploration;
  shared.replay = {static_cast<std::size_t>(options.buffer_size), SlotCount(spec), spec.agents,
                   static_cast<std::size_t>(spec.feature_count),
                   options.recurrent ? 2 * static_cast<std::size_t>(options.hidden_size) : 0};
  shared.sampling.priority_exponent = options.priority_exponent;
  shared.sampling.importance_exponent = options.importance_exponent;
  shared.sampling.batch_size = options.batch_size;
  shared.steps = static_cast<std::size_t>(options.n_step);
  shared.group = static_cast<std::size_t>(spec.agents);
  return shared;
}

class MaddpgLearner final : public ReplayLearner<float> {
 public:
  MaddpgLearner(const EnvironmentSpec& spec, std::uint64_t seed, const MaddpgOptions& options,
                std::string resolved);

  std::uint8_t observation_types() const override { return kFeaturesBit; }
  LearnerStatus status() const override {
    return {loss_, static_cast<float>(explorer_.level()),
            static_cast<float>(options_.actor_rate.At(progress_))};
  }
  std::unique_ptr<Policy> GreedyPolicy() const override {
    return MakeActorsPolicy(spec_, options_, actor_.parameters().ToVector());
  }
  void SavePolicy(Checkpoint& checkpoint) const override {
    checkpoint.SetArray("weights", actor_.parameters().ToVector());
  }

 private:
  std::size_t batch() const { return static_cast<std::size_t>(options_.batch_size); }
  std::size_t agents() const { return static_cast<std::size_t>(spec_.agents); }
  std::size_t features() const { return static_cast<std::size_t>(spec_.feature_count); }
  std::size_t window() const { return static_cast<std::size_t>(options_.window); }
  std::size_t recurrent_size() const { return static_cast<std::size_t>(actors_.recurrent_size()); }
  template <typename Self, typename Visit>
  static void VisitCounters(Self& self, const Visit& visit);  // saved as integers
  template <typename Self, typename Visit>
  static void VisitNumbers(Self& self, const Visit& visit);  // saved as floating-point numbers
  Window MakeWindow() const;
  const float* RecurrentStates(const StepResults& results) override;
  void CountSteps(std::uint64_t farm_steps) override;
  bool TakeDue() override;
  bool CanSample() const override;
  void Choose(const StepResults& results, std::vector<std::uint8_t>& actions) override;
  void Update() override;
  void SaveOwn(Checkpoint& checkpoint) const override;
  void LoadOwn(const Checkpoint& checkpoint) override;
  TransitionIndex DrawMoment(std::size_t i);
  void Draw();
  void Reprioritise(const torch::Tensor& errors);
  void Fill(std::size_t i, std::size_t age, std::size_t first, Window& to);
  torch::Tensor Observations(Window& window) const;
  torch::Tensor Logits(ActorTeam& actors, Window& window);
  torch::Tensor GumbelNoise();
  torch::Tensor UpdateCritic(const torch::Tensor& observations);
  void UpdateActors(const torch::Tensor& observations, std::uint64_t position);
  void Check(bool is_finite, const char* what, std::uint64_t position) const;
  static void Follow(FlatParameters& target, const FlatParameters& online, double rate);

  const MaddpgOptions options_;
  ActorTeam actors_;
  ActorTeam target_actors_;
  JointCritic critic_;
  JointCritic target_critic_;
  FlatAdam actor_;
  FlatAdam critic_optimizer_;
  FlatParameters actor_target_;
  FlatParameters target_critic_parameters_;
  RandomStream acting_;  // draws the Gumbel noise of the chosen actions
  std::vector<float> recurrent_state_;
  double due_{};
  std::uint64_t steps_{};
  std::uint64_t updates_{};
  float loss_;

  // The minibatch of B transitions.
  Window from_;
  Window to_;
  std::vector<TransitionIndex> drawn_;  // [B]
  std::vector<float> taken_;  // [B, S, kActionCount] one-hot; zeros for an agent that is done
  std::vector<float>
      critic_actions_;          // [B, S, kActionCount] one-hot; action 0 for an agent that is done
  std::vector<float> rewards_;  // [B, S]
  std::vector<float> discounts_;      // [B, S]
  std::vector<float> weights_;        // [B, S] of the loss; without a team reward, 0 if done
  std::vector<float> noise_;          // [B, S, kActionCount]
  std::vector<float> agent_rewards_;  // scratch, [S]
};

MaddpgLearner::MaddpgLearner(const EnvironmentSpec& spec, std::uint64_t seed,
                             const MaddpgOptions& options, std::string resolved)
    : ReplayLearner(spec, seed, std::move(resolved), FindDevice(options.device),
                    SharedOptions(spec, options)),
      options_(options),
      actors_(spec, options),
      target_actors_(spec, options),
      critic_(spec, options.hidden_size),
      target_critic_(spec, options.hidden_size),
      actor_((DrawWeights(actors_, seed, kActorStream), actors_), device_),
      critic_optimizer_((DrawWeights(critic_, seed, kCriticStream), critic_), device_),
      actor_target_(target_actors_, device_),
      target_critic_parameters_(target_critic_, device_),
      acting_({seed, 0, RngStream::kLearner, kActingStream}),
      recurrent_state_(SlotCount(spec) * recurrent_size()),
      loss_(std::nanf("")),
      from_(MakeWindow()),
      to_(MakeWindow()),
      drawn_(batch()),
      taken_(batch() * agents() * kActionCount),
      critic_actions_(batch() * agents() * kActionCount),
      rewards_(batch() * agents()),
      discounts_(batch() * agents()),
      weights_(batch() * agents()),
      noise_(batch() * agents() * kActionCount),
      agent_rewards_(agents()) {
  Follow(actor_target_, actor_.parameters(), 1.0);
  Follow(target_critic_parameters_, critic_optimizer_.parameters(), 1.0);
}

Window MaddpgLearner::MakeWindow() const {
  Window made;
  const std::size_t rows = batch() * agents();
  made.observations.resize(window() * rows * features());
  made.keeps.resize(window() * rows);
  made.recurrent_state.resize(rows * recurrent_size());
  made.forbidden.resize(rows * kActionCount);
  made.present.resize(rows);
  return made;
}

const float* MaddpgLearner::RecurrentStates(const StepResults& results) {
  ClearStarted(results, agents() * recurrent_size(), recurrent_state_);
  return recurrent_state_.data();
}

void MaddpgLearner::CountSteps(std::uint64_t farm_steps) {
  steps_ += farm_steps;
  if (steps_ > options_.learning_starts)
    due_ += static_cast<double>(farm_steps) / options_.train_interval;
}

bool MaddpgLearner::TakeDue() {
  if (due_ < 1.0) return false;
  due_ -= 1.0;
  return true;
}

bool MaddpgLearner::CanSample() const {
  return replay_.size() >= window() + static_cast<std::size_t>(options_.n_step) + 2;
}

// The argmax of logits with Gumbel noise is a sample of their softmax.
void MaddpgLearner::Choose(const StepResults& results, std::vector<std::uint8_t>& actions) {
  const torch::NoGradGuard no_grad;
  const torch::Tensor logits = StepActors(actors_, results, spec_, recurrent_state_, device_);
  float* row = logits.data_ptr<float>();
  const float* seen = results.features.data();
  for (std::size_t i = 0; i < actions.size(); ++i, row += kActionCount) {
    for (std::size_t a = 0; a < kActionCount; ++a) row[a] += Gumbel(acting_);
    const ActionMask allowed = LegalMask(results.legal[i], seen, options_);
    seen += spec_.feature_count;
    actions[i] = explorer_.Choose(row, allowed, BestOf(row, allowed), i);
  }
}

// Draws a time step. The replay must contain its complete window, or the part of the window that
// lies in its episode. The oldest time steps of the replay may violate this condition. Such a time
// step is replaced by the oldest one of the same farm with a complete window, if there is one.
TransitionIndex MaddpgLearner::DrawMoment(std::size_t i) {
  const TransitionIndex drawn = sampler_.Draw(rng_, i);
  for (std::size_t back = 0; back <= drawn.age; ++back) {
    if (back + 1 == window()) return drawn;
    if (replay_.is_first(replay_.Row(drawn.age - back, drawn.slot))) return drawn;
  }
  const auto steps = static_cast<std::size_t>(options_.n_step);
  for (std::size_t age = window() - 1; age + steps < replay_.size(); ++age) {
    if (replay_.BeginsForAny(age, drawn.slot, steps)) return {age, drawn.slot};
  }
  return drawn;
}

void MaddpgLearner::Draw() {
  const auto scale = static_cast<float>(options_.reward_scale);
  for (std::size_t i = 0; i < batch(); ++i) {
    const TransitionIndex moment = DrawMoment(i);
    const std::size_t first = moment.slot;
    drawn_[i] = moment;
    const JointTransition all =
        replay_.JointAt(moment.age, first, static_cast<std::size_t>(options_.n_step),
                        static_cast<float>(options_.gamma), agent_rewards_.data());
    Fill(i, moment.age, first, from_);
    Fill(i, replay_.Age(all.to), first, to_);
    const std::size_t row = replay_.Row(moment.age, first);
    bool all_done = true;
    for (std::size_t agent = 0; agent < agents(); ++agent) {
      const std::size_t k = i * agents() + agent;
      const bool present = from_.present[k] > 0.0F;
      const std::uint8_t action = present ? replay_.action(row + agent) : std::uint8_t{0};
      MarkOne(action, 1.0F, critic_actions_.data() + k * kActionCount);
      MarkOne(action, from_.present[k], taken_.data() + k * kActionCount);
      all_done = all_done && IsTerminated(replay_.reason(all.to + agent));
    }
    for (std::size_t agent = 0; agent < agents(); ++agent) {
      const std::size_t k = i * agents() + agent;
      // With a team reward, an agent receives rewards until all agents are done.
      const bool is_done =
          spec_.team_reward ? all_done : IsTerminated(replay_.reason(all.to + agent));
      rewards_[k] = agent_rewards_[agent] * scale;
      discounts_[k] = is_done ? 0.0F : all.discount;
      // With a team reward, the values of agents that are done are also trained, because the target
      // of an agent's last transition bootstraps from them.
      weights_[k] = spec_.team_reward ? 1.0F : from_.present[k];
    }
  }
  const std::vector<float>& importance = sampler_.ImportanceWeights(progress_);
  for (std::size_t k = 0; k < weights_.size(); ++k) weights_[k] *= importance[k / agents()];
}

// Sets the priority of each transition to the mean error of the agents that learn from it.
// @param errors [B, S] absolute TD errors
void MaddpgLearner::Reprioritise(const torch::Tensor& errors) {
  const torch::Tensor learnt = ToDevice(weights_, {options_.batch_size, spec_.agents}) > 0.0F;
  const torch::Tensor means =
      ((errors * learnt).sum(1) / learnt.sum(1).clamp_min(1)).cpu().contiguous();
  const float* error = means.data_ptr<float>();
  for (std::size_t i = 0; i < batch(); ++i) {
    sampler_.UpdatePriority(replay_.Row(drawn_[i].age, drawn_[i].slot), error[i]);
  }
}

// Near the start of an episode, the window is padded with copies of the first time step. The
// recurrent state is reset after this padding.
void MaddpgLearner::Fill(std::size_t i, std::size_t age, std::size_t first, Window& to) {
  std::size_t back = 0;
  while (back + 1 < window() && back < age && !replay_.is_first(replay_.Row(age - back, first))) {
    ++back;
  }
  const std::size_t rows = batch() * agents();
  for (std::size_t t = 0; t < window(); ++t) {
    const std::size_t ago = std::min(window() - 1 - t, back);
    const std::size_t row = replay_.Row(age - ago, first);
    const bool keeps = window() - 1 - t <= back && !replay_.is_first(row);
    std::copy_n(replay_.observation(row), agents() * features(),
                to.observations.data() + (t * rows + i * agents()) * features());
    std::fill_n(to.keeps.data() + t * rows + i * agents(), agents(), keeps ? 1.0F : 0.0F);
  }
  std::copy_n(replay_.recurrent_state(replay_.Row(age - back, first)), agents() * recurrent_size(),
              to.recurrent_state.data() + i * agents() * recurrent_size());
  const std::size_t row = replay_.Row(age, first);
  for (std::size_t agent = 0; agent < agents(); ++agent) {
    const std::size_t k = i * agents() + agent;
    to.present[k] = IsTerminated(replay_.reason(row + agent)) ? 0.0F : 1.0F;
    MaskLogits(LegalMask(replay_.legal(row + agent), replay_.observation(row + agent), options_),
               to.forbidden.data() + k * kActionCount);
  }
}

torch::Tensor MaddpgLearner::Observations(Window& window_of) const {
  return ToDevice(window_of.observations,
                  {options_.window, options_.batch_size, spec_.agents, spec_.feature_count});
}

torch::Tensor MaddpgLearner::Logits(ActorTeam& actors, Window& window_of) {
  torch::Tensor recurrent_state;
  if (recurrent_size() > 0) {
    recurrent_state = ToDevice(window_of.recurrent_state,
                               {options_.batch_size, spec_.agents, actors.recurrent_size()});
  }
  return actors.Forward(
      Observations(window_of),
      ToDevice(window_of.keeps, {options_.window, options_.batch_size, spec_.agents}),
      recurrent_state);
}

torch::Tensor MaddpgLearner::GumbelNoise() {
  for (float& number : noise_) number = Gumbel(rng_);
  return ToDevice(noise_, {options_.batch_size, spec_.agents, kActionCount}).clone();
}

void MaddpgLearner::Update() {
  const std::uint64_t position = rng_.position();
  Draw();
  const torch::Tensor observations = Observations(from_)[options_.window - 1];
  const torch::Tensor loss = UpdateCritic(observations);
  Check(std::isfinite(loss.item<float>()), "loss of the critic", position);
  Check(critic_optimizer_.Step(loss, options_.critic_rate.At(progress_), options_.max_grad_norm),
        "gradient of the critic's loss", position);
  UpdateActors(observations, position);
  Follow(actor_target_, actor_.parameters(), options_.tau);
  Follow(target_critic_parameters_, critic_optimizer_.parameters(), options_.tau);
  ++updates_;
}

torch::Tensor MaddpgLearner::UpdateCritic(const torch::Tensor& observations) {
  const std::vector<std::int64_t> each{options_.batch_size, spec_.agents};
  const std::vector<std::int64_t> joint{options_.batch_size, spec_.agents, kActionCount};
  torch::Tensor targets;
  {
    const torch::NoGradGuard no_grad;
    const torch::Tensor forbidden = ToDevice(to_.forbidden, joint);
    const torch::Tensor logits = Logits(target_actors_, to_) + forbidden;
    const torch::Tensor present = ToDevice(to_.present, each);
    const torch::Tensor best = logits.argmax(2) * present.to(torch::kLong);  // 0 if done
    const torch::Tensor chosen = torch::one_hot(best, kActionCount).to(torch::kFloat);
    const torch::Tensor values = target_critic_.Forward(Observations(to_)[options_.window - 1],
                                                        chosen * present.unsqueeze(2));
    torch::Tensor next = (values * chosen).sum(2);
    // For an agent that is done, only the value of action 0 is trained. Here, action 0 represents
    // "no action".
    if (options_.best_response) {
      next = torch::where(present > 0.0F, (values + forbidden).amax(2), next);
    }
    targets = ToDevice(rewards_, each) + ToDevice(discounts_, each) * next;
  }
  const torch::Tensor taken = ToDevice(taken_, joint);
  const torch::Tensor predicted =
      (critic_.Forward(observations, taken) * ToDevice(critic_actions_, joint)).sum(2);
  const torch::Tensor weights = ToDevice(weights_, each) / std::max(1.0F, Sum(weights_));
  const double scale = options_.reward_scale * options_.reward_scale;
  const auto error = static_cast<float>(
      ((predicted.detach() - targets).square() * weights).sum().item<double>() / scale);
  loss_ = MoveError(loss_, error);
  if (options_.priority_exponent > 0.0) Reprioritise((predicted.detach() - targets).abs());
  return (torch::smooth_l1_loss(predicted, targets, at::Reduction::None) * weights).sum();
}

// The value of an agent's own one-hot action is the scalar product of this action and the agent's Q
// values. The gradient with respect to the action is therefore the vector of the Q values.
void MaddpgLearner::UpdateActors(const torch::Tensor& observations, std::uint64_t position) {
  const std::vector<std::int64_t> joint{options_.batch_size, spec_.agents, kActionCount};
  torch::Tensor slope;
  {
    const torch::NoGradGuard no_grad;
    slope = critic_.Forward(observations, ToDevice(taken_, joint));
  }
  const torch::Tensor logits = Logits(actors_, from_);
  const torch::Tensor allowed = logits + ToDevice(from_.forbidden, joint);
  const torch::Tensor soft = ((allowed + GumbelNoise()) / options_.temperature).softmax(2);
  const torch::Tensor hard = torch::one_hot(soft.argmax(2), kActionCount).to(torch::kFloat);
  const torch::Tensor action = hard + soft - soft.detach();
  const torch::Tensor weights = ToDevice(from_.present, {options_.batch_size, spec_.agents}) /
                                std::max(1.0F, Sum(from_.present));
  const torch::Tensor loss =
      -((action * slope).sum(2) * weights).sum() + options_.logit_penalty * logits.square().mean();
  Check(std::isfinite(loss.item<float>()), "loss of the actors", position);
  Check(actor_.Step(loss, options_.actor_rate.At(progress_), options_.max_grad_norm),
        "gradient of the actors' loss", position);
}

void MaddpgLearner::Check(bool is_finite, const char* what, std::uint64_t position) const {
  if (is_finite) return;
  throw LearnerFailed(std::string(what) + ": is not finite at update " +
                      std::to_string(updates_ + 1) + ", after " + std::to_string(steps_) +
                      " farm steps, on the batch drawn from seed " + std::to_string(seed_) +
                      " at position " + std::to_string(position) +
                      "; expected a number: try a smaller actor_rate, critic_rate or reward_scale");
}

void MaddpgLearner::Follow(FlatParameters& target, const FlatParameters& online, double rate) {
  const torch::NoGradGuard no_grad;
  target.values().lerp_(online.values(), rate);
}

template <typename Self, typename Visit>
void MaddpgLearner::VisitCounters(Self& self, const Visit& visit) {
  visit("rng", self.rng_);
  visit("acting_rng", self.acting_);
  visit("steps", self.steps_);
  visit("updates", self.updates_);
}

template <typename Self, typename Visit>
void MaddpgLearner::VisitNumbers(Self& self, const Visit& visit) {
  visit("due", self.due_);
  visit("loss", self.loss_);
}

void MaddpgLearner::SaveOwn(Checkpoint& checkpoint) const {
  actor_.Save(checkpoint);
  critic_optimizer_.Save(checkpoint, "critic.");
  checkpoint.SetArray("target.actors", actor_target_.ToVector());
  checkpoint.SetArray("target.critic", target_critic_parameters_.ToVector());
  checkpoint.SetArray("carry", recurrent_state_);
  SaveNumbers(checkpoint, "maddpg.counters",
              [this](const auto& visit) { VisitCounters(*this, visit); });
  SaveNumbers(checkpoint, "maddpg.learning",
              [this](const auto& visit) { VisitNumbers(*this, visit); });
}

void MaddpgLearner::LoadOwn(const Checkpoint& checkpoint) {
  std::vector<float> actors;
  std::vector<float> critic;
  std::vector<float> recurrent_state;
  checkpoint.GetArray("target.actors", static_cast<std::size_t>(actor_target_.size()), actors);
  checkpoint.GetArray("target.critic", static_cast<std::size_t>(target_critic_parameters_.size()),
                      critic);
  checkpoint.GetArray("carry", recurrent_state_.size(), recurrent_state);
  LoadNumbers<std::uint64_t>(checkpoint, "maddpg.counters", "chance",
                             [this](const auto& visit) { VisitCounters(*this, visit); });
  LoadNumbers<double>(checkpoint, "maddpg.learning", "numbers",
                      [this](const auto& visit) { VisitNumbers(*this, visit); });
  actor_.Load(checkpoint);
  critic_optimizer_.Load(checkpoint, "critic.");
  actor_target_.FromVector(actors);
  target_critic_parameters_.FromVector(critic);
  recurrent_state_ = std::move(recurrent_state);
}

}  // namespace

std::uint8_t MaddpgObservationTypes(const std::string& options) {
  std::string resolved;
  MaddpgOptions::Parse(options, resolved);
  return kFeaturesBit;
}

std::unique_ptr<Learner> MakeMaddpg(const EnvironmentSpec& spec, std::uint64_t seed,
                                    const std::string& text) {
  std::string resolved;
  const MaddpgOptions options = MaddpgOptions::Parse(text, resolved);
  PrepareTorch(options.threads);
  return std::make_unique<MaddpgLearner>(spec, seed, options, resolved);
}

std::unique_ptr<Policy> MakeMaddpgPolicy(const Checkpoint& checkpoint,
                                         const EnvironmentSpec& spec) {
  std::string resolved;
  MaddpgOptions options = MaddpgOptions::Parse(checkpoint.options, resolved);
  options.device = PlayingDevice(options.device);
  PrepareTorch(options.threads);
  CheckFits(checkpoint, spec, NetworkKind::kMlp);
  std::vector<float> weights;
  checkpoint.GetArray("weights", checkpoint.Section("weights").size() / sizeof(float), weights);
  return MakeActorsPolicy(spec, options, weights);
}

}  // namespace aquafarm::agents
