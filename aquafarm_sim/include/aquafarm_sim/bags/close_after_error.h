// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rosbag/bag.h>

#include <memory>

namespace aquafarm_sim {

/// Closes a bag after a write error. If closing fails too, the bag is never destroyed, because its
/// destructor would throw and end the process. The file then stays open.
inline void AbandonBag(std::unique_ptr<rosbag::Bag> bag) {
  try {
    bag->close();
  } catch (...) {
    static_cast<void>(bag.release());
  }
}

}  // namespace aquafarm_sim
