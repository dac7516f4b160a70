// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A mutex whose use clang checks at compile time (-Wthread-safety). tools/check_locks runs this
/// check. A thread may access a member declared AQUAFARM_GUARDED_BY(mutex_) only while it holds
/// mutex_. It may call a function declared AQUAFARM_REQUIRES(mutex_) only while it holds mutex_. It
/// may call a function declared AQUAFARM_EXCLUDES(mutex_) only while it does not hold mutex_. For
/// other compilers the macros are empty.
/// Source: https://clang.llvm.org/docs/ThreadSafetyAnalysis.html

#include <chrono>
#include <condition_variable>
#include <mutex>

#if defined(__clang__)
#define AQUAFARM_THREAD_ATTRIBUTE(x) __attribute__((x))
#else
#define AQUAFARM_THREAD_ATTRIBUTE(x)
#endif
#define AQUAFARM_CAPABILITY(name) AQUAFARM_THREAD_ATTRIBUTE(capability(name))
#define AQUAFARM_SCOPED_CAPABILITY AQUAFARM_THREAD_ATTRIBUTE(scoped_lockable)
#define AQUAFARM_GUARDED_BY(mutex) AQUAFARM_THREAD_ATTRIBUTE(guarded_by(mutex))
#define AQUAFARM_REQUIRES(mutex) AQUAFARM_THREAD_ATTRIBUTE(requires_capability(mutex))
#define AQUAFARM_EXCLUDES(mutex) AQUAFARM_THREAD_ATTRIBUTE(locks_excluded(mutex))
#define AQUAFARM_ACQUIRE(...) AQUAFARM_THREAD_ATTRIBUTE(acquire_capability(__VA_ARGS__))
#define AQUAFARM_RELEASE(...) AQUAFARM_THREAD_ATTRIBUTE(release_capability(__VA_ARGS__))

namespace aquafarm {

/// A mutex that MutexLock locks.
class AQUAFARM_CAPABILITY("mutex") Mutex {
 private:
  friend class MutexLock;
  std::mutex mutex_;
};

/// Locks a mutex on construction and unlocks it on destruction. Unlock releases the mutex before
/// destruction, and Lock locks it again.
class AQUAFARM_SCOPED_CAPABILITY MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) AQUAFARM_ACQUIRE(mutex) : lock_(mutex.mutex_) {}
  ~MutexLock() AQUAFARM_RELEASE() {}
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

  void Unlock() AQUAFARM_RELEASE() { lock_.unlock(); }
  void Lock() AQUAFARM_ACQUIRE() { lock_.lock(); }

  /// Releases the mutex, waits until `changed` is notified, and locks the mutex again. Because of
  /// spurious wake-ups, call Wait in a loop that checks the condition.
  void Wait(std::condition_variable& changed) { changed.wait(lock_); }
  /// Does the same as Wait, but waits until `time` at the latest. @returns false after a timeout
  template <typename Clock, typename Duration>
  bool WaitUntil(std::condition_variable& changed,
                 const std::chrono::time_point<Clock, Duration>& time) {
    return changed.wait_until(lock_, time) == std::cv_status::no_timeout;
  }

 private:
  std::unique_lock<std::mutex> lock_;
};

}  // namespace aquafarm
