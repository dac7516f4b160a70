// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Random access to the messages and steps of a recorded bag.

#include <aquafarm_msgs/FarmState.h>
#include <ros/advertise_options.h>
#include <ros/publisher.h>
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

/// Returns true if a message is the state of a ranch. Observations of ships have the same type and
/// give false.
bool IsState(const rosbag::MessageInstance& message);

/// Returns the options of a topic for messages of a bag. Messages of an earlier version are
/// published as those of this one.
ros::AdvertiseOptions AdvertiseOptionsOf(const rosbag::MessageInstance& message,
                                         std::uint32_t queue);
/// Publishes a message of a bag. @param publisher advertised with AdvertiseOptionsOf
void PublishMessage(const rosbag::MessageInstance& message, const ros::Publisher& publisher);

/// The messages of a bag in time order, and the positions of its steps among them.
class ReplayTape {
 public:
  /// Position of a state.
  struct Step {
    std::size_t position{};  ///< index in messages()
    std::uint64_t seed{};
    std::uint64_t episode{};
    std::uint64_t step{};
    std::size_t run{};  ///< unique number of one playthrough of an episode
  };

  static constexpr std::size_t kMaxStates = 10'000;  ///< max states sent before a jump's target
  /// Queue size for publishers and subscribers: a jump sends all these states at once.
  static constexpr std::uint32_t kQueueOfStates = kMaxStates + 100;

  /// @throws std::runtime_error with a message of one line if the bag cannot be shown: not a bag,
  ///         another version, no state
  explicit ReplayTape(const std::string& path);

  const std::vector<rosbag::MessageInstance>& messages() const { return messages_; }
  const std::vector<Step>& steps() const { return steps_; }  ///< never empty

  /// Returns the last step at or before a position; the first step if there is none.
  const Step& At(std::size_t position) const;

  /// Returns the requested step. If it is not recorded, returns the next recorded step of the
  /// episode, or its last one.
  /// @param shown the step that is shown now. If several runs have this episode index, its own run
  ///        is preferred, then the first run with its seed, then the first run.
  /// @returns nullopt if the bag does not contain the episode
  std::optional<Step> Find(const Step& shown, std::uint64_t episode, std::uint64_t step) const;

  /// Returns the positions of the messages to send for showing a step: the spec of its episode,
  /// then, in ascending order, the newest message of each other topic and the earlier states of its
  /// run (for trails and routes). The state of the step is the last one.
  std::vector<std::size_t> UpTo(const Step& step) const;

  /// Returns warnings about the bag, one line each: missing steps, another version.
  /// @param version version of aquafarm that is running
  std::vector<std::string> Notes(const std::string& version) const;

  /// Returns the mean bag time between two steps of a run [s], above 0.
  double StepPeriod_s(std::size_t run) const;

 private:
  struct Spec {
    std::size_t position{};
    std::uint64_t seed{};
    std::uint64_t episode{};
  };

  void Read(const std::string& path);
  /// @param message the message that contains `state`, the next one in time order
  void AddStep(const rosbag::MessageInstance& message, const aquafarm_msgs::FarmState& state);
  std::optional<std::size_t> SpecOf(const Step& step) const;

  rosbag::Bag bag_;
  rosbag::View view_;
  std::vector<rosbag::MessageInstance> messages_;
  std::vector<Step> steps_;
  std::vector<Spec> specs_;
  std::map<std::string, Step> last_;  // by topic, while reading
  std::size_t runs_{};                // number of runs found so far
  std::uint64_t missing_{};           // number of missing steps between recorded ones
  std::set<std::string> versions_;    // versions that recorded the bag
};

}  // namespace aquafarm_viz
