// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/replay/replay.h"

#include <aquafarm_msgs/EpisodeSummary.h>
#include <aquafarm_msgs/FarmSpec.h>
#include <rosbag/player.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "aquafarm_sim/bags/read_bag.h"
#include "aquafarm_viz/scene/labels.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::EpisodeSummary;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;
namespace traits = ros::message_traits;

template <typename Message>
bool Is(const rosbag::MessageInstance& message) {
  return message.getDataType() == traits::datatype<Message>();
}

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// Returns the part of a topic up to and including its last slash.
std::string Namespace(const std::string& topic) { return topic.substr(0, topic.rfind('/') + 1); }

// The following functions handle messages that an earlier version recorded. `Message` and
// `Messages` are the message types in kOlderMessages.

template <typename Message>
bool IsOlder(const rosbag::MessageInstance& message) {
  return message.getDataType() == ros::message_traits::datatype<Message>() &&
         aquafarm_sim::IsOlderMessage(message.getDataType(), message.getMD5Sum());
}

template <typename... Messages>
ros::AdvertiseOptions OptionsOf(const rosbag::MessageInstance& message, std::uint32_t queue) {
  ros::AdvertiseOptions options = rosbag::createAdvertiseOptions(message, queue);
  const auto set = [&](const char* md5sum, const char* definition) {
    options.md5sum = md5sum;
    options.message_definition = definition;
  };
  ((IsOlder<Messages>(message)
        ? set(ros::message_traits::md5sum<Messages>(), ros::message_traits::definition<Messages>())
        : void()),
   ...);
  return options;
}

// Returns true if an earlier version recorded the message. In this case, translates the message to
// this version and publishes it; if the translation fails, publishes nothing.
template <typename... Messages>
bool PublishOlder(const rosbag::MessageInstance& message, const ros::Publisher& publisher) {
  const auto publish = [&](const auto& translated) {
    if (translated) publisher.publish(*translated);
    return true;
  };
  return ((IsOlder<Messages>(message) && publish(aquafarm_sim::Instantiate<Messages>(message))) ||
          ...);
}

}  // namespace

ros::AdvertiseOptions AdvertiseOptionsOf(const rosbag::MessageInstance& message,
                                         std::uint32_t queue) {
  return OptionsOf<FarmSpec, FarmState, EpisodeSummary>(message, queue);
}

void PublishMessage(const rosbag::MessageInstance& message, const ros::Publisher& publisher) {
  if (PublishOlder<FarmSpec, FarmState, EpisodeSummary>(message, publisher)) return;
  publisher.publish(message);
}

bool IsState(const rosbag::MessageInstance& message) {
  return Is<FarmState>(message) && !EndsWith(message.getTopic(), "/observation");
}

ReplayTape::ReplayTape(const std::string& path) {
  aquafarm_sim::ReadingBag(path, [&] { Read(path); });
}

void ReplayTape::Read(const std::string& path) {
  aquafarm_sim::OpenBag<FarmSpec, FarmState>(bag_, path);
  view_.addQuery(bag_);
  const auto connections = view_.getConnections();
  if (std::none_of(connections.begin(), connections.end(), [](const auto* connection) {
        return connection->datatype == traits::datatype<FarmSpec>();
      })) {
    throw std::runtime_error(path + aquafarm_sim::NoSpec(bag_));
  }
  for (const rosbag::MessageInstance& message : view_) {
    if (message.getTopic() == "/clock") continue;
    if (IsState(message)) {
      if (const auto state = aquafarm_sim::Instantiate<FarmState>(message))
        AddStep(message, *state);
    } else if (Is<FarmSpec>(message)) {
      if (const auto spec = aquafarm_sim::Instantiate<FarmSpec>(message)) {
        specs_.push_back({messages_.size(), spec->seed, spec->episode});
        versions_.insert(spec->version);
      }
    }
    messages_.push_back(message);
  }
  if (steps_.empty()) {
    throw std::runtime_error(path +
                             ": got no episode with a spec and states, expected at least one");
  }
}

