// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A number that changes as training proceeds, over progress in [0, 1]:
///
///   constant     start ----------------------
///   linear       start \                          over the first `share` of the run
///                       \_________ end
///   exponential  start · (end/start)^(progress/share), then end
///   harmonic     start / (1 + (start/end - 1) · progress/share), then end: falls soon, and goes on
///                falling like 1/t, as Robbins and Monro (1951) ask of a rate that ends all chance

#include <cstdint>
#include <string>
#include <string_view>

namespace aquafarm::agents {

enum class ScheduleKind : std::uint8_t { kConstant, kLinear, kExponential, kHarmonic };
inline constexpr int kScheduleKindCount = 4;
std::string_view ToString(ScheduleKind value);

struct Schedule {
  ScheduleKind kind{ScheduleKind::kConstant};
  double start{};
  double end{};       ///< not used when constant
  double share{1.0};  ///< of the run until `end` is reached, (0, 1]; not used when constant

  /// @param progress of the run, [0, 1]
  double At(double progress) const;
};

/// Reads "0.1", "linear:1:0.05:0.5" or "exponential:10:0.5:0.5" (kind:start:end:share).
/// @param what stands first in messages, such as "learning_rate"
/// @throws InputError when it is none of these or a number is not in [min, max]; an exponential
///         or harmonic one needs start and end above 0
Schedule ParseSchedule(const std::string& text, const std::string& what, double min, double max);

/// The text that ParseSchedule reads back to the same.
std::string ToString(const Schedule& schedule);

}  // namespace aquafarm::agents
