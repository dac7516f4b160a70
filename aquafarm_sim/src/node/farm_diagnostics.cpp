// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/node/farm_diagnostics.h"

#include <ros/this_node.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "aquafarm/base/version.h"

namespace aquafarm_sim {
namespace {

constexpr double kPeriod_s = 1.0;

std::string Joined(const std::vector<std::int32_t>& ships) {
  std::string text;
  for (const std::int32_t ship : ships) text += (text.empty() ? "" : ", ") + std::to_string(ship);
  return text;
}

double ResidentMebibytes() {
  std::ifstream file("/proc/self/statm");
  double pages = 0.0;
  double resident = 0.0;
  file >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

// Returns the ships that became absent after the report `before` and have returned since then.
std::vector<std::int32_t> ReturnedShips(const ServerCounters& before, const ServerCounters& now) {
  std::vector<std::int32_t> ships;
  for (std::size_t i = 0; i < now.absences.size(); ++i) {
    const auto ship = static_cast<std::int32_t>(i);
    const bool is_absent = std::count(now.absent.begin(), now.absent.end(), ship) > 0;
    const std::uint64_t earlier = i < before.absences.size() ? before.absences[i] : 0;
    if (!is_absent && now.absences[i] > earlier) ships.push_back(ship);
  }
  return ships;
}

}  // namespace

FarmDiagnostics::FarmDiagnostics(ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                 FarmServer& server, const FarmPublisher& publisher,
                                 const EpisodeRecorder* recorder)
    : server_(server),
      publisher_(publisher),
      recorder_(recorder),
      updater_(ros::NodeHandle(), private_node, ros::this_node::getName()),
      seen_at_(ros::WallTime::now()) {
  updater_.setHardwareID("none");
  updater_.add("farm", this, &FarmDiagnostics::Fill);
  timer_ = node.createWallTimer(ros::WallDuration(kPeriod_s),
                                [this](const ros::WallTimerEvent&) { updater_.force_update(); });
}

void FarmDiagnostics::Fill(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ServerCounters now = server_.counters();
  const ros::WallTime time = ros::WallTime::now();
  const double elapsed_s = std::max((time - seen_at_).toSec(), 1e-3);
  const double steps_per_s = static_cast<double>(now.farm_steps - seen_.farm_steps) / elapsed_s;
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "running");
  if (now.barrier_timeouts > seen_.barrier_timeouts) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "barrier timed out");
  }
  const std::vector<std::int32_t> returned = ReturnedShips(seen_, now);
  if (!returned.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN,
                   "late ships that have returned: " + Joined(returned));
  }
  if (!now.absent.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN,
                   "late ships that the farm does not wait for until their next command: " +
                       Joined(now.absent));
  }
  const std::string lost = recorder_ == nullptr ? "" : recorder_->fault();
  if (!lost.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN,
                   "recording of episodes stopped: " + lost);
  }
  if (now.dropped_notifications > seen_.dropped_notifications) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                        "messages were not published: " + now.dropped_reason);
  }
  if (!now.fault.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR,
                   "the farm has paused itself: " + now.fault);
  }
  status.add("version", aquafarm::kVersion);
  status.add("farm steps per second", steps_per_s);
  status.add("farm steps", now.farm_steps);
  status.add("late ships", now.late_ships);
  status.add("barrier timeouts", now.barrier_timeouts);
  status.add("superseded commands", now.superseded);
  status.add("dropped clients", now.dropped_clients);
  status.add("refused requests", now.refused);
  status.add("dropped episode summaries", publisher_.dropped_summaries());
  if (recorder_ != nullptr) status.add("kept episodes", recorder_->kept());
  status.add("memory [MiB]", ResidentMebibytes());
  seen_ = now;
  seen_at_ = time;
}

}  // namespace aquafarm_sim
