// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/server/pace_clock.h"

#include <algorithm>

namespace aquafarm_sim {

void PaceClock::Advance() {
  stamp_ns_ += static_cast<std::uint64_t>(1e9 / context_.rate_hz);
  context_.stamp.fromNSec(stamp_ns_);
  if (steps_to_pause_ > 0 && --steps_to_pause_ == 0) context_.paused = true;
}

void PaceClock::SetPaused(bool paused, std::uint32_t after_steps) {
  const bool was_paused = context_.paused;
  steps_to_pause_ = paused ? after_steps : 0;
  context_.paused = paused && after_steps == 0;
  if (context_.paused != was_paused) is_counting_ = false;
  Wake();
}

void PaceClock::SetPace(bool paced, double rate_hz) {
  if (paced != context_.paced || rate_hz != context_.rate_hz) is_counting_ = false;
  context_.paced = paced;
  context_.rate_hz = rate_hz;
  Wake();
}

bool PaceClock::WaitForTick(aquafarm::MutexLock& lock, const bool& ending) {
  while (!ending) {
    if (!IsRunning()) {
      is_counting_ = false;
      lock.Wait(changed_);
      continue;
    }
    if (!is_counting_) due_ = Clock::now();
    is_counting_ = true;
    const std::chrono::duration<double> period(1.0 / context_.rate_hz);
    const Clock::time_point next =
        std::max(due_ + std::chrono::duration_cast<Clock::duration>(period), Clock::now());
    while (!ending && is_counting_ && lock.WaitUntil(changed_, next)) {
    }
    if (ending || !is_counting_) continue;
    due_ = next;
    return true;
  }
  return false;
}

}  // namespace aquafarm_sim
