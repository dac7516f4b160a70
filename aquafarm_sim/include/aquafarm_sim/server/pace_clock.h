// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>

#include "aquafarm/base/mutex.h"
#include "aquafarm_sim/convert/conversions.h"

namespace aquafarm_sim {

/// The time of the farms: the stamp of each step, the pace (lockstep or paced at a rate), pauses.
/// The owner holds one mutex during every call. WaitForTick releases it while it waits.
class PaceClock {
 public:
  explicit PaceClock(const MessageContext& start) : context_(start) {}

  const MessageContext& context() const { return context_; }

  /// Advances the stamp by one step. A pause scheduled for this step begins.
  void Advance();
  /// @param after_steps number of steps until the pause begins; 0: immediately. Ignored if `paused`
  /// is false, which ends a pause and removes a scheduled one.
  void SetPaused(bool paused, std::uint32_t after_steps = 0);
  void SetPace(bool paced, double rate_hz);

  /// Waits until the next paced step is due, `ending` is true, or both. While the clock is paused
  /// or in lockstep no step is due. @return false if `ending` is true
  bool WaitForTick(aquafarm::MutexLock& lock, const bool& ending);
  /// Makes WaitForTick look at `ending`.
  void Wake() { changed_.notify_all(); }

 private:
  using Clock = std::chrono::steady_clock;

  bool IsRunning() const { return context_.paced && !context_.paused; }

  MessageContext context_;
  std::uint64_t stamp_ns_{};
  std::uint32_t steps_to_pause_{};  // 0: no scheduled pause
  Clock::time_point due_{};         // time of the last tick, or since when the clock runs
  bool is_counting_{};              // `due_` belongs to the present pace
  std::condition_variable changed_;
};

}  // namespace aquafarm_sim
