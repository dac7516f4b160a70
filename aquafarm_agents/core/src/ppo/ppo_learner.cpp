// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "aquafarm/agents/learning/warm_start.h"
#include "aquafarm/agents/networks/torch_runtime.h"
#include "aquafarm/agents/ppo/ppo.h"
#include "aquafarm/base/check.h"
#include "aquafarm/grid/step_fields.h"
#include "learning/saved_numbers.h"
#include "networks/farm_rows.h"
#include "ppo/actor.h"
#include "ppo/make_actor_critic.h"
#include "ppo/ppo_policy.h"
#include "ppo/ppo_updater.h"
#include "ppo/rollout.h"
#include "ppo/teacher.h"

namespace aquafarm::agents {
namespace {

// Stream 0 of kLearner draws the weights. Stream 1 + s draws the order of the samples of shard s.
constexpr std::uint32_t kFirstOrderStream = 1;

/// Range of the training's shards (struct Shard) that belong to this process.
struct ShardRange {
  std::size_t first{};
  std::size_t count{};
  std::int32_t farms{};  ///< number of farms of one shard
};

/// @param farms number of farms of this process
ShardRange LocalShards(const PpoOptions& options, std::int32_t farms, const ProcessGroup* group) {
  const int ranks = group == nullptr ? 1 : group->size();
  const int rank = group == nullptr ? 0 : group->rank();
  if (options.shards % ranks != 0) {
    throw InputError("shards: got " + std::to_string(options.shards) + " with " +
                     std::to_string(ranks) + " ranks, expected a multiple of the ranks, such as " +
                     std::to_string(ranks));
  }
  const std::int32_t count = options.shards / ranks;
  if (farms % count != 0) {
    throw InputError("farms: got " + std::to_string(farms * ranks) + " with " +
                     std::to_string(options.shards) + " shards, expected a multiple of the shards");
  }
  return {static_cast<std::size_t>(count * rank), static_cast<std::size_t>(count), farms / count};
}

/// @param shard spec of the farms of one shard
/// @param total number of slots of all shards of the training
Rollout::Shape RolloutShape(const EnvironmentSpec& shard, const PpoOptions& options,
                            std::size_t state_size, std::size_t total) {
  Rollout::Shape shape;
  shape.slots = SlotCount(shard);
  shape.steps = static_cast<std::size_t>(options.Horizon(total));
  shape.agents = static_cast<std::size_t>(shard.agents);
  shape.features = static_cast<std::size_t>(shard.feature_count);
  shape.state_size = state_size;
  shape.is_team = options.IsTeam(shard.team_reward);
  shape.has_labels = options.HasTeacher();
  if (options.recurrent) {
    shape.sequence_length = static_cast<std::size_t>(options.sequence_length);
  }
  return shape;
}

// Replaces the weights of `network` by those of a policy or of a training checkpoint. A policy of
// MAPPO contains no weights of the critic, which then keeps its initial weights.
void ReplaceWeights(const Checkpoint& checkpoint, ActorCritic& network) {
  const std::size_t got = checkpoint.Section("weights").size() / sizeof(float);
  if (got != network.weights().size() && got != network.policy_size()) {
    throw InputError("network: got a policy with " + std::to_string(got) + " weights, expected " +
                     std::to_string(network.policy_size()) + ": train with its options (" +
                     checkpoint.options + ")");
  }
  std::vector<float> weights;
  checkpoint.GetArray("weights", got, weights);
  std::copy(weights.begin(), weights.end(), network.weights().begin());
}

// Returns the weights that a saved policy contains.
std::vector<float> PolicyWeights(const ActorCritic& network) {
  const auto begin = network.weights().begin();
  return {begin, begin + static_cast<std::ptrdiff_t>(network.policy_size())};
}

/// Copies the results of `count` farms from `first` on.
void CopyFarms(const StepResults& all, std::size_t first, std::size_t count, StepResults& part) {
  const std::size_t farms = all.is_first.size();
  VisitStepFields(
      [&](const StepField&, const auto& from, auto& to) {
        const auto each = static_cast<std::ptrdiff_t>(from.size() / farms);
        const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first) * each;
        to.assign(begin, begin + static_cast<std::ptrdiff_t>(count) * each);
      },
      all, part);
  if (all.states.empty()) return;
  const auto begin = all.states.begin() + static_cast<std::ptrdiff_t>(first);
  part.states.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
}

/// A group of farms with its own rollout and its own random streams.
struct Shard {
  /// @param spec spec of the farms of the shard
  /// @param index index of the shard in the training
  Shard(const EnvironmentSpec& spec, std::uint64_t seed, const PpoOptions& options,
        const Rollout::Shape& shape, std::size_t index)
      : actor(spec, options, shape.state_size),
        rollout(shape),
        exploration(seed, shape.slots, index * shape.slots),
        order(
            {seed, 0, RngStream::kLearner, kFirstOrderStream + static_cast<std::uint32_t>(index)}) {
    if (options.shards > 1) prefix = "shard" + std::to_string(index) + ".";
  }

