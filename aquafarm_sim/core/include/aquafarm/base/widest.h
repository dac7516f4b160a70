// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// AQUAFARM_WIDEST: a function with this attribute is also compiled for wider registers. The
/// variant is chosen when the program starts, which is too early for ThreadSanitizer.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define AQUAFARM_WIDEST \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define AQUAFARM_WIDEST
#endif
