// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rosbag/bag.h>

#include <memory>

namespace aquafarm_sim {

/// Closes a bag whose writing failed. What its end writes may fail as well, in its destructor too,
/// which would end the process; then it is left, with its file open.
inline void AbandonBag(std::unique_ptr<rosbag::Bag> bag) {
  try {
    bag->close();
  } catch (...) {
    static_cast<void>(bag.release());
  }
}

}  // namespace aquafarm_sim