  /// Sets the results that the next calls of Act, Label and Finish read.
  /// @param results of the farms of this shard; must stay valid until the next Observe
  void Observe(const StepResults& results);
  /// Chooses actions and records them.
  void Act(ActorCritic& network);
  /// Records the teacher's actions at the step that Act has just recorded.
  void Label(Teacher& teacher);
  /// Finishes a full rollout with the values of the observations after its last step.
  void Finish(ActorCritic& network, const PpoOptions& options);
  void Save(Checkpoint& checkpoint) const;
  void Load(const Checkpoint& checkpoint);
  template <typename Self, typename Visit>
  static void VisitNumbers(Self& self, const Visit& visit);  // the saved numbers, by name

  Actor actor;
  Rollout rollout;
  AgentRng exploration;
  RandomStream order;  // draws the order of the samples
  std::uint64_t farm_steps{};
  StepResults results;        // copy of this shard's results if its process has several shards
  const StepResults* seen{};  // the results set by Observe
  std::vector<TokenSymmetry> symmetries;  // all symmetries; empty without augmentation
  std::vector<std::uint8_t> symmetry;     // by slot: symmetry of the present episode
  StepResults turned;                     // the results with turned tokens
  std::vector<std::uint8_t> actions;
  std::vector<std::uint8_t> labels;  // the teacher's actions
  std::vector<float> log_probs;
  std::string prefix;  // prefix of its sections in a checkpoint; empty if options.shards is 1
};

void Shard::Observe(const StepResults& observed) {
  seen = &observed;
  if (symmetries.empty()) return;
  turned = observed;
  const std::size_t agents = rollout.shape().agents;
  const std::size_t features = rollout.shape().features;
  for (std::size_t i = 0; i < symmetry.size(); ++i) {
    if (observed.is_first[i / agents] != 0) {
      symmetry[i] = static_cast<std::uint8_t>(exploration[i].Below(kSymmetries));
    }
    const TokenSymmetry& by = symmetries[symmetry[i]];
    by.Turn(observed.features.data() + i * features, turned.features.data() + i * features);
    turned.legal[i] = by.Turn(observed.legal[i]);
  }
  seen = &turned;
}

void Shard::Act(ActorCritic& network) {
  actor.Observe(network, *seen);
  actor.Sample(exploration, actions);
  const ActionDistribution& distribution = actor.distribution();
  log_probs.resize(actions.size());
  for (std::size_t i = 0; i < actions.size(); ++i) {
    log_probs[i] = distribution.log_probs(static_cast<Eigen::Index>(i), actions[i]);
  }
  rollout.Add(*seen, actor.masks(), actions, log_probs, actor.values(), actor.state_before());
  for (std::size_t i = 0; i < symmetry.size(); ++i) {
    actions[i] = symmetries[symmetry[i]].TurnBack(actions[i]);
  }
}

void Shard::Label(Teacher& teacher) {
  teacher.Act(*seen, actor.masks(), labels);
  for (std::size_t i = 0; teacher.sees_farms() && i < symmetry.size(); ++i) {
    labels[i] = symmetries[symmetry[i]].Turn(labels[i]);
  }
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if ((actor.masks()[i] >> labels[i] & 1U) == 0) labels[i] = kNoLabel;
  }
  rollout.SetLabels(labels);
}

