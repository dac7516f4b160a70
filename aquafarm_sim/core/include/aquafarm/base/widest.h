// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// AQUAFARM_WIDEST also compiles a function for AVX2 (x86-64-v3) and AVX-512 (x86-64-v4), with gcc
/// on x86-64. The program selects the variant while it is loaded. ThreadSanitizer is not
/// initialized at that time, so its builds leave the attribute out.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define AQUAFARM_WIDEST \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define AQUAFARM_WIDEST
#endif
