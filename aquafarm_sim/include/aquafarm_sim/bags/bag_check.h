// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Simulates a recorded bag again and compares what it says with what comes out:
///
///   spec ------> scenario, seed, episode --> farm
///   state k ---> actions of its ships -----> step --> compare every field and the hash
///   episode ---> compare the summary
///
/// What only the recording decides is taken over: stamps, pace, rate, frames, number of farms.

#include <cstdint>
#include <string>
#include <vector>

namespace aquafarm_sim {

/// What a check came to.
struct BagCheck {
  std::uint64_t episodes{};
  std::uint64_t steps{};
  std::uint64_t unfinished{};             ///< episodes whose end is not in the bag
  std::vector<std::uint64_t> changed_at;  ///< steps at which something came from outside
  std::string difference;  ///< the first one: "episode 3 step 17: …"; empty: identical
  std::vector<std::string> episodes_in_words;  ///< "episode 3: 321 steps, return 102.4, …"
};

/// ", changed from outside at step 20, 31"; empty where nothing came from outside.
std::string ChangesInWords(const BagCheck& check);

/// Checks every episode of a bag.
/// @param ns namespace of the ranch; empty: the only one there is
/// @throws InputError when it cannot be checked: no bag, no spec, another version
BagCheck CheckBag(const std::string& path, const std::string& ns);

}  // namespace aquafarm_sim