void Shard::Finish(ActorCritic& network, const PpoOptions& options) {
  // After the update, Act observes the same results again with the new weights. It must start from
  // the same recurrent states.
  const std::vector<float> state = actor.state();
  actor.Observe(network, *seen);
  actor.state() = state;
  rollout.Finish(actor.values(), static_cast<float>(options.gamma),
                 static_cast<float>(options.gae_lambda));
}

template <typename Self, typename Visit>
void Shard::VisitNumbers(Self& self, const Visit& visit) {
  visit("order", self.order);
  visit("farm_steps", self.farm_steps);
}

void Shard::Save(Checkpoint& checkpoint) const {
  Checkpoint own;
  rollout.Save(own);
  exploration.Save(own);
  SaveNumbers(own, "ppo.progress", [this](const auto& visit) { VisitNumbers(*this, visit); });
  own.SetArray("ppo.state", actor.state());
  if (!symmetry.empty()) own.SetArray("ppo.symmetry", symmetry);
  checkpoint.AddPart(prefix, std::move(own));
}

void Shard::Load(const Checkpoint& checkpoint) {
  const Checkpoint own = checkpoint.Part(prefix);
  std::vector<float> state;
  LoadNumbers<std::uint64_t>(own, "ppo.progress", "ppo.rng",
                             [this](const auto& visit) { VisitNumbers(*this, visit); });
  own.GetArray("ppo.state", actor.state().size(), state);
  std::vector<std::uint8_t> turned_by;
  if (!symmetry.empty()) own.GetArray("ppo.symmetry", symmetry.size(), turned_by);
  for (const std::uint8_t one : turned_by) {
    if (one < kSymmetries) continue;
    throw InputError("ppo.symmetry: got " + std::to_string(one) + ", expected at most " +
                     std::to_string(kSymmetries - 1) + ": damaged, resume from another checkpoint");
  }
  rollout.Load(own);
  exploration.Load(own);
  actor.state() = std::move(state);
  symmetry = std::move(turned_by);
}

std::uint8_t ObservationTypesOf(const PpoOptions& options) {
  const bool plans = options.HasTeacher() && options.teacher_policy == TeacherPolicy::kPlanner;
  return plans ? kFeaturesBit | kStatesBit : kFeaturesBit;
}

class PpoLearner final : public ShardedLearner, public WarmStart {
 public:
  /// @param spec spec of the farms of this process
  PpoLearner(const EnvironmentSpec& spec, std::uint64_t seed, const PpoOptions& options,
             std::string resolved, ProcessGroup* group, PlannerMaker make_planner)
      : spec_(spec),
        options_(options),
        resolved_(std::move(resolved)),
        local_(LocalShards(options, spec.farms, group)),
        network_(MakeActorCritic(spec, options, seed)),
        updater_(options, *network_, local_.count, group),
        entropy_(options.shards > 1 ? updater_.entropy() : 0.0F) {
    EnvironmentSpec one = spec;
    one.farms = local_.farms;
    const std::size_t total = SlotCount(one) * static_cast<std::size_t>(options.shards);
    const Rollout::Shape shape = RolloutShape(one, options, network_->state_size(), total);
    shards_.reserve(local_.count);
    for (std::size_t i = 0; i < local_.count; ++i) {
      shards_.emplace_back(one, seed, options, shape, local_.first + i);
    }
    if (options.HasTeacher()) teacher_ = MakeTeacher(one, options.teacher_policy, make_planner);
    if (!HasTokens(spec)) return;
    for (Shard& shard : shards_) {
      if (!options.augment) break;
      shard.symmetries = AllSymmetries(LayoutOfTokens(spec.feature_names));
      shard.symmetry.resize(shape.slots);
    }
  }

