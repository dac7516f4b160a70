// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/base/hash.h"

namespace aquafarm {

std::uint64_t HashBytes(std::string_view bytes) {
  Hasher hasher;
  hasher.Add(static_cast<std::uint64_t>(bytes.size()));
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    // Little-endian words on every machine.
    word |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])) << (8 * (i % 8));
    if (i % 8 != 7 && i + 1 != bytes.size()) continue;
    hasher.Add(word);
    word = 0;
  }
  return hasher.value();
}

}  // namespace aquafarm
