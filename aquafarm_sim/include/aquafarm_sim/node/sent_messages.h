// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// roscpp queues published messages. Its poll thread hands them to the connections of subscribers.
/// A message to one subscriber (SingleSubscriberPublisher) does not take this queue, so it arrives
/// before messages that were published earlier and are still in it.

#include <boost/signals2/connection.hpp>
#include <chrono>
#include <condition_variable>
#include <cstdint>

#include "aquafarm/base/mutex.h"

namespace aquafarm_sim {

class SentMessages {
 public:
  /// A node handle must exist.
  SentMessages();
  ~SentMessages();
  SentMessages(const SentMessages&) = delete;
  SentMessages& operator=(const SentMessages&) = delete;

  /// Waits until everything that was published before the call has left the queue. Must not be
  /// called by the poll thread.
  /// @returns false after the limit, for example if the process gets no processor
  bool Wait(std::chrono::milliseconds limit);

 private:
  aquafarm::Mutex mutex_;
  std::condition_variable emptied_;
  std::uint64_t rounds_ AQUAFARM_GUARDED_BY(mutex_){};  // of the poll thread
  boost::signals2::connection listener_;
};

}  // namespace aquafarm_sim
