// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Finds the ranch that a bag was recorded from.

#include <rosbag/bag.h>

#include <string>

namespace aquafarm_sim {

/// Returns the prefix of the topics of a ranch in a bag, for example "/aquafarm/".
/// @param path path of the bag, for error messages
/// @param ns namespace of the ranch; may be empty if the bag contains only one ranch
/// @throws aquafarm::InputError if the bag contains no ranch or not the ranch `ns`, or if `ns` is
///         empty and the bag contains several ranches
std::string FindRanch(const rosbag::Bag& bag, const std::string& path, const std::string& ns);

}  // namespace aquafarm_sim
