// SPDX-License-Identifier: BSD-3-Clause
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/TrainingStatus.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "aquafarm/base/version.h"
#include "aquafarm_sim/bags/read_bag.h"
#include "aquafarm_viz/draw/image.h"
#include "aquafarm_viz/draw/video.h"
#include "aquafarm_viz/names.h"
#include "aquafarm_viz/scene/labels.h"
#include "aquafarm_viz/scene/pairing.h"

namespace {

using aquafarm_msgs::FarmState;
using aquafarm_viz::names::kChoice;
using aquafarm_viz::names::kSpec;
using aquafarm_viz::names::kState;
using aquafarm_viz::names::kTraining;
using aquafarm_viz::names::kValuePoints;

constexpr int kBadInput = 2;
constexpr int kStorage = 3;

struct Request {
  std::string bag;
  std::string asked;  // the user's bag if `bag` is a copy with choices of a policy; else empty
  std::string output{"farm.png"};
  std::string ns;                    // empty: the bag must contain only one ranch
  std::vector<std::uint64_t> steps;  // empty: step 0 in a picture, all steps in a video
  bool at_end{};                     // true: the last step instead of `steps`
  bool is_stacked{};                 // true: several steps are below each other
  double rate_hz{10.0};
  std::uint64_t every{1};
  aquafarm_viz::Layers layers;
  std::optional<std::uint64_t> episode;
  aquafarm_viz::ImageSize size;
  std::string style{"dark"};
};

// The recorded steps before and after a requested step that is missing. They belong to the first
// episode with a recorded step after the requested one.
struct Gap {
  std::uint64_t step{};  // the requested step
  std::uint64_t episode{};
  std::optional<std::uint64_t> before;  // nullopt if the episode starts later
  std::optional<std::uint64_t> after;   // nullopt until a later step is found

  void See(const FarmState& state) {
    if (after) return;
    if (state.episode != episode) before.reset();
    episode = state.episode;
    if (state.step < step) before = state.step;
    if (state.step > step) after = state.step;
  }
};

// The content of the bag, for messages.
struct Found {
  std::uint64_t values{};   // number of messages of values/points
  std::uint64_t choices{};  // number of messages of choice
  std::uint64_t states{};   // number of states with a spec
  std::uint64_t first_episode{};
  std::uint64_t last_episode{};
  std::uint64_t last_step{};
  std::uint64_t gaps{};                // number of missing steps between recorded ones
  std::optional<std::string> version;  // aquafarm version that recorded the bag
};

// Returns the path of the bag that the user has given.
const std::string& Name(const Request& request) {
  return request.asked.empty() ? request.bag : request.asked;
}

std::string Missing(const Request& request, const Found& found, const std::vector<Gap>& gaps = {}) {
  if (found.states == 0) {
    return Name(request) + ": got no episode with a spec and states, expected at least one";
  }
  for (const Gap& gap : gaps) {
    if (!gap.after) continue;
    const std::string after = std::to_string(*gap.after);
    return Name(request) + ": no step " + std::to_string(gap.step) + "; episode " +
           std::to_string(gap.episode) +
           (gap.before
                ? " has steps " + std::to_string(*gap.before) + " and " + after + " around it"
                : " begins with step " + after) +
           "; run 'verify' for details";
  }
  return Name(request) + ": no such step; the bag has episodes " +
         std::to_string(found.first_episode) + " to " + std::to_string(found.last_episode) +
         " and steps up to " + std::to_string(found.last_step) +
         " (some of them may not be recorded)";
}

// Returns the namespace of the topic `state` in the bag, with a slash at its end. It may be empty.
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
  if (prefixes.size() == 1) {
    rosbag::View specs(bag, rosbag::TopicQuery(*prefixes.begin() + kSpec));
    for (const auto* connection : specs.getConnections()) {
      if (connection->datatype == ros::message_traits::datatype<aquafarm_msgs::FarmSpec>()) {
        return *prefixes.begin();
      }
    }
    throw std::runtime_error(Name(request) + aquafarm_sim::NoSpec(bag));
  }
  std::string all;
  for (const auto& prefix : prefixes) all += " " + prefix;
  throw std::runtime_error(request.bag + ": contains several ranches, select one with --ns:" + all);
}

