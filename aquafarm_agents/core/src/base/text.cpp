// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/base/text.h"

#include <charconv>
#include <cmath>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {

double ParseNumber(const std::string& text, const std::string& what) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) {
    throw InputError(what + ": got '" + text + "', expected a number");
  }
  return value;
}

std::string FormatNumber(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof(text), value).ptr};
}

std::string Join(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace aquafarm::agents
