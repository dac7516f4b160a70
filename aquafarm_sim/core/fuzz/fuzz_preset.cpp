// SPDX-License-Identifier: BSD-3-Clause
// Bytes as a preset of a disaster; what is taken must be one that a farm takes.
#include <cstddef>
#include <cstdint>
#include <string>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/validate.h"
#include "aquafarm/storms/presets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aquafarm;
  DisasterSpec disaster;
  try {
    disaster =
        ParseDisasterPreset(std::string(reinterpret_cast<const char*>(data), size), GridScale{});
  } catch (const InputError&) {  // a refusal; all else is a find
    return 0;
  }
  ValidateDisaster(disaster);
  return 0;
}
