// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A parameter that varies with the training progress in [0, 1]:
///
///   constant     start ----------------------
///   linear       start \                          over the first `fraction` of the run
///                       \_________ end
///   exponential  start · (end/start)^(progress/fraction), then end
///   harmonic     start / (1 + (start/end - 1) · progress/fraction), then end: decays like 1/t, as
///                Robbins and Monro (1951) require of a learning rate that averages out the noise

#include <cstdint>
#include <string>
#include <string_view>

namespace aquafarm::agents {

/// How a value changes during a training.
enum class ScheduleKind : std::uint8_t { kConstant, kLinear, kExponential, kHarmonic };
inline constexpr int kScheduleKindCount = 4;
std::string_view ToString(ScheduleKind value);

struct Schedule {
  ScheduleKind kind{ScheduleKind::kConstant};
  double start{};
  double end{};          ///< ignored by kConstant
  double fraction{1.0};  ///< of the run, after which `end` is reached, (0, 1]; ignored by
                         ///< kConstant

  /// Value at `progress` of the run, [0, 1].
  double At(double progress) const;
  /// Whether the value is above 0 at some time of the run.
  bool IsEverPositive() const { return At(0.0) > 0.0 || At(1.0) > 0.0; }
};

/// Reads "0.1", "linear:1:0.05:0.5" or "exponential:10:0.5:0.5" (kind:start:end:fraction).
/// @param what prefix of error messages, such as "learning_rate"
/// @throws InputError if `text` has another form or a number is not in [min, max]; exponential and
///         harmonic schedules need start and end above 0
Schedule ParseSchedule(const std::string& text, const std::string& what, double min, double max);

/// Text from which ParseSchedule reads the same schedule.
std::string ToString(const Schedule& schedule);

}  // namespace aquafarm::agents
