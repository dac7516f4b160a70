// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Reading of complete files.

#include <string>

namespace aquafarm::internal {

/// Rejects an existing path that is not a regular file: reading a pipe would block, and reading a
/// device may never end. Accepts a missing path.
/// @throws InputError "path: cannot read: not a regular file"
void NeedRegularFile(const std::string& path);

/// Reads a regular file completely. @throws InputError when it cannot be read or is larger than
/// 512 MiB (the complete IBTrACS file has about 300 MiB), or than 64 MiB if it is JSON, which takes
/// several times its size in memory
std::string ReadTextFile(const std::string& path);

}  // namespace aquafarm::internal
