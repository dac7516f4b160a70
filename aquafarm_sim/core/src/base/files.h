// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Whole files.

#include <string>

namespace aquafarm::internal {

/// Refuses what is there and no regular file: a pipe would be waited for, a device never ends.
/// @throws InputError "path: cannot read: is no regular file"
void NeedRegularFile(const std::string& path);

/// A whole regular file. @throws InputError when it cannot be read, or is larger than 512 MiB: all
/// of IBTrACS is some 300.
std::string ReadTextFile(const std::string& path);

}  // namespace aquafarm::internal
