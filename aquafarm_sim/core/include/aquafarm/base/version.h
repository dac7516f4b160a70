// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm {
/// Version of the suite, written to every bag, checkpoint and results file. CMake reads it here;
/// with a generated header in each build, ccache would not recognise the same sources.
inline constexpr const char* kVersion = "0.1.0";
}  // namespace aquafarm
