// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace aquafarm {

/// Parses CBOR bytes (RFC 8949), such as a saved state or a checkpoint.
/// @param what name of the bytes in error messages
/// @throws InputError if the bytes are not exactly one CBOR item that nlohmann::json can represent,
///   are nested more than 16 levels deep, or contain an item of indefinite length. Deep nesting and
///   indefinite lengths could exhaust the stack of the parser. Saved states contain neither.
nlohmann::json ParseCbor(std::string_view bytes, const std::string& what = "state");

}  // namespace aquafarm