/// The input of one picture: a state, its spec and the optional content.
struct Scene {
  const aquafarm_msgs::FarmSpec& spec;
  const FarmState& state;
  aquafarm_viz::Overlays overlays;
};

/// Calls `look` for each state of the bag, or only for those of the requested episode.
/// @param look returns false to stop
Found ForEachScene(const Request& request, const std::function<bool(const Scene&)>& look) {
  rosbag::Bag bag;
  aquafarm_sim::OpenBag<aquafarm_msgs::FarmSpec, FarmState, aquafarm_msgs::TrainingStatus,
                        sensor_msgs::PointCloud2, aquafarm_msgs::PolicyChoice>(bag, request.bag);
  const std::string prefix = FindPrefix(bag, request);
  rosbag::View view(bag, rosbag::TopicQuery({prefix + kSpec, prefix + kState, prefix + kTraining,
                                             prefix + kValuePoints, prefix + kChoice}));
  aquafarm_viz::Pairing pairing;
  aquafarm_viz::Trail trail;
  aquafarm_viz::Trail route(aquafarm_viz::Trail::kWhole);
  aquafarm_msgs::TrainingStatusConstPtr training;
  std::optional<aquafarm_viz::Values> values;
  sensor_msgs::PointCloud2ConstPtr cloud;  // is read with the next state, when its spec is known
  aquafarm_msgs::PolicyChoiceConstPtr choice;
  Found found;
  const auto expect_none = [&](const std::string& fault) {
    if (!fault.empty()) throw std::runtime_error(Name(request) + ": " + fault);
  };
  std::uint64_t last_step = 0;
  for (const auto& message : view) {
    if (const auto spec = aquafarm_sim::Instantiate<aquafarm_msgs::FarmSpec>(message)) {
      found.version = spec->version;
      expect_none(pairing.AddSpec(spec));
    } else if (const auto status =
                   aquafarm_sim::Instantiate<aquafarm_msgs::TrainingStatus>(message)) {
      training = status;
    } else if (const auto points = aquafarm_sim::Instantiate<sensor_msgs::PointCloud2>(message)) {
      cloud = points;
      ++found.values;
    } else if (const auto chosen =
                   aquafarm_sim::Instantiate<aquafarm_msgs::PolicyChoice>(message)) {
      choice = chosen;
      ++found.choices;
    }
    const auto state = aquafarm_sim::Instantiate<FarmState>(message);
    if (state == nullptr) continue;
    expect_none(pairing.AddState(state));
    if (pairing.shown().state != state) continue;
    trail.Update(*state);
    route.Update(*state);
    if (found.states > 0 && state->episode == found.last_episode && state->step > last_step + 1) {
      found.gaps += state->step - last_step - 1;
    }
    last_step = state->step;
    if (found.states++ == 0) found.first_episode = state->episode;
    found.last_episode = state->episode;
    found.last_step = std::max(found.last_step, state->step);
    if (request.episode && *request.episode != state->episode) continue;
    const aquafarm_msgs::FarmSpec& spec = *pairing.shown().spec;
    if (cloud != nullptr) values = aquafarm_viz::ReadValues(*std::exchange(cloud, nullptr), spec);
    if (values) values->Pair(*state);
    if (!look({spec,
               *state,
               {&trail, training.get(), &route, request.layers, values ? &*values : nullptr,
                choice.get()}})) {
      break;
    }
  }
  return found;
}

