// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/trainer.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/learning/sharded_learner.h"
#include "aquafarm/base/cbor.h"
#include "aquafarm/base/check.h"
#include "training/pending_steps.h"

namespace aquafarm::agents {
namespace {

double Seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

constexpr std::uint32_t kStepsPerLookAtTheClock = 16;

std::uint32_t SyncInterval(const Learner& learner) {
  const auto* const sharded = dynamic_cast<const ShardedLearner*>(&learner);
  return sharded == nullptr ? 1 : sharded->sync_interval();
}

}  // namespace

Trainer::Trainer(Environment& environment, Learner& learner, const TrainerOptions& options,
                 RunFolder* folder)
    : environment_(environment),
      learner_(learner),
      options_(options),
      folder_(folder),
      sync_interval_(SyncInterval(learner)),
      pending_(std::make_unique<PendingSteps>()) {
  if (options_.group != nullptr) AQUAFARM_CHECK_LT(1U, sync_interval_);  // ranks need shards
  if (options_.episodes == 0 && options_.steps == 0) {
    throw InputError("steps, episodes: got 0 for both, expected a limit");
  }
  if ((options_.seed & kEvaluationSeedBit) != 0) {
    throw InputError("seed: got " + std::to_string(options_.seed) +
                     ", expected less than 2^63; larger seeds are for evaluation");
  }
  progress_.episode_limit = options_.episodes;
  progress_.step_limit = options_.steps;
  Summarise();
}

Trainer::~Trainer() = default;

double Trainer::Done() const {
  const auto share = [](std::uint64_t done, std::uint64_t limit) {
    return limit == 0 ? 0.0 : static_cast<double>(done) / static_cast<double>(limit);
  };
  return std::min(1.0, std::max(share(progress_.steps, options_.steps),
                                share(progress_.episodes, options_.episodes)));
}

bool Trainer::IsDone() const { return Done() >= 1.0; }

void Trainer::Resume(const Checkpoint& checkpoint, const std::string& path) {
  CheckContinues(checkpoint, path, options_.algorithm, learner_.options(), options_.seed,
                 WholeSpec(environment_.spec(), options_.group));
  try {
    const auto state = ParseCbor(checkpoint.Section("trainer"), "section 'trainer'");
    learner_.Load(checkpoint);
    checkpoint.GetArray("returns", returns_.size(), returns_);
    checkpoint.GetArray("successes", successes_.size(), successes_);
    progress_.steps = checkpoint.steps;
    progress_.episodes = checkpoint.episodes;
    progress_.best_mean_return = state.at("best_mean_return").is_null()
                                     ? std::nanf("")
                                     : state.at("best_mean_return").get<float>();
    state.at("next_episode").get_to(next_episode_);
    if (folder_ != nullptr) {
      metrics_ = std::make_unique<MetricsFile>(folder_->metrics_path(),
                                               state.at("metrics_bytes").get<std::uint64_t>());
    }
    // The section is missing if the farms were lost when the checkpoint was saved.
    if (checkpoint.Has("environment")) {
      results_ = &environment_.Load(std::string(checkpoint.Section("environment")));
    }
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  } catch (const nlohmann::json::exception& error) {
    throw InputError(path + ": damaged: " + error.what());
  }
  Summarise();
}

TrainingEnd Trainer::Run(const std::atomic<bool>* stop, const OnProgress& on_progress) {
  TrainingEnd end = TrainingEnd::kDone;
  try {
    Train(stop, on_progress);
    if (!IsDone()) end = TrainingEnd::kInterrupted;
    if (!is_saved_) Save(true);  // also flushes the metrics
  } catch (const EnvironmentLost& error) {
    message_ = error.what();
    end = TrainingEnd::kLost;
  } catch (const StorageError& error) {
    message_ = error.what();
    end = TrainingEnd::kStorage;
  } catch (const RankLost& error) {
    message_ = error.what();
    end = TrainingEnd::kRankLost;
  } catch (const LearnerFailed& error) {
    message_ = error.what();
    end = TrainingEnd::kDiverged;
  } catch (const InputError& error) {
    message_ = error.what();
    // If this process trains alone, the farms count as lost, for example because they came back
    // with another scenario. With several ranks the error is reported as wrong input.
    end = options_.group == nullptr ? TrainingEnd::kLost : TrainingEnd::kBadInput;
  }
  // With several ranks nothing is saved here: the other ranks are not informed of the error, so
  // this rank must not exchange anything more.
  if (end == TrainingEnd::kLost && options_.group == nullptr) {
    SaveWithoutFarms();
    // Ctrl-C also stops farms that were started by the same launch file.
    if (stop != nullptr && *stop) end = TrainingEnd::kInterrupted;
  }
  Report(on_progress);
  return end;
}

void Trainer::SaveWithoutFarms() {
  try {
    CountPending({*pending_});
    pending_->Clear();
    CountRestarts();
    Save(false);
  } catch (const StorageError& error) {
    message_ += std::string("; ") + error.what();
  }
}

void Trainer::Begin() {
  if (folder_ != nullptr && !metrics_) {
    metrics_ = std::make_unique<MetricsFile>(folder_->metrics_path());
  }
  if (results_ == nullptr) {
    results_ = &environment_.Reset(options_.seed, next_episode_);
    next_episode_ +=
        static_cast<std::uint64_t>(WholeSpec(environment_.spec(), options_.group).farms);
  }
  start_ = reported_ = saved_ = Clock::now();
  reported_steps_ = progress_.steps;
  done_at_start_ = Done();
}

void Trainer::Train(const std::atomic<bool>* stop, const OnProgress& on_progress) {
  Begin();
  Report(on_progress);
  std::uint32_t calls = 0;
  // With several shards the training stops only at a synchronization, so that all ranks stop at the
  // same step.
  bool stops = sync_interval_ == 1 && stop != nullptr && *stop;
  while (!IsDone() && !stops) {
    is_saved_ = false;
    learner_.Step(*results_, Done(), actions_);
    results_ = &environment_.Step(actions_);
    if (environment_.ConsumeRestart()) ++uncounted_restarts_;
    if (sync_interval_ > 1) {
      pending_->Add(*results_);
      if (pending_->calls() < sync_interval_) continue;
      stops = Synchronize(stop);
    } else {
      Count(*results_);
      stops = stop != nullptr && *stop;
      if (++calls % kStepsPerLookAtTheClock != 0) continue;
      if (IsDue(saved_, options_.checkpoint_period_s)) Save(true);
    }
    if (IsDue(reported_, options_.progress_period_s)) {
      if (metrics_) metrics_->Flush();
      Report(on_progress);
    }
  }
}

bool Trainer::IsDue(Clock::time_point last, double period_s) {
  return Seconds(Clock::now() - last) >= period_s;
}

void Trainer::Count(const StepResults& results) {
  std::uint32_t starts = 0;
  for (const std::uint8_t flag : results.is_first) starts += flag;
  progress_.steps += results.is_first.size() - starts;
  for (const EpisodeSummary& result : results.finished) CountEpisode(result);
  CountRestarts();
}

// Counts restarts of the farms. Must be called after the episodes that ended before the restarts
// have been counted.
void Trainer::CountRestarts() {
  if (uncounted_restarts_ == 0) return;
  progress_.restarts += uncounted_restarts_;
  next_episode_ += std::uint64_t{uncounted_restarts_} *
                   static_cast<std::uint64_t>(WholeSpec(environment_.spec(), options_.group).farms);
  uncounted_restarts_ = 0;
  notice_ =
      "the connection to the farms was lost and restored; training continues with new episodes";
}

void Trainer::CountEpisode(const EpisodeSummary& result) {
  const std::size_t slot = progress_.episodes % returns_.size();
  returns_[slot] = result.episode_return;
  successes_[slot] = result.Success() ? 1 : 0;
  ++progress_.episodes;
  const std::int32_t ranks = options_.group == nullptr ? 1 : options_.group->size();
  const auto farms = static_cast<std::uint64_t>(environment_.spec().farms * ranks);
  // The farm's next episode has the number result.episode + farms.
  next_episode_ = std::max(next_episode_, result.episode + farms + 1);
  progress_.last_return = result.episode_return;
  if (progress_.episodes >= returns_.size()) {
    float sum = 0.0F;
    for (const float one : returns_) sum += one;
    const float mean = sum / static_cast<float>(returns_.size());
    if (!(mean <= progress_.best_mean_return)) progress_.best_mean_return = mean;
  }
  if (metrics_) metrics_->Append(progress_.episodes, progress_.steps, result, learner_.status());
}

void Trainer::Summarise() {
  const std::size_t count = std::min<std::uint64_t>(progress_.episodes, returns_.size());
  if (count == 0) {
    progress_.last_return = progress_.mean_return = std::nanf("");
    progress_.best_mean_return = progress_.success_rate = std::nanf("");
  } else {
    float sum = 0.0F;
    float successes = 0.0F;
    for (std::size_t i = 0; i < count; ++i) {
      sum += returns_[i];
      successes += static_cast<float>(successes_[i]);
    }
    progress_.last_return = returns_[(progress_.episodes - 1) % returns_.size()];
    progress_.mean_return = sum / static_cast<float>(count);
    progress_.success_rate = successes / static_cast<float>(count);
  }
  progress_.learner = learner_.status();
}

void Trainer::Report(const OnProgress& on_progress) {
  Summarise();
  const auto now = Clock::now();
  const double period = Seconds(now - reported_);
  progress_.elapsed_s = Seconds(now - start_);
  if (period > 0.1) {
    progress_.steps_per_second = static_cast<double>(progress_.steps - reported_steps_) / period;
    reported_steps_ = progress_.steps;
    reported_ = now;
  }
  const double done = Done() - done_at_start_;
  progress_.time_left_s = done > 0.0 ? progress_.elapsed_s / done * (1.0 - Done()) : -1.0;
  if (on_progress) on_progress(progress_);
}

void Trainer::Save(bool with_environment) {
  saved_ = Clock::now();
  if (folder_ == nullptr && options_.group == nullptr) return;
  Checkpoint checkpoint;
  checkpoint.lends = options_.group == nullptr;  // CollectSections needs copies
  checkpoint.kind = Checkpoint::kTraining;
  checkpoint.algorithm = options_.algorithm;
  checkpoint.options = learner_.options();
  checkpoint.spec = WholeSpec(environment_.spec(), options_.group);
  checkpoint.version = checkpoint.spec.version;
  checkpoint.seed = options_.seed;
  checkpoint.steps = progress_.steps;
  checkpoint.episodes = progress_.episodes;
  learner_.Save(checkpoint);
  if (with_environment) checkpoint.sections["environment"] = environment_.Save();
  is_saved_ = with_environment;
  const bool writes = CollectSections(checkpoint) && folder_ != nullptr;
  RunOnce(options_.group, [&] {
    if (writes) Write(checkpoint);
  });
}

void Trainer::Write(Checkpoint& checkpoint) {
  metrics_->Sync();
  const nlohmann::json state{
      {"next_episode", next_episode_},
      {"metrics_bytes", metrics_->size()},
      {"best_mean_return", std::isnan(progress_.best_mean_return)
                               ? nlohmann::json()
                               : nlohmann::json(progress_.best_mean_return)}};
  nlohmann::json::to_cbor(state, checkpoint.sections["trainer"]);
  checkpoint.SetArray("returns", returns_);
  checkpoint.SetArray("successes", successes_);
  folder_->SaveCheckpoint(checkpoint);
}

}  // namespace aquafarm::agents
