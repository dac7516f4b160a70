// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Simulates the episodes of a recorded bag again and compares the results with the recording:
///
///   spec --------> scenario, seed, episode --> farm
///   state k -----> actions of its ships -----> step --> compare every field and the hash
///   saved_state -> load, then compare the next state
///   chart -------> compare if it has the stamp of the spec
///   risk --------> compare if it has the stamp of state k
///   episode -----> compare the summary
///
/// Some values are not compared, because the simulation does not determine them: stamps, pace,
/// rate, pauses, frames, the number of farms and the index of the farm.

#include <cstdint>
#include <string>
#include <vector>

namespace aquafarm_sim {

/// Result of a check.
struct BagCheck {
  std::uint64_t episodes{};
  std::uint64_t steps{};
  std::uint64_t unfinished{};             ///< episodes whose end the bag does not contain
  std::vector<std::uint64_t> changed_at;  ///< steps with an external change, such as a bulletin
  std::string difference;  ///< first difference, "episode 3 step 17: …"; empty if identical
  /// One text per episode, such as "episode 3 of seed 1: 321 steps, return 102.4, all_retrieved".
  std::vector<std::string> episodes_in_words;
};

/// Returns a text such as ", changed from outside at step 20, 31"; empty if there was no external
/// change.
std::string ChangesInWords(const BagCheck& check);

/// Checks the episodes of a ranch in the bag at `path`, up to the first difference.
/// @param ns namespace of the ranch; may be empty if the bag contains only one ranch
/// @throws InputError if the bag cannot be checked, for example because it is damaged, contains no
///         spec, or was recorded by another version
BagCheck CheckBag(const std::string& path, const std::string& ns);

}  // namespace aquafarm_sim
