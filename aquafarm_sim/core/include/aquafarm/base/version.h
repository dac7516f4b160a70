// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm {
/// Version of the suite. Bags, saved states, checkpoints and JSON files of results contain it.
/// CMake reads it from this file.
inline constexpr const char* kVersion = "0.1.0";
}  // namespace aquafarm
