// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm::agents {

/// Exit codes of the programs of this package. aquafarm_plan also has those of PlanResult
/// (rescue/plan_report.h).
enum class ExitCode : int {
  kOk = 0,
  kInternal = 1,      ///< a bug in the suite
  kBadInput = 2,      ///< an argument, scenario, policy or checkpoint was refused
  kStorage = 3,       ///< a file cannot be written, or the run folder is in use
  kLost = 4,          ///< the farms were unreachable for too long; a training on one rank is saved
  kDiverged = 5,      ///< learning failed; the last valid checkpoint is kept
  kRankLost = 6,      ///< another rank is missing or has ended; checkpoints are kept
  kInterrupted = 130  ///< stopped with Ctrl-C or SIGTERM; a training run is saved
};

}  // namespace aquafarm::agents
