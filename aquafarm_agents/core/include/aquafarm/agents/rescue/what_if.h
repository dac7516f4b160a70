// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Compares a plan with the plans for one changed input: number of ships, departure, ports or
/// capacity.

#include <string>
#include <vector>

#include "aquafarm/agents/rescue/rescue_plan.h"

namespace aquafarm::agents {

/// The plan for one changed input, compared with the original plan.
struct WhatIf {
  /// Identifier for programs: `none` for the original plan, else for example `ships+1`, `ships-1`,
  /// `depart+3h`, `port_closed:2` or `capacity+1`.
  std::string change;
  std::string text;         ///< the change in words
  bool is_possible{true};   ///< false: there is no such plan, and the numbers are not set
  LossSummary loss;         ///< loss of the changed plan
  double devices_home{};    ///< mean number of devices that come home
  double all_home{};        ///< probability that all devices come home
  double difference{};      ///< mean loss minus the mean loss of the original plan
  double difference_low{};  ///< bounds of the 95 % interval of `difference`
  double difference_high{};
};

/// Returns one element for the original plan, then the possible changes in the order of increasing
/// mean loss, then the impossible changes.
/// @param plan the plan for `problem` and `ensemble`
std::vector<WhatIf> CompareChanges(const RescueProblem& problem, const Ensemble& ensemble,
                                   const RescuePlan& plan);

}  // namespace aquafarm::agents
