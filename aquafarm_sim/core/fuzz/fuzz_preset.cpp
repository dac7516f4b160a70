// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target for presets of a disaster. Every accepted preset must pass ValidateDisaster.
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
  } catch (const InputError&) {  // expected for invalid input; any other failure is a bug
    return 0;
  }
  ValidateDisaster(disaster);
  return 0;
}