/// Warns about missing steps, about a bag of another version, and about requested values or moves
/// that the bag lacks.
void WarnOfMissing(const Request& request, const Found& found) {
  if (found.gaps > 0) {
    std::fprintf(stderr, "render: %s: %s\n", Name(request).c_str(),
                 aquafarm_viz::MissingSteps(found.gaps).c_str());
  }
  if (found.version && *found.version != aquafarm::kVersion) {
    std::fprintf(stderr, "render: %s: %s, this is %s; drawn nevertheless\n", Name(request).c_str(),
                 aquafarm_sim::RecordedBy(*found.version).c_str(), aquafarm::kVersion);
  }
  if (found.values > 0 || !(request.layers.values || request.layers.moves)) return;
  if (found.choices > 0) {
    std::fprintf(stderr,
                 "render: %s: got choices of a policy but no values/points for what is drawn, so "
                 "layers values and moves are left out\n",
                 Name(request).c_str());
    return;
  }
  std::fprintf(stderr,
               "render: %s: no topic values/points, so layers values and moves are left out; "
               "'./aquafarm render %s --policy RUN' computes them with a policy\n",
               request.bag.c_str(), request.bag.c_str());
}

/// Returns the size of one picture. Pictures next to each other are usually shown smaller, so their
/// texts are larger.
aquafarm_viz::ImageSize SizeOfOne(const Request& request) {
  constexpr double kTextScaleOfSeveral = 1.2;
  aquafarm_viz::ImageSize size = request.size;
  const bool are_several = !request.at_end && request.steps.size() > 1;
  if (are_several && !request.is_stacked) size.text_scale = kTextScaleOfSeveral;
  return size;
}

/// Draws the requested steps of one episode next to each other, or below each other if is_stacked.
void RenderPicture(const Request& request) {
  if (!cv::haveImageWriter(request.output)) {
    throw std::runtime_error(request.output +
                             ": got an unknown extension, "
                             "expected .png, .jpg, .mp4, .webm or .gif");
  }
  const std::vector<std::uint64_t> steps =
      request.steps.empty() ? std::vector<std::uint64_t>{0} : request.steps;
  aquafarm_viz::FarmPainter painter(SizeOfOne(request), aquafarm_viz::StyleByName(request.style));
  std::vector<cv::Mat> pictures(request.at_end ? 1 : steps.size());
  std::optional<std::uint64_t> episode;  // the first episode that has one of the steps
  std::size_t missing = pictures.size();
  std::vector<Gap> gaps(pictures.size());
  for (std::size_t i = 0; i < gaps.size(); ++i) gaps[i].step = steps[i];
  const Found found = ForEachScene(request, [&](const Scene& scene) {
    if (episode && *episode != scene.state.episode) return true;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      const bool asked = request.at_end ? scene.state.terminated || scene.state.truncated
                                        : scene.state.step == steps[i];
      if (!pictures[i].empty()) continue;
      if (!asked) {
        if (!request.at_end) gaps[i].See(scene.state);
        continue;
      }
      pictures[i] = painter.Draw(scene.spec, scene.state, scene.overlays).clone();
      gaps[i] = {};
      episode = scene.state.episode;
      --missing;
    }
    return missing > 0;
  });
  if (missing > 0) throw std::runtime_error(Missing(request, found, gaps));
  WarnOfMissing(request, found);
  cv::Mat picture;
  constexpr int kGutter_px = 6;
  for (std::size_t i = 1; i < pictures.size(); ++i) {
    cv::copyMakeBorder(pictures[i], pictures[i], request.is_stacked ? kGutter_px : 0, 0,
                       request.is_stacked ? 0 : kGutter_px, 0, cv::BORDER_CONSTANT,
                       cv::Scalar::all(0x80));
  }
  request.is_stacked ? cv::vconcat(pictures, picture) : cv::hconcat(pictures, picture);
  const std::filesystem::path output(request.output);
  std::vector<std::uint8_t> bytes;
  cv::imencode(output.extension().string(), picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9});
  const std::string temporary = request.output + ".part";
  std::ofstream file(temporary, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(temporary, output, error);
  if (!file || error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw aquafarm_viz::StorageError(request.output + ": could not be written");
  }
}

