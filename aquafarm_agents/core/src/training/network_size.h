// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "aquafarm/agents/base/options.h"

namespace aquafarm::agents {

/// Returns `options` with the hidden_size of `initial` added, unless they contain hidden_size. A
/// network that starts with the weights of another network needs the same size.
/// @param initial options of the learner that trained the weights
inline std::string WithSizeOf(const std::string& initial, const std::string& options) {
  const std::string key = "hidden_size=";
  const std::size_t begin = initial.find(key);
  if (begin == std::string::npos) return options;
  if (CanonicalOptions(options).find(key) != std::string::npos) return options;
  const std::string size = initial.substr(begin, initial.find(' ', begin) - begin);
  return options.empty() ? size : options + ' ' + size;
}

}  // namespace aquafarm::agents
