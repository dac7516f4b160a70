// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Random access to the messages of a recorded bag and to the steps of its episodes.

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

/// Returns true if a message is the state of a ranch. Returns false for the observation of a ship,
/// which has the same type but the topic `observation`.
bool IsState(const rosbag::MessageInstance& message);

/// Returns the options with which the topic of a message is advertised. If an earlier version
/// recorded the message, the topic gets the message definition of this version.
/// @param queue queue size of the publisher
ros::AdvertiseOptions AdvertiseOptionsOf(const rosbag::MessageInstance& message,
                                         std::uint32_t queue);
/// Publishes a message of a bag. A message of an earlier version is translated to this version; it
/// is not published if this fails.
/// @param publisher advertised with AdvertiseOptionsOf
void PublishMessage(const rosbag::MessageInstance& message, const ros::Publisher& publisher);

/// The messages of a bag in time order, without /clock, and the positions of its states among them.
class ReplayTape {
 public:
  /// A recorded state and its position.
  struct Step {
    std::size_t position{};  ///< index in messages()
    std::uint64_t seed{};
    std::uint64_t episode{};
    std::uint64_t step{};
    std::size_t run{};  ///< number of the playthrough of an episode, unique in the bag
  };

  static constexpr std::size_t kMaxStates = 10'000;  ///< max earlier states that a jump publishes
  /// Queue size for states in ReplayNode and VizNode. It exceeds kMaxStates, because a jump
  /// publishes its states all at once.
  static constexpr std::uint32_t kQueueOfStates = kMaxStates + 100;

  /// @throws std::runtime_error with a message of one line if the bag cannot be shown: it is not a
  ///         bag or is damaged, its messages are of an unknown version, or it has no spec or state
  explicit ReplayTape(const std::string& path);

  const std::vector<rosbag::MessageInstance>& messages() const { return messages_; }
  const std::vector<Step>& steps() const { return steps_; }  ///< by position; never empty

  /// Returns the last state at or before a position; the first state if there is none.
  const Step& At(std::size_t position) const;

  /// Returns the requested step. If it is not recorded, returns the next recorded step of the
  /// episode, or its last one.
  /// @param shown the step that is shown now. If several runs have the requested episode index, the
  ///        run of `shown` is preferred, then the first run with its seed, then the first run.
  /// @returns nullopt if the bag does not contain the episode
  std::optional<Step> Find(const Step& shown, std::uint64_t episode, std::uint64_t step) const;

  /// Returns the positions of the messages that must be published to show a step. The first is the
  /// spec of the episode, if it is recorded. Then follow, in ascending order, the newest message of
  /// each other topic up to the step, and up to kMaxStates earlier states of the run, for trails
  /// and routes. The last position is that of the state of the step.
  std::vector<std::size_t> UpTo(const Step& step) const;

  /// Returns warnings about the bag, one line each: missing steps, and a bag of another version.
  /// @param version version of aquafarm that is running
  std::vector<std::string> Notes(const std::string& version) const;

  /// Returns the mean bag time between two steps of a run [s]; 0.1 if it cannot be computed.
  double StepPeriod_s(std::size_t run) const;

 private:
  struct Spec {
    std::size_t position{};
    std::uint64_t seed{};
    std::uint64_t episode{};
  };

  void Read(const std::string& path);
  /// Adds a state. @param message the message that contains it, the next one in time order
  void AddStep(const rosbag::MessageInstance& message, const aquafarm_msgs::FarmState& state);
  std::optional<std::size_t> SpecOf(const Step& step) const;  // nullopt: not recorded

  rosbag::Bag bag_;
  rosbag::View view_;
  std::vector<rosbag::MessageInstance> messages_;
  std::vector<Step> steps_;
  std::vector<Spec> specs_;
  std::map<std::string, Step> last_;  // the last state that was read, by topic
  std::size_t runs_{};                // number of runs found so far
  std::uint64_t missing_{};           // number of missing steps between recorded ones
  std::set<std::string> versions_;    // versions of aquafarm that recorded the bag
};

}  // namespace aquafarm_viz
