// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A recorded bag as something to walk about in: forwards at any rate, or straight to a step.

#include <aquafarm_msgs/FarmState.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aquafarm_viz {

/// The messages of a bag in the order of their times, and where its steps are among them.
class ReplayTape {
 public:
  /// Where a state lies.
  struct Step {
    std::size_t position{};  ///< among the messages
    std::uint64_t episode{};
    std::uint64_t step{};
  };

  /// @throws std::runtime_error in one line when there is nothing to show: no bag, another version
  explicit ReplayTape(const std::string& path);

  const std::vector<rosbag::MessageInstance>& messages() const { return messages_; }
  const std::vector<Step>& steps() const { return steps_; }  ///< never empty

  /// The step at or before a position; the first when there is none.
  const Step& At(std::size_t position) const;

  /// The step asked for, or the next later one of that episode, or its last.
  /// @returns nothing when the bag has no such episode
  std::optional<Step> Find(std::uint64_t episode, std::uint64_t step) const;

  /// What must be sent for a step to be seen as if the replay had run up to it: the newest message
  /// of each topic, and the states of its wake. Ascending positions, the step's own last.
  std::vector<std::size_t> UpTo(const Step& step) const;

  /// Seconds of the bag between two steps of an episode, above 0.
  double StepPeriod_s(std::uint64_t episode) const;

 private:
  rosbag::Bag bag_;
  rosbag::View view_;
  std::vector<rosbag::MessageInstance> messages_;
  std::vector<Step> steps_;
};

}  // namespace aquafarm_viz
