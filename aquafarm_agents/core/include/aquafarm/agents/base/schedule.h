// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A parameter that varies with the training progress, which rises from 0 to 1:
///
///   constant     start ----------------------
///   linear       start \                          over the first `fraction` of the run
///                       \_________ end
///   exponential  start · (end/start)^(progress/fraction), then end
///   harmonic     start / (1 + (start/end - 1) · progress/fraction), then end. If end < start, it
///                decays like 1/t. A learning rate of this form averages out noise (Robbins and
///                Monro 1951)

#include <cstdint>
#include <string>
#include <string_view>

namespace aquafarm::agents {

/// How a value changes during a training.
enum class ScheduleKind : std::uint8_t { kConstant, kLinear, kExponential, kHarmonic };
inline constexpr int kScheduleKindCount = 4;
std::string_view ToString(ScheduleKind value);

/// A schedule; by default the constant 0.
struct Schedule {
  ScheduleKind kind{ScheduleKind::kConstant};
  double start{};
  double end{};          ///< ignored by kConstant
  double fraction{1.0};  ///< progress from which the value is `end`, (0, 1]; ignored by kConstant

  /// Returns the value at `progress`, the share of the run that is done, in [0, 1].
  double At(double progress) const;
  /// Returns whether the value is above 0 at some time of the run.
  bool IsEverPositive() const { return At(0.0) > 0.0 || At(1.0) > 0.0; }
};

/// Parses a schedule. "0.1" and "constant:0.1" are constants. The other kinds have the form
/// kind:start:end:fraction, for example "linear:1:0.05:0.5".
/// @param what prefix of error messages, such as "learning_rate"
/// @throws InputError if `text` has another form, start or end is not in [min, max], fraction is
///         not in (0, 1], or start or end of an exponential or harmonic schedule is not above 0
Schedule ParseSchedule(const std::string& text, const std::string& what, double min, double max);

/// Returns a text from which ParseSchedule reads the same schedule.
std::string ToString(const Schedule& schedule);

}  // namespace aquafarm::agents
