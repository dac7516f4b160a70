// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Makes the plan again with one input changed: ships, departure, ports or capacity.

#include <string>
#include <vector>

#include "aquafarm/agents/rescue/rescue_plan.h"

namespace aquafarm::agents {

struct WhatIf {
  std::string
      change;  ///< for programs: none, ships+1, ships-1, depart+3h, port_closed:2, capacity+1
  std::string text;
  bool is_possible{true};
  LossSummary loss;
  double devices_home{};    ///< mean number
  double all_home{};        ///< probability
  double difference{};      ///< mean loss minus that of the plan, over the same members
  double difference_low{};  ///< 95 % interval of it
  double difference_high{};
};

/// Returns the plan itself first, then the changes, smallest mean loss first, impossible ones last.
std::vector<WhatIf> CompareChanges(const RescueProblem& problem, const Ensemble& ensemble,
                                   const RescuePlan& plan);

}  // namespace aquafarm::agents
