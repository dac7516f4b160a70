// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/progress_text.h"

#include <cmath>
#include <cstdio>

#include "aquafarm/agents/base/text.h"

namespace aquafarm::agents {

std::string FormatCount(std::uint64_t value) {
  std::string text = std::to_string(value);
  for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, ",");
  return text;
}

std::string DescribeReturns(const TrainingProgress& progress) {
  const bool has_best = !std::isnan(progress.best_mean_return);
  char text[120];
  std::snprintf(text, sizeof(text), "last %-3d   return %.1f, success %.1f %% (exploring)",
                has_best ? TrainingProgress::kWindow : static_cast<int>(progress.episodes),
                static_cast<double>(progress.mean_return),
                100.0 * static_cast<double>(progress.success_rate));
  if (!has_best) return text;
  char best[40];
  std::snprintf(best, sizeof(best), "; best mean return %.1f",
                static_cast<double>(progress.best_mean_return));
  return text + std::string(best);
}

std::string DescribeProgress(const TrainingProgress& progress) {
  const auto of = [](std::uint64_t done, std::uint64_t limit) {
    return limit == 0 ? FormatCount(done) : FormatCount(done) + " / " + FormatCount(limit);
  };
  std::string text = "steps " + of(progress.steps, progress.step_limit) + "  episodes " +
                     of(progress.episodes, progress.episode_limit);
  char rest[80];
  if (progress.episodes > 0) {
    std::snprintf(rest, sizeof(rest), "  return %.1f  success %.2f",
                  static_cast<double>(progress.mean_return),
                  static_cast<double>(progress.success_rate));
    text += rest;
  }
  std::snprintf(rest, sizeof(rest), "  exploration %.3g  %s steps/s",
                static_cast<double>(progress.learner.exploration),
                FormatCount(static_cast<std::uint64_t>(progress.steps_per_second)).c_str());
  text += rest;
  if (progress.time_left_s >= 0.0) text += "  left " + FormatDuration(progress.time_left_s);
  return text;
}

}  // namespace aquafarm::agents