/// Writes a video of one episode. Its last picture is shown for two more seconds.
void RenderVideo(Request request) {
  request.size.width -= request.size.width % 2;  // codecs require even sizes
  request.size.height -= request.size.height % 2;
  aquafarm_viz::FarmPainter painter(request.size, aquafarm_viz::StyleByName(request.style));
  std::unique_ptr<aquafarm_viz::Video> video;
  std::optional<std::uint64_t> episode;
  cv::Mat last;
  const Found found = ForEachScene(request, [&](const Scene& scene) {
    if (episode && *episode != scene.state.episode) return false;
    episode = scene.state.episode;
    const bool over = scene.state.terminated || scene.state.truncated;
    if (scene.state.step % request.every != 0 && !over) return true;
    const cv::Mat& picture = painter.Draw(scene.spec, scene.state, scene.overlays);
    if (video == nullptr)
      video = aquafarm_viz::Video::Open(request.output, picture.size(), request.rate_hz);
    video->Add(picture);
    picture.copyTo(last);
    return true;
  });
  if (video == nullptr) throw std::runtime_error(Missing(request, found));
  WarnOfMissing(request, found);
  for (int i = 0; i < cvRound(2.0 * request.rate_hz); ++i) video->Add(last);
  video->Close();
}

/// Adds the options for the look of a picture.
void AddLook(CLI::App& app, Request& request, std::string& layers) {
  app.add_option("--layers", layers,
                 "some of " + aquafarm_viz::LayerNames() + ", separated by commas; or none")
      ->capture_default_str();
  app.add_option("--style", request.style, "dark for screens, light for print")
      ->check(CLI::IsMember({"dark", "light"}))
      ->capture_default_str();
  app.add_option("--width", request.size.width, "pixels")
      ->check(CLI::Range(aquafarm_viz::kMinImageSide, aquafarm_viz::kMaxImageSide))
      ->capture_default_str();
  app.add_option("--height", request.size.height, "pixels")
      ->check(CLI::Range(aquafarm_viz::kMinImageSide, aquafarm_viz::kMaxImageSide))
      ->capture_default_str();
  app.add_flag_callback(
      "--no-panel", [&request] { request.size.has_panel = false; },
      "no lists and inset, so that the map is larger");
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  std::string layers{"trail,risk,labels"};
  CLI::App app(
      "Draws steps of a recorded ranch as a picture (png, jpg), side by side if there are "
      "several,\n"
      "or an episode as a video (mp4, webm, gif). Needs no ROS master.",
      "render");
  app.add_option("--bag,bag", request.bag, "bag with spec and state")->required();
  app.add_option("-o,--output", request.output, "file to write; its extension selects the format")
      ->capture_default_str();
  auto* step = app.add_option("--step", request.steps, "step of the episode (default 0)");
  app.add_flag("--end", request.at_end, "the last step of the episode")->excludes(step);
  app.add_flag("--stacked", request.is_stacked,
               "several steps below each other, so that they stay readable in a narrow page");
  AddLook(app, request, layers);
  app.add_option("--fps", request.rate_hz, "video: pictures per second")
      ->check(CLI::Range(0.5, 60.0))
      ->capture_default_str();
  app.add_option("--every", request.every, "video: number of steps from one picture to the next")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_option("--episode", request.episode,
                 "episode (default: the first one that has the step)");
  app.add_option("--asked", request.asked)->group("");  // hidden; for render --policy
  app.add_option("--ns", request.ns, "namespace of the ranch (default: the only one in the bag)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInput;
  }
  try {
    if (aquafarm_viz::Video::Is(request.output) && (request.at_end || step->count() > 0)) {
      throw std::runtime_error(std::string(request.at_end ? "--end" : "--step") +
                               ": expected no value with a video, which shows a whole episode");
    }
    request.layers = aquafarm_viz::ParseLayers(layers);
    aquafarm_sim::ReadingBag(request.bag, [&] {
      aquafarm_viz::Video::Is(request.output) ? RenderVideo(request) : RenderPicture(request);
    });
  } catch (const aquafarm_viz::StorageError& fault) {
    std::fprintf(stderr, "render: %s\n", fault.what());
    return kStorage;
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "render: %s\n", fault.what());
    return kBadInput;
  }
  return 0;
}
