// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/training/algorithms.h"

namespace aquafarm::agents {

/// A learner and its farms, which run in one thread.
class TrainingLoop {
 public:
  /// @param first_steps number of steps that the constructor takes. The first update must be due in
  ///   the next step or earlier, so that every measurement includes updates
  TrainingLoop(const char* algorithm, const std::string& options,
               std::shared_ptr<const Scenario> scenario, std::int32_t farms, int first_steps)
      : environment_(std::move(scenario),
                     {farms, FindAlgorithm(algorithm).observation_types(options), false, 1}),
        learner_(FindAlgorithm(algorithm).make(environment_.spec(), 1, options)),
        results_(&environment_.Reset(1)) {
    Run(first_steps);
  }

  /// Takes `steps` steps, at progress 0.3 of the schedules.
  void Run(int steps) {
    for (int i = 0; i < steps; ++i) {
      learner_->Step(*results_, 0.3, actions_);
      results_ = &environment_.Step(actions_);
    }
  }

 private:
  LocalEnvironment environment_;
  std::unique_ptr<Learner> learner_;
  const StepResults* results_;
  std::vector<std::uint8_t> actions_;
};

}  // namespace aquafarm::agents
