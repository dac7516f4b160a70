// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Ranges of the values of a scenario's keys, and limits of its lists; part of schema.h.

#include "aquafarm/scenario/limits.h"
#include "scenario/domains.h"

namespace aquafarm::internal {

enum class Need : std::uint8_t { kOptional, kRequired };

inline constexpr std::size_t kMaxListed = 100000;     ///< max number of island blocks or rocks
inline constexpr std::size_t kMaxSeaValues = 200000;  ///< limits a file to a few MB
inline constexpr std::size_t kMaxLayers = 16;
inline constexpr std::size_t kMaxWaypoints = 10000;
inline constexpr std::size_t kMaxLeads = 8;
inline constexpr std::size_t kMaxArchiveBytes = 2U << 20U;
inline constexpr std::int32_t kMaxDevices = 1000;
inline constexpr std::int32_t kMaxPorts = 256;
inline constexpr std::int32_t kMaxSteps = 10000000;  // below 2^24, so exact as a float
inline constexpr float kFar = 1.0e6F;                // [cells]

inline constexpr Interval<float> kShare{0.0F, 1.0F};
inline constexpr Interval<float> kRadius{0.0F, kFar};
inline constexpr Interval<float> kPlace{-kFar, kFar};
inline constexpr Interval<float> kStep{-static_cast<float>(kMaxSteps), kMaxSteps};
inline constexpr Interval<float> kRisk{kWorstRisk, kMildestRisk};
inline constexpr Interval<float> kPenalty{-1000.0F, 0.0F};
inline constexpr Interval<float> kReward{-10000.0F, 10000.0F};
inline constexpr Interval<float> kDeviceValue{0.0F, 10000.0F};
inline constexpr Interval<double> kAmount{0.0, 1.0e9};  // so that sums of cents are exact
inline constexpr Interval<std::int32_t> kGrade{1, 4};
inline constexpr Interval<std::int32_t> kAlong{0, kMaxSide - 1};
inline constexpr Interval<std::int32_t> kSide{1, kMaxSide};

}  // namespace aquafarm::internal