  std::uint8_t observation_types() const override { return ObservationTypesOf(options_); }
  std::string options() const override { return resolved_; }
  std::uint32_t sync_interval() const override {
    return options_.shards == 1 ? 1
                                : static_cast<std::uint32_t>(shards_.front().rollout.shape().steps);
  }
  void Step(const StepResults& results, double progress,
            std::vector<std::uint8_t>& actions) override;
  LearnerStatus status() const override {
    return {updater_.value_error(), entropy_, static_cast<float>(updater_.learning_rate())};
  }
  std::unique_ptr<Policy> GreedyPolicy() const override {
    return std::make_unique<PpoPolicy>(spec_, options_, PolicyWeights(*network_));
  }
  void SavePolicy(Checkpoint& checkpoint) const override {
    checkpoint.SetArray("weights", PolicyWeights(*network_));
  }
  void Save(Checkpoint& checkpoint) const override;
  void Load(const Checkpoint& checkpoint) override;
  void LoadWeights(const Checkpoint& checkpoint) override {
    CheckFeaturesFit(checkpoint, spec_);  // the number of agents may differ: they share a network
    ReplaceWeights(checkpoint, *network_);
  }

 private:
  const StepResults& ResultsOf(std::size_t shard, const StepResults& results);
  void Update(double progress);
  bool IsTaught(const Rollout& rollout, double progress) const;

  const EnvironmentSpec spec_;
  const PpoOptions options_;
  const std::string resolved_;
  const ShardRange local_;
  const std::unique_ptr<ActorCritic> network_;
  PpoUpdater updater_;
  std::unique_ptr<Teacher> teacher_;  // null without a teacher
  std::vector<Shard> shards_;         // of this process
  // Mean entropy of the policy: at the last step with one shard, else in the last update.
  float entropy_{};
};

// Returns the results of one shard of this process. Copies them only if there are several shards.
const StepResults& PpoLearner::ResultsOf(std::size_t shard, const StepResults& results) {
  if (shards_.size() == 1) return results;
  const auto farms = static_cast<std::size_t>(local_.farms);
  CopyFarms(results, shard * farms, farms, shards_[shard].results);
  return shards_[shard].results;
}

void PpoLearner::Step(const StepResults& results, double progress,
                      std::vector<std::uint8_t>& actions) {
  Rollout::Rewards rewards;
  rewards.scale = static_cast<float>(options_.reward_scale);
  // With a team reward, the reward of each agent is already the sum.
  if (!spec_.team_reward) rewards.team_share = static_cast<float>(options_.team_share.At(progress));
  for (std::size_t i = 0; i < shards_.size(); ++i) {
    const StepResults& own = ResultsOf(i, results);
    shards_[i].farm_steps += FarmSteps(own);
    shards_[i].rollout.Complete(own, rewards);
    shards_[i].Observe(own);
  }
  if (shards_.front().rollout.IsFull()) Update(progress);
  actions.clear();
  for (Shard& shard : shards_) {
    shard.Act(*network_);
    if (IsTaught(shard.rollout, progress)) shard.Label(*teacher_);
    actions.insert(actions.end(), shard.actions.begin(), shard.actions.end());
  }
  entropy_ = options_.shards == 1 ? shards_.front().actor.distribution().entropies.mean()
                                  : updater_.entropy();
}

// Returns whether the teacher labels the last recorded step.
bool PpoLearner::IsTaught(const Rollout& rollout, double progress) const {
  if (teacher_ == nullptr || options_.teacher.At(progress) <= 0.0) return false;
  const std::size_t step = rollout.recorded_steps() - 1;
  return step % static_cast<std::size_t>(options_.teacher_interval) == 0;
}

