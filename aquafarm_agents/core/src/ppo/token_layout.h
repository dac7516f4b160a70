// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Positions of the entity tokens in the feature vector (view.tokens, docs/generalist.md). They
/// follow from the names of the features: "ship.time_left", …, "device0.valid", …,
/// "device1.valid", …

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"

namespace aquafarm::agents {

/// Slots of one kind of entity, consecutive in the feature vector. Feature 0 of a slot, except the
/// ship's, is 1 if the slot holds an entity.
struct TokenGroup {
  std::size_t begin{};  ///< index of the first feature
  std::size_t slots{};
  std::size_t size{};  ///< number of features of one slot
  std::size_t end() const { return begin + slots * size; }
};

enum class TokenKind : std::uint8_t { kShip, kDevice, kPort, kDisaster, kOther };
inline constexpr std::size_t kTokenKindCount = 5;

struct TokenLayout {
  std::array<TokenGroup, kTokenKindCount> groups{};  ///< by TokenKind, in the order of the features
  std::vector<std::string> names;                    ///< names of all features

  const TokenGroup& of(TokenKind kind) const { return groups[static_cast<std::size_t>(kind)]; }
  /// Returns the offset of a feature within the first slot of its kind.
  /// @param name full name of the feature, such as "device0.here"
  /// @throws InputError if there is no such feature
  std::size_t PlaceOf(TokenKind kind, const std::string& name) const;
};

/// Returns whether the features of `spec` are entity tokens.
bool HasTokens(const EnvironmentSpec& spec);

/// Returns the layout of features with the given names.
/// @throws InputError if the names are not those of entity tokens
TokenLayout LayoutOfTokens(const std::vector<std::string>& names);

}  // namespace aquafarm::agents
