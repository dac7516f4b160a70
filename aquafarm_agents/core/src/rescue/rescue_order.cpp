// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/rescue/rescue_order.h"

#include <array>

namespace aquafarm::agents {

std::string_view ToString(OrderKind value) {
  constexpr std::array<std::string_view, kOrderKindCount> kNames{"leave", "fetch", "deliver"};
  return kNames[static_cast<std::size_t>(value)];
}

}  // namespace aquafarm::agents
