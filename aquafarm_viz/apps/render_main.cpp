// SPDX-License-Identifier: BSD-3-Clause
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/TrainingStatus.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <set>
#include <stdexcept>

#include "aquafarm_viz/image.h"
#include "aquafarm_viz/names.h"
#include "aquafarm_viz/pairing.h"

namespace {

using aquafarm_msgs::FarmState;
using aquafarm_viz::names::kSpec;
using aquafarm_viz::names::kState;
using aquafarm_viz::names::kTraining;

struct Request {
  std::string bag;
  std::string output{"farm.png"};
  std::string ns;  // empty: the only one there is
  std::uint64_t step{};
  bool at_end{};
  std::optional<std::uint64_t> episode;
  aquafarm_viz::ImageSize size;
};

// What the bag holds, to say what may be asked for.
struct Found {
  std::uint64_t states{};
  std::uint64_t first_episode{};
  std::uint64_t last_episode{};
  std::uint64_t last_step{};
};

std::string Missing(const Request& request, const Found& found) {
  if (found.states == 0) return request.bag + ": no state follows the spec of its episode";
  return request.bag + ": no such step; the bag has episodes " +
         std::to_string(found.first_episode) + " to " + std::to_string(found.last_episode) +
         " and steps up to " + std::to_string(found.last_step) +
         " (not each of them need be recorded)";
}

// What stands before the topic `state` in the bag; bags hold names with and without a namespace.
std::string FindPrefix(const rosbag::Bag& bag, const Request& request) {
  const std::string wanted =
      request.ns.empty() || request.ns.back() == '/' ? request.ns : request.ns + "/";
  const std::string state = kState;
  std::set<std::string> prefixes;
  rosbag::View view(bag, rosbag::TypeQuery(ros::message_traits::datatype<FarmState>()));
  for (const auto* connection : view.getConnections()) {
    const std::string& topic = connection->topic;
    if (topic.size() < state.size()) continue;
    const std::string prefix = topic.substr(0, topic.size() - state.size());
    if (prefix + state != topic || (!prefix.empty() && prefix.back() != '/')) continue;
    if (wanted.empty() || prefix == wanted) prefixes.insert(prefix);
  }
  if (prefixes.empty()) {
    throw std::runtime_error(request.bag + ": no topic " + (wanted.empty() ? "" : wanted) + state +
                             " of type " + ros::message_traits::datatype<FarmState>());
  }
  if (prefixes.size() == 1) return *prefixes.begin();
  std::string all;
  for (const auto& prefix : prefixes) all += " " + prefix;
  throw std::runtime_error(request.bag + ": holds several ranches, choose one with --ns:" + all);
}

cv::Mat Render(const Request& request) {
  rosbag::Bag bag(request.bag, rosbag::bagmode::Read);
  const std::string prefix = FindPrefix(bag, request);
  rosbag::View view(bag, rosbag::TopicQuery({prefix + kSpec, prefix + kState, prefix + kTraining}));
  aquafarm_viz::Pairing pairing;
  aquafarm_viz::Wake wake;
  aquafarm_viz::FarmPainter painter(request.size);
  aquafarm_msgs::TrainingStatusConstPtr training;
  Found found;
  cv::Mat last;
  for (const auto& message : view) {
    if (const auto spec = message.instantiate<aquafarm_msgs::FarmSpec>()) {
      if (const auto fault = pairing.AddSpec(spec); !fault.empty()) throw std::runtime_error(fault);
    } else if (const auto status = message.instantiate<aquafarm_msgs::TrainingStatus>()) {
      training = status;
    }
    const auto state = message.instantiate<FarmState>();
    if (state == nullptr) continue;
    if (const auto fault = pairing.AddState(state); !fault.empty()) throw std::runtime_error(fault);
    if (pairing.shown().state != state) continue;
    wake.Update(*state);
    if (found.states++ == 0) found.first_episode = state->episode;
    found.last_episode = state->episode;
    found.last_step = std::max(found.last_step, state->step);
    if (request.episode && *request.episode != state->episode) continue;
    const bool asked =
        request.at_end ? state->terminated || state->truncated : state->step == request.step;
    if (asked) return painter.Draw(*pairing.shown().spec, *state, {&wake, training.get()}).clone();
  }
  throw std::runtime_error(Missing(request, found));
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  CLI::App app("Draws one step of a recorded ranch as a picture.", "render");
  app.add_option("--bag", request.bag, "bag with spec and state")->required();
  app.add_option("-o,--output", request.output, "picture to write, by its ending: png, jpg")
      ->capture_default_str();
  auto* step = app.add_option("--step", request.step, "step of the episode")->capture_default_str();
  app.add_flag("--end", request.at_end, "the episode's last step")->excludes(step);
  app.add_option("--episode", request.episode, "episode (default: the first that has the step)");
  app.add_option("--ns", request.ns, "namespace of the ranch (default: the only one in the bag)");
  app.add_option("--width", request.size.width, "pixels")
      ->check(CLI::Range(aquafarm_viz::kMinImageSide, aquafarm_viz::kMaxImageSide))
      ->capture_default_str();
  app.add_option("--height", request.size.height, "pixels")
      ->check(CLI::Range(aquafarm_viz::kMinImageSide, aquafarm_viz::kMaxImageSide))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    const cv::Mat picture = Render(request);
    if (!cv::imwrite(request.output, picture, {cv::IMWRITE_PNG_COMPRESSION, 9})) {
      throw std::runtime_error(request.output + ": could not be written");
    }
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "render: %s\n", fault.what());
    return 1;
  }
  return 0;
}
