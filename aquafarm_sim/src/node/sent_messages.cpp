// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/node/sent_messages.h"

#include <ros/poll_manager.h>

namespace aquafarm_sim {

using aquafarm::MutexLock;

// The poll thread empties the queues and calls its listeners in each round.
SentMessages::SentMessages() {
  listener_ = ros::PollManager::instance()->addPollThreadListener([this] {
    const MutexLock lock(mutex_);
    ++rounds_;
    emptied_.notify_all();
  });
}

SentMessages::~SentMessages() { ros::PollManager::instance()->removePollThreadListener(listener_); }

bool SentMessages::Wait(std::chrono::milliseconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  MutexLock lock(mutex_);
  // The current round may have emptied the queues before this call. The next round must also end.
  const std::uint64_t last = rounds_ + 2;
  while (rounds_ < last) {
    lock.Unlock();
    ros::PollManager::instance()->getPollSet().signal();  // ends the poll thread's wait for input
    lock.Lock();
    if (rounds_ < last && !lock.WaitUntil(emptied_, end)) return false;
  }
  return true;
}

}  // namespace aquafarm_sim
