// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target for scenario files.
#include <cstddef>
#include <cstdint>
#include <string>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aquafarm;
  try {
    ToYaml(ParseScenario(std::string(reinterpret_cast<const char*>(data), size), "fuzz"));
  } catch (const InputError&) {  // expected for invalid input; any other failure is a bug
  }
  return 0;
}
