// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Checks the parts of a bag that rosbag's reader does not check: lengths, offsets and the index.

#include <stdexcept>
#include <string>

namespace aquafarm_sim::internal {

/// Thrown if a bag is damaged; the message describes the damage.
struct Damage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Checks that the index of a bag agrees with its content. Accepts a bag without an index, an
/// unreadable file and a file of at most 13 bytes, because rosbag reports these faults when it
/// opens the bag.
/// @throws Damage or rosbag::BagException if the bag is damaged, not a bag of version 2.0 or not a
///         regular file
/// @throws aquafarm::InputError if the bag is encrypted or the file does not exist
void CheckStructure(const std::string& path);

}  // namespace aquafarm_sim::internal
