// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace aquafarm::agents {

struct Checkpoint;

/// Parses the content of a checkpoint file. @param path path of the file, for messages
/// @throws InputError if it is not a checkpoint, is damaged or has another format
Checkpoint ParseCheckpoint(const std::string& bytes, const std::string& path);

}  // namespace aquafarm::agents
