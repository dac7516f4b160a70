// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm::agents {

/// Exit codes of the C++ programs and nodes of this package. aquafarm_plan also has the exit codes
/// of PlanResult (rescue/plan_report.h). bag_policy exits with 1 if a recording differs from its
/// simulation.
///
/// If a training on one rank ends with kLost, it is saved. With several ranks, or after a deadlock
/// in roscpp, only the last checkpoint is kept.
enum class ExitCode : int {
  kOk = 0,
  kInternal = 1,      ///< a bug in the suite
  kBadInput = 2,      ///< an argument, scenario, policy or checkpoint was refused
  kStorage = 3,       ///< a file cannot be written, or the run folder is in use
  kLost = 4,          ///< farms did not respond, refused a call or were changed by another client
  kDiverged = 5,      ///< learning failed; the last valid checkpoint is kept
  kRankLost = 6,      ///< another rank is missing or has ended; checkpoints are kept
  kInterrupted = 130  ///< stopped with Ctrl-C or SIGTERM; a training run is saved
};

}  // namespace aquafarm::agents
