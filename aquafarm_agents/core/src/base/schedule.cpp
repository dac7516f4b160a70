// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/base/schedule.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "aquafarm/agents/base/text.h"
#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

std::vector<std::string> Split(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (;;) {
    const std::size_t end = text.find(':', begin);
    parts.push_back(text.substr(begin, end - begin));
    if (end == std::string::npos) return parts;
    begin = end + 1;
  }
}

void CheckRange(double value, const std::string& what, double min, double max) {
  if (value >= min && value <= max) return;
  throw InputError(what + ": got " + FormatNumber(value) + ", expected [" + FormatNumber(min) +
                   ", " + FormatNumber(max) + "]");
}

}  // namespace

std::string_view ToString(ScheduleKind value) {
  switch (value) {
    case ScheduleKind::kConstant:
      return "constant";
    case ScheduleKind::kLinear:
      return "linear";
    case ScheduleKind::kExponential:
      return "exponential";
    case ScheduleKind::kHarmonic:
      return "harmonic";
  }
  return "?";
}

double Schedule::At(double progress) const {
  if (kind == ScheduleKind::kConstant) return start;
  if (progress >= fraction) return end;
  const double done = std::max(0.0, progress) / fraction;
  if (kind == ScheduleKind::kLinear) return start + (end - start) * done;
  if (kind == ScheduleKind::kHarmonic) return start / (1.0 + (start / end - 1.0) * done);
  return start * std::pow(end / start, done);
}

Schedule ParseSchedule(const std::string& text, const std::string& what, double min, double max) {
  const std::vector<std::string> parts = Split(text);
  Schedule schedule;
  if (parts.size() == 1) {
    schedule.start = ParseNumber(parts[0], what);
    CheckRange(schedule.start, what, min, max);
    return schedule;
  }
  if (parts.size() == 2 && parts[0] == ToString(ScheduleKind::kConstant)) {
    return ParseSchedule(parts[1], what, min, max);
  }
  for (int i = 1; i < kScheduleKindCount; ++i) {
    if (parts[0] == ToString(static_cast<ScheduleKind>(i))) {
      schedule.kind = static_cast<ScheduleKind>(i);
    }
  }
  if (parts.size() != 4 || schedule.kind == ScheduleKind::kConstant) {
    throw InputError(what + ": got '" + text +
                     "', expected a number or kind:start:end:fraction, where kind is linear, "
                     "exponential or harmonic");
  }
  schedule.start = ParseNumber(parts[1], what);
  schedule.end = ParseNumber(parts[2], what);
  schedule.fraction = ParseNumber(parts[3], what);
  CheckRange(schedule.start, what + ": start", min, max);
  CheckRange(schedule.end, what + ": end", min, max);
  if (schedule.fraction <= 0.0 || schedule.fraction > 1.0) {
    throw InputError(what + ": fraction: got " + parts[3] + ", expected (0, 1]");
  }
  if (schedule.kind != ScheduleKind::kLinear && (schedule.start <= 0.0 || schedule.end <= 0.0)) {
    throw InputError(what + ": got '" + text + "', expected start and end above 0 for kind " +
                     parts[0]);
  }
  return schedule;
}

std::string ToString(const Schedule& schedule) {
  if (schedule.kind == ScheduleKind::kConstant) return FormatNumber(schedule.start);
  return std::string(ToString(schedule.kind)) + ":" + FormatNumber(schedule.start) + ":" +
         FormatNumber(schedule.end) + ":" + FormatNumber(schedule.fraction);
}

}  // namespace aquafarm::agents
