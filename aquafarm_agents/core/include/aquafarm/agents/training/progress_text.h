// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Texts about the progress of a training.

#include <cstdint>
#include <string>

#include "aquafarm/agents/training/trainer.h"

namespace aquafarm::agents {

/// Returns a number with thousands separators: "3,000,000".
std::string FormatCount(std::uint64_t value);

/// Returns a line such as "steps 812,000 / 3,000,000  episodes 1,240  return 81.2  …  left 1.2 s".
std::string DescribeProgress(const TrainingProgress& progress);

/// Returns a line such as "last 50    return 81.2, success 90.0 % (exploring); best mean
/// return 85.0". With fewer episodes than TrainingProgress::kWindow there is no best mean. At least
/// one episode must have ended.
std::string DescribeReturns(const TrainingProgress& progress);

}  // namespace aquafarm::agents
