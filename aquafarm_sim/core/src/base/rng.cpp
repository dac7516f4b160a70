// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/base/rng.h"

#include <Random123/philox.h>

namespace aquafarm {

std::array<std::uint32_t, 4> Draw(const StreamKey& key, std::uint32_t index) {
  r123::Philox4x32 philox;
  const std::uint32_t what = (static_cast<std::uint32_t>(key.purpose) << 24U) | key.stream;
  const r123::Philox4x32::ctr_type counter{{index, what, static_cast<std::uint32_t>(key.episode),
                                            static_cast<std::uint32_t>(key.episode >> 32U)}};
  const r123::Philox4x32::key_type philox_key{
      {static_cast<std::uint32_t>(key.seed), static_cast<std::uint32_t>(key.seed >> 32U)}};
  const r123::Philox4x32::ctr_type draws = philox(counter, philox_key);
  return {draws[0], draws[1], draws[2], draws[3]};
}

}  // namespace aquafarm
