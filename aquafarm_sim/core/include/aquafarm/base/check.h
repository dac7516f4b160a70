// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sstream>
#include <stdexcept>

namespace aquafarm {

/// Thrown if a caller violates a documented precondition (a programming error, not bad input).
class LogicError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Thrown for invalid external input (a file, a message, an argument). what() is a one-line
/// message for the user.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

namespace internal {
template <typename A, typename B>
[[noreturn]] void CheckFailed(const char* expression, const A& a, const B& b, const char* file,
                              int line) {
  std::ostringstream text;
  text << file << ':' << line << ": check failed: " << expression << " (" << +a << " vs. " << +b
       << ')';
  throw LogicError(text.str());
}
}  // namespace internal
}  // namespace aquafarm

// These checks are active in every build type. A failed check throws LogicError with the file, the
// line, the expression and both values.
#define AQUAFARM_CHECK_OP(op, a, b)                                                               \
  do {                                                                                            \
    const auto check_a = (a);                                                                     \
    const auto check_b = (b);                                                                     \
    if (!(check_a op check_b)) {                                                                  \
      ::aquafarm::internal::CheckFailed(#a " " #op " " #b, check_a, check_b, __FILE__, __LINE__); \
    }                                                                                             \
  } while (false)
#define AQUAFARM_CHECK_EQ(a, b) AQUAFARM_CHECK_OP(==, a, b)
#define AQUAFARM_CHECK_NE(a, b) AQUAFARM_CHECK_OP(!=, a, b)
#define AQUAFARM_CHECK_LT(a, b) AQUAFARM_CHECK_OP(<, a, b)
#define AQUAFARM_CHECK_LE(a, b) AQUAFARM_CHECK_OP(<=, a, b)
#define AQUAFARM_CHECK_GE(a, b) AQUAFARM_CHECK_OP(>=, a, b)
