// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>

#include "aquafarm/base/mutex.h"
#include "aquafarm_sim/convert/conversions.h"

namespace aquafarm_sim {

/// The clock of the farms: the stamp of each step, the pace (lockstep or paced), the rate and the
/// pauses. The owner must hold the same mutex during every call. WaitForTick releases the mutex
/// while it waits.
class PaceClock {
 public:
  explicit PaceClock(const MessageContext& start) : context_(start) {}

  const MessageContext& context() const { return context_; }

  /// Advances the stamp by one step. A pause that is scheduled for this step begins. The start of
  /// an episode counts as a step.
  void Advance();
  /// Begins or schedules a pause. With `paused` = false, ends the pause and cancels a scheduled
  /// pause.
  /// @param after_steps number of steps until the pause begins; 0: immediately. The clock runs
  ///        during these steps, even if it is paused now.
  void SetPaused(bool paused, std::uint32_t after_steps = 0);
  void SetPace(bool paced, double rate_hz);

  /// Waits until the next paced step is due or `ending` is true. No step is due while the clock is
  /// paused or in lockstep.
  /// @param lock lock of the owner's mutex
  /// @returns false if `ending` is true
  bool WaitForTick(aquafarm::MutexLock& lock, const bool& ending);
  /// Wakes WaitForTick, which then checks `ending`.
  void Wake() { changed_.notify_all(); }

 private:
  using Clock = std::chrono::steady_clock;

  bool IsRunning() const { return context_.paced && !context_.paused; }

  MessageContext context_;
  std::uint64_t stamp_ns_{};
  std::uint32_t steps_to_pause_{};  // 0: no scheduled pause
  Clock::time_point due_{};         // time of the last tick, or when the clock started to run
  bool is_counting_{};              // `due_` is valid for the present pace and rate
  std::condition_variable changed_;
};

}  // namespace aquafarm_sim