const ReplayTape::Step& ReplayTape::At(std::size_t position) const {
  const auto after =
      std::upper_bound(steps_.begin(), steps_.end(), position,
                       [](std::size_t place, const Step& step) { return place < step.position; });
  return after == steps_.begin() ? steps_.front() : *(after - 1);
}

void ReplayTape::AddStep(const rosbag::MessageInstance& message, const FarmState& state) {
  Step step{messages_.size(), state.seed, state.episode, state.step, runs_};
  const auto last = last_.find(message.getTopic());
  const bool goes_on = last != last_.end() && last->second.seed == step.seed &&
                       last->second.episode == step.episode && last->second.step <= step.step;
  if (goes_on) {
    step.run = last->second.run;
    if (step.step > last->second.step + 1) missing_ += step.step - last->second.step - 1;
  } else {
    ++runs_;
  }
  last_[message.getTopic()] = step;
  steps_.push_back(step);
}

std::optional<ReplayTape::Step> ReplayTape::Find(const Step& shown, std::uint64_t episode,
                                                 std::uint64_t step) const {
  std::optional<std::size_t> run;
  if (episode == shown.episode) run = shown.run;
  for (const bool same_seed : {true, false}) {
    for (const Step& one : steps_) {
      if (run) break;
      if (one.episode == episode && (!same_seed || one.seed == shown.seed)) run = one.run;
    }
  }
  std::optional<Step> last;
  for (const Step& one : steps_) {
    if (!run || one.run != *run) continue;
    last = one;
    if (one.step >= step) break;
  }
  return last;
}

// Returns the position of the last spec of the step's episode that was recorded before the step. If
// there is none, returns the first spec of the episode after the step: each topic has a separate
// connection, so a spec may be recorded later than its states.
std::optional<std::size_t> ReplayTape::SpecOf(const Step& step) const {
  const std::string space = Namespace(messages_[step.position].getTopic());
  std::optional<std::size_t> found;
  for (const Spec& spec : specs_) {
    if (spec.seed != step.seed || spec.episode != step.episode) continue;
    if (Namespace(messages_[spec.position].getTopic()) != space) continue;
    if (found && spec.position > step.position) break;
    found = spec.position;
  }
  return found;
}

std::vector<std::size_t> ReplayTape::UpTo(const Step& step) const {
  std::map<std::string, std::size_t> newest;  // by topic
  std::vector<std::size_t> positions;
  std::size_t states = 0;
  for (std::size_t i = 0; i <= step.position; ++i) newest[messages_[i].getTopic()] = i;
  const std::optional<std::size_t> spec = SpecOf(step);
  if (spec) newest.erase(messages_[*spec].getTopic());
  for (const auto& [topic, position] : newest) positions.push_back(position);
  for (auto one = steps_.rbegin(); one != steps_.rend() && states < kMaxStates; ++one) {
    if (one->position >= step.position || one->run != step.run) continue;
    positions.push_back(one->position);
    ++states;
  }
  std::sort(positions.begin(), positions.end());
  positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
  if (spec) positions.insert(positions.begin(), *spec);
  return positions;
}

std::vector<std::string> ReplayTape::Notes(const std::string& version) const {
  std::vector<std::string> notes;
  if (missing_ > 0) notes.push_back(MissingSteps(missing_));
  for (const std::string& other : versions_) {
    if (other == version) continue;
    notes.push_back(aquafarm_sim::RecordedBy(other) + ", this is " + version +
                    "; shown nevertheless");
  }
  return notes;
}

double ReplayTape::StepPeriod_s(std::size_t run) const {
  const Step* first = nullptr;
  const Step* last = nullptr;
  for (const Step& one : steps_) {
    if (one.run != run) continue;
    if (first == nullptr) first = &one;
    last = &one;
  }
  constexpr double kDefault = 0.1;
  if (first == nullptr || last->step <= first->step) return kDefault;
  const double seconds =
      (messages_[last->position].getTime() - messages_[first->position].getTime()).toSec();
  return seconds > 0.0 ? seconds / double(last->step - first->step) : kDefault;
}

}  // namespace aquafarm_viz