void PpoLearner::Update(double progress) {
  std::vector<PpoUpdater::Input> inputs;
  PpoUpdater::Context context{progress, 0};
  for (Shard& shard : shards_) {
    shard.Finish(*network_, options_);
    inputs.push_back({&shard.rollout, &shard.order});
    context.farm_steps += shard.farm_steps;
  }
  updater_.Update(inputs, context);
  for (Shard& shard : shards_) shard.rollout.Clear();
}

void PpoLearner::Save(Checkpoint& checkpoint) const {
  updater_.Save(checkpoint);
  checkpoint.SetArray("ppo.entropy", std::vector<float>{entropy_});
  for (const Shard& shard : shards_) shard.Save(checkpoint);
}

void PpoLearner::Load(const Checkpoint& checkpoint) {
  std::vector<float> entropy;
  checkpoint.GetArray("ppo.entropy", 1, entropy);
  updater_.Load(checkpoint);
  for (Shard& shard : shards_) shard.Load(checkpoint);
  entropy_ = entropy[0];
  updater_.set_entropy(entropy_);
}

std::uint8_t ObservationTypesOf(const std::string& options, bool central) {
  std::string resolved;
  return ObservationTypesOf(PpoOptions::Parse(options, resolved, central));
}

/// @param central true for MAPPO, false for PPO
/// @param group process group of the rank; nullptr: this process has all shards
std::unique_ptr<PpoLearner> MakeLearner(const EnvironmentSpec& spec, std::uint64_t seed,
                                        const std::string& text, bool central, ProcessGroup* group,
                                        PlannerMaker make_planner) {
  std::string resolved;
  const PpoOptions options = PpoOptions::Parse(text, resolved, central);
  if (group != nullptr && options.exploration.is_curious()) {
    throw InputError("exploration: got " + ToString(options.exploration) + " with " +
                     std::to_string(group->size()) +
                     " ranks, expected one without icm: curiosity learns in one process");
  }
  PrepareTorch(options.threads);
  return std::make_unique<PpoLearner>(spec, seed, options, resolved, group, make_planner);
}

}  // namespace

std::uint8_t PpoObservationTypes(const std::string& options) {
  return ObservationTypesOf(options, false);
}
std::uint8_t MappoObservationTypes(const std::string& options) {
  return ObservationTypesOf(options, true);
}

std::unique_ptr<Learner> MakePpo(const EnvironmentSpec& spec, std::uint64_t seed,
                                 const std::string& options, PlannerMaker make_planner) {
  return MakeLearner(spec, seed, options, false, nullptr, make_planner);
}
std::unique_ptr<Learner> MakeMappo(const EnvironmentSpec& spec, std::uint64_t seed,
                                   const std::string& options, PlannerMaker make_planner) {
  return MakeLearner(spec, seed, options, true, nullptr, make_planner);
}

std::unique_ptr<ShardedLearner> MakePpoOfRanks(const EnvironmentSpec& spec, std::uint64_t seed,
                                               const std::string& options, ProcessGroup& group,
                                               PlannerMaker make_planner) {
  return MakeLearner(spec, seed, options, false, &group, make_planner);
}
std::unique_ptr<ShardedLearner> MakeMappoOfRanks(const EnvironmentSpec& spec, std::uint64_t seed,
                                                 const std::string& options, ProcessGroup& group,
                                                 PlannerMaker make_planner) {
  return MakeLearner(spec, seed, options, true, &group, make_planner);
}

std::unique_ptr<Policy> MakePpoPolicy(const Checkpoint& checkpoint, const EnvironmentSpec& spec) {
  std::string resolved;
  const bool central = checkpoint.algorithm == kMappo;
  PrepareTorch(PpoOptions::Parse(checkpoint.options, resolved, central).threads);
  return MakePpoPolicyWithoutTorch(checkpoint, spec);
}

}  // namespace aquafarm::agents
