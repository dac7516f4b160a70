// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include "aquafarm/base/mutex.h"

namespace aquafarm_agents {

/// Processes requests in a separate thread. At most one request waits: a new request replaces the
/// waiting one.
///
///   Ask(a)  Ask(b)  Ask(c)          c replaces b while a is processed
///   [work a .........][pause][work c ..]
///
/// @tparam Request type of a request
template <typename Request>
class NewestWork {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param work processes a request; called in the thread; must not throw
  /// @param min_period min time between the starts of two calls of `work`
  NewestWork(std::function<void(const Request&)> work, std::chrono::duration<double> min_period)
      : work_(std::move(work)), min_period_(min_period), thread_([this] { Run(); }) {}
  NewestWork(const NewestWork&) = delete;
  NewestWork& operator=(const NewestWork&) = delete;
  /// Drops a waiting request. Waits for the end of the present call of `work`.
  ~NewestWork() {
    {
      const aquafarm::MutexLock lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  /// Adds a request, which replaces a waiting one. Returns immediately.
  void Ask(Request request) {
    {
      const aquafarm::MutexLock lock(mutex_);
      waiting_ = std::move(request);
    }
    changed_.notify_all();
  }

  /// Returns whether a request waits or is being processed.
  bool busy() const {
    const aquafarm::MutexLock lock(mutex_);
    return waiting_.has_value() || working_;
  }

  /// Returns the duration of the present call of `work` so far [s]; 0 if `work` is not running.
  double busy_s() const {
    const aquafarm::MutexLock lock(mutex_);
    return working_ ? std::chrono::duration<double>(Clock::now() - began_).count() : 0.0;
  }

 private:
  void Run() {
    aquafarm::MutexLock lock(mutex_);
    Clock::time_point next = Clock::now();
    while (true) {
      while (!ending_ && !waiting_) lock.Wait(changed_);
      // Requests that arrive during the pause replace the waiting one.
      while (!ending_ && Clock::now() < next) lock.WaitUntil(changed_, next);
      if (ending_) return;
      const Request request = std::move(*waiting_);
      waiting_.reset();
      working_ = true;
      began_ = Clock::now();
      next = began_ + std::chrono::duration_cast<Clock::duration>(min_period_);
      lock.Unlock();
      work_(request);
      lock.Lock();
      working_ = false;
    }
  }

  const std::function<void(const Request&)> work_;
  const std::chrono::duration<double> min_period_;
  mutable aquafarm::Mutex mutex_;
  std::condition_variable changed_;
  std::optional<Request> waiting_ AQUAFARM_GUARDED_BY(mutex_);
  bool working_ AQUAFARM_GUARDED_BY(mutex_){};
  Clock::time_point began_ AQUAFARM_GUARDED_BY(mutex_);  // start of the present call
  bool ending_ AQUAFARM_GUARDED_BY(mutex_){};
  std::thread thread_;  // last, because the thread uses all other members
};

}  // namespace aquafarm_agents
