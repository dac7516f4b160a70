// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// An episode as what decides it: seed, number, actions, and what came from outside. From these few
/// bytes a step the whole episode is played again, bit for bit, and written as a bag.

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "aquafarm/farm/farm.h"
#include "aquafarm/observation/encoder.h"

namespace aquafarm_sim {

/// A tape that does not give its record again.
struct TapeError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One farm's episode, as it goes.
struct EpisodeTape {
  /// The farm's saved state after something came from outside.
  struct Change {
    std::int32_t step{};  ///< steps taken before
    std::string state;
  };
  std::int32_t farm{};
  std::uint64_t seed{};
  std::uint64_t episode{};
  bool paced{};                       ///< when it began
  double rate_hz{};                   ///< then; 0: the format's
  std::int32_t first_step{};          ///< steps taken before the tape began: a loaded episode's
  std::vector<std::uint8_t> actions;  ///< [steps, agents]
  std::vector<Change> changes;        ///< by step
  aquafarm::EpisodeRecord record;     ///< once it is over
};

/// How an episode is written.
struct BagFormat {
  std::string ns;  ///< of the ranch's topics, with the slash after it
  std::string map_frame{"map"};
  double rate_hz{10.0};  ///< steps a second of the bag's clock, where the tape has none of its own
  std::int32_t farms{1};
};

/// "episode_00000012_seed_1_return_+102.4.bag".
std::string BagName(const EpisodeTape& tape);

/// Plays tapes again and writes them as bags. One serves many: its farm is made once.
class EpisodeBagWriter {
 public:
  EpisodeBagWriter(std::shared_ptr<const aquafarm::Scenario> scenario, BagFormat format);

  /// Writes spec, chart, risk (every tenth step), every state, what came from outside, and the
  /// summary into an lz4 bag: first beside `path` as path.active, then renamed.
  /// @throws TapeError when the tape does not give its record
  /// @throws std::runtime_error when it cannot be written; nothing is left of it then
  void Write(const EpisodeTape& tape, const std::string& path);

 private:
  const BagFormat format_;
  aquafarm::Farm farm_;
  const aquafarm::Encoder encoder_;
  const std::string yaml_;
};

}  // namespace aquafarm_sim
