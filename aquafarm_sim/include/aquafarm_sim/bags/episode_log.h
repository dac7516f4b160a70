// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Compact log of an episode: seed, index, actions and external changes. The actions take one byte
/// per agent and step. From this log the episode is simulated again, bit-identically, and written
/// as a bag.

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "aquafarm/farm/farm.h"
#include "aquafarm/observation/encoder.h"

namespace aquafarm_sim {

/// Thrown when the replay of a log does not reproduce its record.
struct ReplayError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The log of one farm's episode.
struct EpisodeLog {
  /// The farm's saved state after an external change, such as a bulletin.
  struct Change {
    std::int32_t step{};  ///< number of steps of the episode before the change
    std::string state;
  };
  std::int32_t farm{};
  std::uint64_t seed{};
  std::uint64_t episode{};
  bool paced{};                       ///< whether the farm is paced at the start of the episode
  double rate_hz{};                   ///< rate at the start of the episode; 0: that of BagFormat
  std::int32_t first_step{};          ///< number of steps that were taken before the log starts
  std::vector<std::uint8_t> actions;  ///< [steps, agents]
  /// External changes by ascending step. If first_step > 0, the first entry is the farm's state at
  /// first_step.
  std::vector<Change> changes;
  aquafarm::EpisodeRecord record;  ///< valid after the end of the episode
};

/// Properties of the bags that are the same for all episodes.
struct BagFormat {
  std::string ns;  ///< namespace of the topics of the farm, with a trailing slash
  std::string map_frame{"map"};
  double rate_hz{10.0};  ///< steps per second of the bag's clock if the log's rate_hz is 0
  std::int32_t farms{1};
};

/// Returns the file name of the bag: "episode_00000012_seed_1_return_+102.4.bag".
std::string BagName(const EpisodeLog& log);

/// Removes the partial bags (episode_….bag.partial) that killed processes left in a folder. It does
/// not remove a bag that a process is still writing, nor bags of rosbag record (….bag.active).
/// @returns the number of removed bags
int RemoveAbandonedBags(const std::string& folder);

/// Simulates logs again and writes them as bags. One writer can write many logs and creates its
/// farm only once.
class EpisodeBagWriter {
 public:
  EpisodeBagWriter(std::shared_ptr<const aquafarm::Scenario> scenario, BagFormat format);

  /// Writes a bag with spec, chart, all states, the external changes and the summary. Risk is
  /// written for every tenth step and for the last one. The file is first written as `path`.partial
  /// and then renamed. After an error no partial bag remains.
  /// @throws ReplayError if the number of steps, the return or the end reason differs from the
  ///         log's record
  /// @throws std::runtime_error if the bag cannot be written
  void Write(const EpisodeLog& log, const std::string& path);

 private:
  const BagFormat format_;
  aquafarm::Farm farm_;
  const aquafarm::Encoder encoder_;
  const std::string yaml_;
};

}  // namespace aquafarm_sim
