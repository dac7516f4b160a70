// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm {
/// Version of the suite, recorded in bags, checkpoints and the JSON files of results. CMake reads
/// it from this file. A header generated in each build would prevent ccache from reusing objects.
inline constexpr const char* kVersion = "0.1.0";
}  // namespace aquafarm
