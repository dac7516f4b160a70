// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Base class of DQN, LSTM-DQN and MADDPG. A step adds the results to the replay buffer, makes the
/// due updates and chooses actions.

#include <string>
#include <utility>
#include <vector>

#include "aquafarm/agents/learning/exploration.h"
#include "aquafarm/agents/learning/learner.h"
#include "aquafarm/agents/learning/replay.h"
#include "networks/deep_policy.h"
#include "networks/replay_sampler.h"

namespace aquafarm::agents {

/// Settings of the base class.
struct ReplayLearnerOptions {
  ExplorationOptions exploration;
  double value_scale{1.0};  ///< see the constructor of Explorer
  ReplayOptions replay;
  DeepOptions sampling;  ///< uses only batch_size, priority_exponent and importance_exponent
  std::size_t steps{1};  ///< number of later time steps that a sample needs
  std::size_t group{1};  ///< number of agents of a sample; see ReplaySampler
};

/// @tparam Scalar type of an observation's values: float features, or bytes of planes
template <typename Scalar>
class ReplayLearner : public Learner {
 public:
  std::string options() const final { return resolved_; }
  void Step(const StepResults& results, double progress, std::vector<std::uint8_t>& actions) final {
    progress_ = progress;
    replay_.Add(results, ObservationTraits<Scalar>::Of(results), RecurrentStates(results));
    sampler_.Add();
    CountSteps(FarmSteps(results));
    while (TakeDue()) {
      if (sampler_.IsReady() && CanSample()) Update();
    }
    explorer_.SetProgress(progress);
    actions.resize(results.legal.size());
    Choose(results, actions);
    replay_.SetActions(actions);
  }
  void Save(Checkpoint& checkpoint) const final {
    SaveOwn(checkpoint);
    replay_.Save(checkpoint);
    sampler_.Save(checkpoint);
    explorer_.Save(checkpoint);
  }
  void Load(const Checkpoint& checkpoint) final {
    LoadOwn(checkpoint);
    replay_.Load(checkpoint);
    sampler_.Load(checkpoint);
    explorer_.Load(checkpoint);
  }

 protected:
  ReplayLearner(const EnvironmentSpec& spec, std::uint64_t seed, std::string resolved,
                torch::Device device, const ReplayLearnerOptions& options)
      : spec_(spec),
        seed_(seed),
        resolved_(std::move(resolved)),
        device_(device),
        explorer_(options.exploration, seed, SlotCount(spec), options.value_scale),
        rng_({seed, 0, RngStream::kLearner, 1}),
        replay_(options.replay),
        sampler_(replay_, options.sampling, options.steps, options.group) {}

  /// Returns the recurrent states of all agents before this step, [slots, recurrent_size]. They are
  /// zero where an episode starts. Returns null if the network is not recurrent.
  virtual const float* RecurrentStates(const StepResults&) { return nullptr; }
  /// Counts farm steps. They determine the number of due updates.
  virtual void CountSteps(std::uint64_t farm_steps) = 0;
  /// Consumes one due update. @returns false if no update is due
  virtual bool TakeDue() = 0;
  /// Returns whether the replay has enough time steps for a sample.
  virtual bool CanSample() const { return true; }
  /// Samples a batch and learns from it.
  virtual void Update() = 0;
  /// Chooses the exploratory actions. @param actions receives them, [slots]
  virtual void Choose(const StepResults& results, std::vector<std::uint8_t>& actions) = 0;
  /// Saves the state of the derived class, and the position of `rng_`.
  virtual void SaveOwn(Checkpoint& checkpoint) const = 0;
  /// Restores the state saved by SaveOwn. @throws InputError if sections are missing or do not fit
  virtual void LoadOwn(const Checkpoint& checkpoint) = 0;

  /// Returns `values` on the device, as a tensor of `shape`. On the CPU the tensor refers to
  /// `values` without a copy.
  template <typename T>
  torch::Tensor ToDevice(std::vector<T>& values, std::vector<std::int64_t> shape) const {
    return torch::from_blob(values.data(), shape, torch::CppTypeToScalarType<T>::value).to(device_);
  }

  const EnvironmentSpec spec_;
  const std::uint64_t seed_;
  const std::string resolved_;
  const torch::Device device_;
  Explorer explorer_;
  RandomStream rng_;  // draws the samples
  Replay<Scalar> replay_;
  ReplaySampler<Scalar> sampler_;
  double progress_{};
};

}  // namespace aquafarm::agents
