// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target for files of notices and of storm tracks. Both readers get each input and detect the
// format from its content.
#include <cstddef>
#include <cstdint>
#include <string>

#include "aquafarm/base/check.h"
#include "aquafarm/storms/notices.h"
#include "aquafarm/storms/to_disaster.h"
#include "aquafarm/tracks/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aquafarm;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    for (const Notice& notice : ParseNotices(bytes, "fuzz").notices) Describe(notice);
  } catch (const InputError&) {  // expected for invalid input; any other failure is a bug
  }
  try {
    const StormFile file = ParseStormFile(bytes, "fuzz");
    for (const StormTrack& track : file.tracks) ToRings(track, RingReduction::kEqualArea);
  } catch (const InputError&) {  // expected for invalid input; any other failure is a bug
  }
  return 0;
}
