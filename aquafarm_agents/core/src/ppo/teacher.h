// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A policy that PPO imitates (*kickstarting*, Schmitt et al. 2018, arXiv:1803.03835). The learner
/// chooses all actions that are executed. At labelled steps (PpoOptions::teacher_interval) the
/// teacher also chooses the actions that it would take (as in DAgger, Ross et al. 2011). ppo_loss.h
/// has the loss.

#include <cstdint>
#include <memory>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/ppo/ppo.h"
#include "aquafarm/agents/ppo/ppo_options.h"

namespace aquafarm::agents {

class Teacher {
 public:
  virtual ~Teacher() = default;

  /// Chooses actions. They depend only on the arguments, so a resumed training gets the same ones.
  /// @param allowed [N, S] masks of the allowed actions
  /// @param actions is resized to [N, S]; an action may be outside `allowed`
  virtual void Act(const StepResults& results, const std::vector<ActionMask>& allowed,
                   std::vector<std::uint8_t>& actions) = 0;
  /// Returns whether the teacher reads StepResults::states instead of the features. Data
  /// augmentation does not transform states, so the caller must transform the teacher's actions.
  virtual bool sees_farms() const = 0;
};

/// Makes the teacher of PpoOptions::teacher_policy.
/// @param make_planner must not be null for TeacherPolicy::kPlanner
/// @throws InputError if the rule is selected and the features are not entity tokens, or if the
///   planner does not support the farms
std::unique_ptr<Teacher> MakeTeacher(const EnvironmentSpec& spec, TeacherPolicy which,
                                     PlannerMaker make_planner);

}  // namespace aquafarm::agents
