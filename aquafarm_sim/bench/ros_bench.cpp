// SPDX-License-Identifier: BSD-3-Clause
// Measures the cost of ROS: the rates of an empty service, of commands of one ship, and of farm
// steps in joint steps of 64 farms (64 times the rate of the joint steps). The servers run in
// separate processes, and connections are persistent. The three measurements alternate.
#include <aquafarm_msgs/Move.h>
#include <aquafarm_msgs/Outcome.h>
#include <aquafarm_msgs/Reset.h>
#include <aquafarm_msgs/Step.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/node_handle.h>
#include <ros/service.h>
#include <std_srvs/Empty.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "aquafarm/base/rng.h"
#include "aquafarm_sim/names.h"

namespace {

namespace fs = std::filesystem;
namespace names = aquafarm_sim::names;
using Clock = std::chrono::steady_clock;

constexpr int kRounds = 5;
constexpr double kRound_s = 1.0;
constexpr double kStartLimit_s = 30.0;  // the messages about it contain this number
constexpr int kFarms = 64;
constexpr const char* kEmpty = "empty";

/// A child process that ends with this process.
class Child {
 public:
  explicit Child(const std::vector<std::string>& command) : pid_(fork()) {
    if (pid_ != 0) return;
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    std::vector<char*> words;
    for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    if (std::freopen("/dev/null", "w", stdout) != nullptr) execvp(words[0], words.data());
    std::fprintf(stderr, "ros_bench: cannot start %s: %s; run ./aquafarm build\n", words[0],
                 std::strerror(errno));
    _exit(127);
  }
  ~Child() {
    if (pid_ <= 0) return;
    kill(pid_, SIGINT);
    for (int i = 0; i < 100; ++i) {
      if (waitpid(pid_, nullptr, WNOHANG) != 0) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

 private:
  pid_t pid_;
};

double Seconds(Clock::time_point since) {
  return std::chrono::duration<double>(Clock::now() - since).count();
}

void WaitForMaster() {
  const Clock::time_point start = Clock::now();
  while (!ros::master::check()) {
    if (Seconds(start) > kStartLimit_s)
      throw std::runtime_error("no ROS master started within 30 s; check rosmaster");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

/// Calls a service over a persistent connection.
template <typename Service>
class Client {
 public:
  Client(ros::NodeHandle& node, const std::string& name)
      : client_(node.serviceClient<Service>(name, true)) {
    const Clock::time_point start = Clock::now();
    while (!client_.isValid() || !client_.exists()) {
      if (Seconds(start) > kStartLimit_s)
        throw std::runtime_error("service " + name +
                                 " did not appear within 30 s; see the output of its server");
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      client_ = node.serviceClient<Service>(name, true);
    }
  }
  void Call(Service& call) {
    if (!client_.call(call))
      throw std::runtime_error("service " + client_.getService() +
                               " failed; see the output of its server");
  }

 private:
  ros::ServiceClient client_;
};

/// Repeats `call` for about kRound_s. Returns the number of calls per second.
double RateOf(const std::function<void()>& call) {
  const Clock::time_point start = Clock::now();
  int calls = 0;
  do {
    for (int i = 0; i < 50; ++i) call();
    calls += 50;
  } while (Seconds(start) < kRound_s);
  return calls / Seconds(start);
}

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

int ServeEmpty() {
  ros::NodeHandle node;
  const boost::function<bool(std_srvs::Empty::Request&, std_srvs::Empty::Response&)> answer =
      [](std_srvs::Empty::Request&, std_srvs::Empty::Response&) { return true; };
  const ros::ServiceServer server = node.advertiseService(kEmpty, answer);
  ros::spin();
  return 0;
}

/// Sends random moves to ship 0 of the sim node. Each command specifies its episode and step.
class ShipDriver {
 public:
  explicit ShipDriver(ros::NodeHandle& node)
      : move_(node, names::Move(0)), reset_(node, names::kReset) {
    Restart();
  }
  void Restart() {
    aquafarm_msgs::Reset reset;
    reset.request.farms = 1;
    reset_.Call(reset);
    call_.response.result.episode = reset.response.episode;
    call_.response.result.step = 0;
  }
  void Move() {
    call_.request.direction = static_cast<std::uint8_t>(random_.Below(8));
    call_.request.episode = call_.response.result.episode;
    call_.request.step = call_.response.result.step;
    move_.Call(call_);
    if (!call_.response.result.ok) throw std::runtime_error(call_.response.result.message);
    if (call_.response.result.reason != 0) Restart();
  }

 private:
  Client<aquafarm_msgs::Move> move_;
  Client<aquafarm_msgs::Reset> reset_;
  aquafarm_msgs::Move call_;
  aquafarm::RandomStream random_{{1, 0, aquafarm::RngStream::kExploration, 0}};
};

/// Steps kFarms farms with random actions and requests tabular indices.
class FarmsDriver {
 public:
  explicit FarmsDriver(ros::NodeHandle& node)
      : step_(node, names::kStep), reset_(node, names::kReset) {}
  void Restart() {
    aquafarm_msgs::Reset reset;
    reset.request.farms = kFarms;
    reset_.Call(reset);
    call_.request.observation_types = aquafarm_msgs::StepResult::INDEX;
    call_.request.actions.resize(kFarms);
  }
  void Step() {
    for (std::uint8_t& action : call_.request.actions) {
      action = static_cast<std::uint8_t>(random_.Below(10));
    }
    ++call_.request.sequence;
    step_.Call(call_);
    if (!call_.response.ok) throw std::runtime_error(call_.response.message);
  }

 private:
  Client<aquafarm_msgs::Step> step_;
  Client<aquafarm_msgs::Reset> reset_;
  aquafarm_msgs::Step call_;
  aquafarm::RandomStream random_{{2, 0, aquafarm::RngStream::kExploration, 0}};
};

void Measure() {
  const fs::path self = fs::read_symlink("/proc/self/exe");
  const std::string space = "/ros_bench_" + std::to_string(getpid());
  const Child empty_server({self, "--empty-server", "__ns:=" + space, "__name:=empty_server"});
  const Child sim({(self.parent_path() / "sim_node").string(), "__ns:=" + space, "__name:=sim",
                   "_scenario:=paper"});
  ros::NodeHandle node(space);
  Client<std_srvs::Empty> empty(node, kEmpty);
  ShipDriver ship(node);
  FarmsDriver farms(node);
  std::vector<double> empty_rates;
  std::vector<double> ship_rates;
  std::vector<double> farm_rates;
  std_srvs::Empty nothing;
  for (int round = 0; round < kRounds; ++round) {
    empty_rates.push_back(RateOf([&] { empty.Call(nothing); }));
    ship.Restart();
    ship_rates.push_back(RateOf([&] { ship.Move(); }));
    farms.Restart();
    farm_rates.push_back(kFarms * RateOf([&] { farms.Step(); }));
  }
  const double single = Median(ship_rates);
  const double joint = Median(farm_rates);
  std::printf("ros_empty_service %.0f calls/s\n", Median(empty_rates));
  std::printf("ros_single_ship %.0f farm_steps/s\n", single);
  std::printf("ros_single_ship_to_empty %.3f ratio\n", single / Median(empty_rates));
  std::printf("ros_joint_64_farms %.0f farm_steps/s\n", joint);
  std::printf("ros_joint_to_single %.1f ratio\n", joint / single);
}

}  // namespace

int main(int argc, char** argv) {
  const bool serve = argc > 1 && std::string(argv[1]) == "--empty-server";
  ros::init(argc, argv, "ros_bench", serve ? 0 : ros::init_options::AnonymousName);
  try {
    if (serve) return ServeEmpty();
    std::unique_ptr<Child> master;
    if (!ros::master::check()) {
      master = std::make_unique<Child>(
          std::vector<std::string>{"roscore", "-p", std::to_string(ros::master::getPort())});
      WaitForMaster();
    }
    Measure();
    ros::shutdown();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ros_bench: %s\n", error.what());
    return 1;
  }
}
