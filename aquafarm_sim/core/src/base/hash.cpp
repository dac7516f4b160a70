// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/base/hash.h"

namespace aquafarm {

std::uint64_t HashBytes(std::string_view bytes) {
  return HashBytes(std::vector<std::string_view>{bytes});
}

std::uint64_t HashBytes(const std::vector<std::string_view>& parts) {
  std::uint64_t size = 0;
  for (const std::string_view part : parts) size += part.size();
  Hasher hasher;
  hasher.Add(size);
  std::uint64_t word = 0;
  unsigned shift = 0;
  for (const std::string_view part : parts) {
    for (const char byte : part) {
      // The words are little-endian on every machine.
      word |= static_cast<std::uint64_t>(static_cast<unsigned char>(byte)) << shift;
      shift = (shift + 8U) % 64U;
      if (shift != 0) continue;
      hasher.Add(word);
      word = 0;
    }
  }
  if (shift != 0) hasher.Add(word);
  return hasher.value();
}

}  // namespace aquafarm
