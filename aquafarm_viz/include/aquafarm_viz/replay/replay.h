// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A recorded bag as something to walk about in: forwards at any rate, or straight to a step.

#include <aquafarm_msgs/FarmState.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace aquafarm_viz {

/// Whether a message is the state of a ranch; observations have that type, but tell of one ship.
bool IsState(const rosbag::MessageInstance& message);

/// The messages of a bag in the order of their times, and where its steps are among them.
class ReplayTape {
 public:
  /// Where a state lies.
  struct Step {
    std::size_t position{};  ///< among the messages
    std::uint64_t seed{};
    std::uint64_t episode{};
    std::uint64_t step{};
    std::size_t run{};  ///< one from an episode's first state on to its last; no two are the same
  };

  static constexpr std::size_t kMostStates = 10'000;  ///< sent before a step that is jumped to
  /// For senders and receivers: a jump sends them all at once.
  static constexpr std::uint32_t kQueueOfStates = kMostStates + 100;

  /// @throws std::runtime_error in one line when there is nothing to show: no bag, another version
  explicit ReplayTape(const std::string& path);

  const std::vector<rosbag::MessageInstance>& messages() const { return messages_; }
  const std::vector<Step>& steps() const { return steps_; }  ///< never empty

  /// The step at or before a position; the first when there is none.
  const Step& At(std::size_t position) const;

  /// The step asked for, or the next later one of that episode, or its last.
  /// @param shown where one is: an episode of that number is its own run, else the first run of the
  /// same seed, else the first of all
  /// @returns nothing when the bag has no such episode
  std::optional<Step> Find(const Step& shown, std::uint64_t episode, std::uint64_t step) const;

  /// What must be sent for a step to be seen: the spec of its episode, then the newest message of
  /// each other topic and the states of its run before it, for wakes and routes; ascending
  /// positions, the step's own last.
  std::vector<std::size_t> UpTo(const Step& step) const;

  /// What people should know before they look, a line each: missing steps, another version.
  /// @param version of this suite
  std::vector<std::string> Notes(const std::string& version) const;

  /// Seconds of the bag between two steps of a run, above 0.
  double StepPeriod_s(std::size_t run) const;

 private:
  struct Spec {
    std::size_t position{};
    std::uint64_t seed{};
    std::uint64_t episode{};
  };

  void Read(const std::string& path);
  /// @param message a state, as the next one
  void AddStep(const rosbag::MessageInstance& message, const aquafarm_msgs::FarmState& state);
  std::optional<std::size_t> SpecOf(const Step& step) const;

  rosbag::Bag bag_;
  rosbag::View view_;
  std::vector<rosbag::MessageInstance> messages_;
  std::vector<Step> steps_;
  std::vector<Spec> specs_;
  std::map<std::string, Step> last_;  // by topic, while reading
  std::size_t runs_{};                // begun so far
  std::uint64_t missing_{};           // steps between others
  std::set<std::string> versions_;    // that recorded it
};

}  // namespace aquafarm_viz
