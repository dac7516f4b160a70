// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string_view>

#include "aquafarm/base/check.h"

namespace aquafarm::internal {

/// Returns the name of an enum value, names[value]. @throws LogicError for a value without a name
template <typename Enum, std::size_t N>
std::string_view NameOf(Enum value, const std::array<std::string_view, N>& names) {
  const auto i = static_cast<std::size_t>(value);
  AQUAFARM_CHECK_LT(i, N);
  return names[i];
}

}  // namespace aquafarm::internal
