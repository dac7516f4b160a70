// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Waits until published messages have left roscpp's queue. Publishing adds a message to the queue.
/// The poll thread of roscpp then passes the message to the subscribers' connections. A message to
/// one subscriber (SingleSubscriberPublisher) bypasses the queue. Without a wait, such a message
/// would arrive before messages that were published earlier and are still in the queue.

#include <boost/signals2/connection.hpp>
#include <chrono>
#include <condition_variable>
#include <cstdint>

#include "aquafarm/base/mutex.h"

namespace aquafarm_sim {

/// Waits until published messages have left the queue.
class SentMessages {
 public:
  /// A ros::NodeHandle must exist.
  SentMessages();
  ~SentMessages();
  SentMessages(const SentMessages&) = delete;
  SentMessages& operator=(const SentMessages&) = delete;

  /// Waits until all messages that were published before the call have left the queue. Must not be
  /// called by the poll thread.
  /// @returns false if this takes longer than `limit`
  bool Wait(std::chrono::milliseconds limit);

 private:
  aquafarm::Mutex mutex_;
  std::condition_variable emptied_;
  std::uint64_t rounds_ AQUAFARM_GUARDED_BY(mutex_){};  // completed rounds of the poll thread
  boost::signals2::connection listener_;
};

}  // namespace aquafarm_sim
