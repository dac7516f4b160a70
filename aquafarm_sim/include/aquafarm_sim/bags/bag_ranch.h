// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Finds the ranch that a bag was recorded from.

#include <rosbag/bag.h>

#include <string>

namespace aquafarm_sim {

/// Returns the namespace of a ranch in a bag, with a trailing slash.
/// @param path path of the bag, for error messages
/// @param ns namespace of the ranch; empty if the bag contains only one ranch
/// @throws aquafarm::InputError if the bag has no such ranch, or several and `ns` is empty
std::string FindRanch(const rosbag::Bag& bag, const std::string& path, const std::string& ns);

}  // namespace aquafarm_sim
