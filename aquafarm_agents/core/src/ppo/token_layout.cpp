// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/token_layout.h"

#include <algorithm>
#include <string_view>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

constexpr std::array<std::string_view, kTokenKindCount> kKinds{"ship", "device", "port", "disaster",
                                                               "other"};

// Returns the part before the first dot: "device3" for "device3.valid".
std::string_view SlotOf(const std::string& name) {
  return std::string_view(name).substr(0, name.find('.'));
}

bool IsOf(std::string_view slot, std::size_t kind) {
  const std::size_t letters = slot.find_last_not_of("0123456789") + 1;
  return slot.substr(0, letters) == kKinds[kind];
}

}  // namespace

std::size_t TokenLayout::PlaceOf(TokenKind kind, const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError("tokens: got no feature '" + name + "', expected the features of view.tokens");
  return static_cast<std::size_t>(found - names.begin()) - of(kind).begin;
}

bool HasTokens(const EnvironmentSpec& spec) {
  return !spec.feature_names.empty() && spec.feature_names[0] == "ship.time_left";
}

TokenLayout LayoutOfTokens(const std::vector<std::string>& names) {
  TokenLayout layout;
  layout.names = names;
  std::size_t next = 0;
  for (std::size_t kind = 0; kind < kTokenKindCount; ++kind) {
    TokenGroup& group = layout.groups[kind];
    group.begin = next;
    while (next < names.size() && IsOf(SlotOf(names[next]), kind)) {
      const bool is_new = next == group.begin || SlotOf(names[next]) != SlotOf(names[next - 1]);
      group.slots += is_new ? 1 : 0;
      ++next;
    }
    group.size = group.slots == 0 ? 0 : (next - group.begin) / group.slots;
    if (group.slots > 0 && group.end() == next) continue;
    throw InputError("tokens: got no slots of equal size for '" + std::string(kKinds[kind]) +
                     "', expected the features of view.tokens");
  }
  if (next == names.size()) return layout;
  throw InputError("tokens: got feature '" + names[next] +
                   "', expected only the features of view.tokens");
}

}  // namespace aquafarm::agents
