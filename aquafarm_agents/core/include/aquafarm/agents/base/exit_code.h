// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm::agents {

/// How the programs of this package end.
enum class ExitCode : int {
  kOk = 0,
  kInternal = 1,      ///< a fault of the suite
  kBadInput = 2,      ///< an argument, scenario, policy or checkpoint was refused
  kStorage = 3,       ///< run folder in use, not writable, or disk full
  kLost = 4,          ///< the farms were lost and did not come back in time; saved
  kDiverged = 5,      ///< learning failed; the last good checkpoint is kept
  kInterrupted = 130  ///< Ctrl-C; saved
};

}  // namespace aquafarm::agents
