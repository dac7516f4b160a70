// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "aquafarm/agents/base/options.h"

namespace aquafarm::agents {

/// Returns options with the network size of another learner, unless they name one: a network that
/// begins with the weights of another one has its size.
/// @param initial options of the other one
inline std::string WithSizeOf(const std::string& initial, const std::string& options) {
  const std::string key = "hidden_size=";
  const std::size_t begin = initial.find(key);
  if (begin == std::string::npos) return options;
  if (CanonicalOptions(options).find(key) != std::string::npos) return options;
  const std::string size = initial.substr(begin, initial.find(' ', begin) - begin);
  return options.empty() ? size : options + ' ' + size;
}

}  // namespace aquafarm::agents
