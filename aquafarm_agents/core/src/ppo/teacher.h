// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A policy that PPO imitates at the start of a training (*kickstarting*, Schmitt et al. 2018,
/// arXiv:1803.03835; its loss: ppo_loss.h). The learner plays; the teacher chooses at each recorded
/// step what it would do there (as in DAgger, Ross et al. 2011).

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

  /// Chooses actions by the results alone, so that a resumed training has the same ones.
  /// @param allowed [N, S] @param actions is resized to [N, S]
  virtual void Act(const StepResults& results, const std::vector<ActionMask>& allowed,
                   std::vector<std::uint8_t>& actions) = 0;
  /// Returns whether it reads the farms, which are not turned, instead of the features.
  virtual bool sees_farms() const = 0;
};

/// @param make_planner not null for a planner
/// @throws InputError if the farms do not have what the teacher reads
std::unique_ptr<Teacher> MakeTeacher(const EnvironmentSpec& spec, TeacherPolicy which,
                                     PlannerMaker make_planner);

}  // namespace aquafarm::agents
