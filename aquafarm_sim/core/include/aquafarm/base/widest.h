// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Attribute of a function that gcc on x86-64 also compiles for AVX2 (x86-64-v3) and AVX-512
/// (x86-64-v4). The loader selects a variant when the program starts. ThreadSanitizer is not
/// initialized at that time, so builds with ThreadSanitizer omit the attribute.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define AQUAFARM_WIDEST \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define AQUAFARM_WIDEST
#endif
