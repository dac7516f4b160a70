// SPDX-License-Identifier: BSD-3-Clause
#include <aquafarm_msgs/TrainingStatus.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/param.h>
#include <unistd.h>

#include <climits>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <regex>

#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/ranks/process_group.h"
#include "aquafarm/agents/training/progress_text.h"
#include "aquafarm/agents/training/run.h"
#include "aquafarm/base/check.h"
#include "aquafarm/scenario/limits.h"
#include "aquafarm_agents/link/duplicate_node.h"
#include "aquafarm_agents/link/ros_environment.h"
#include "aquafarm_agents/nodes/node.h"
#include "aquafarm_agents/nodes/signals.h"
#include "aquafarm_agents/values/values_publisher.h"
#include "aquafarm_sim/names.h"
#include "aquafarm_sim/params.h"

namespace aquafarm_agents {
namespace {

namespace agents = aquafarm::agents;
using agents::ExitCode;
using agents::RunPhase;
using aquafarm_msgs::TrainingStatus;

constexpr double kPrintPeriod_s = 10.0;    // between two lines of progress
constexpr double kTerminalPeriod_s = 1.0;  // between two updates of the line on a terminal

struct TrainParams {
  agents::RunOptions run;
  RosEnvironmentOptions environment;
  agents::GroupTimes times;
  double values_period_s{2.0};
};

TrainParams ReadTrainParams(const ros::NodeHandle& node) {
  TrainParams params;
  aquafarm_sim::Params reader(node);
  int episodes = 0;
  int seed = 1;
  double steps = 0.0;  // integer parameters are limited to 32 bits
  reader.Text("algorithm", params.run.algorithm);
  reader.Text("exploration", params.run.exploration);
  reader.Text("options", params.run.options);
  reader.Text("init", params.run.init);
  reader.Text("credit", params.run.credit);
  reader.Int("episodes", 0, INT_MAX, episodes);
  reader.Number("steps", 0.0, 1e15, steps);
  reader.Int("seed", 0, INT_MAX, seed);
  reader.Int("farms", 0, aquafarm::kMaxFarms, params.environment.farms);
  reader.Text("run_dir", params.run.run_dir);
  reader.Flag("resume", params.run.resume);
  reader.Number("checkpoint_period_s", 0.0, 86400.0, params.run.checkpoint_period_s);
  reader.Int("evaluation_episodes", 0, 10000000, params.run.evaluation_episodes);
  reader.Int("random_episodes", 0, 10000000, params.run.random_episodes);
  reader.Number("sim_timeout_s", 0.0, 86400.0, params.environment.wait_limit_s);
  reader.Number("call_limit_s", 0.1, 86400.0, params.environment.call_limit_s);
  reader.Number("rank_start_s", 1.0, 86400.0, params.times.start_s);
  reader.Number("rank_answer_s", 1.0, 86400.0, params.times.answer_s);
  reader.Number("values_period_s", 0.0, 86400.0, params.values_period_s);
  reader.RefuseOthers();
  if (params.environment.wait_limit_s >= params.times.answer_s && std::getenv("RANK") != nullptr) {
    ROS_WARN(
        "~rank_answer_s: got %g s, expected more than ~sim_timeout_s, %g s, or a rank that "
        "waits for its sim node is reported as lost",
        params.times.answer_s, params.environment.wait_limit_s);
  }
  params.run.episodes = static_cast<std::uint64_t>(episodes);
  params.run.steps = static_cast<std::uint64_t>(steps);
  params.run.seed = static_cast<std::uint64_t>(seed);
  params.run.arguments = reader.given();
  if (params.run.run_dir.empty()) params.run.run_dir = agents::NewRunFolder();
  return params;
}

std::uint8_t PhaseOf(RunPhase phase, ExitCode code) {
  switch (phase) {
    case RunPhase::kStarting:
      return TrainingStatus::STARTING;
    case RunPhase::kTraining:
      return TrainingStatus::TRAINING;
    case RunPhase::kEvaluating:
      return TrainingStatus::EVALUATING;
    case RunPhase::kEnded:
      break;
  }
  if (code == ExitCode::kOk) return TrainingStatus::DONE;
  return code == ExitCode::kInterrupted ? TrainingStatus::INTERRUPTED : TrainingStatus::FAILED;
}

TrainingStatus ToMsg(const agents::RunStatus& status, const agents::RunOptions& options,
                     ExitCode code) {
  const agents::TrainingProgress& progress = status.progress;
  TrainingStatus message;
  message.header.stamp = ros::Time::now();
  message.phase = PhaseOf(status.phase, code);
  message.algorithm = status.algorithm;
  message.run_dir = options.run_dir;
  message.message = status.message;
  message.episode = progress.episodes;
  message.episodes = progress.episode_limit;
  message.steps = progress.steps;
  message.last_return = progress.last_return;
  message.mean_return = progress.mean_return;
  message.best_mean_return = progress.best_mean_return;
  message.success_rate = progress.success_rate;
  message.evaluation_return = message.evaluation_success = std::nanf("");
  if (status.has_evaluation) {
    message.evaluation_return = static_cast<float>(status.evaluation.mean_return);
    message.evaluation_success = static_cast<float>(status.evaluation.success_rate);
  }
  message.loss = progress.learner.loss;
  message.exploration = progress.learner.exploration;
  message.learning_rate = progress.learner.learning_rate;
  message.steps_per_second = static_cast<float>(progress.steps_per_second);
  message.elapsed_s = progress.elapsed_s;
  message.time_left_s = progress.time_left_s;
  return message;
}

/// Prints the progress: on a terminal one line that is updated, elsewhere a line every 10 s.
class ProgressLine {
 public:
  ~ProgressLine() { Close(); }

  /// Prints the progress if its period has passed.
  void Print(const agents::TrainingProgress& progress) {
    const ros::WallTime now = ros::WallTime::now();
    const double period_s = terminal_ ? kTerminalPeriod_s : kPrintPeriod_s;
    if (!printed_.isZero() && (now - printed_).toSec() < period_s) return;
    printed_ = now;
    const std::string text = agents::DescribeProgress(progress);
    if (terminal_) {
      std::printf("\r%s\033[K", text.c_str());
      std::fflush(stdout);
      open_ = true;
    } else {
      ROS_INFO("%s", text.c_str());
    }
  }

  /// Ends the line, so that other text can follow.
  void Close() {
    if (open_) std::printf("\n");
    std::fflush(stdout);
    open_ = false;
  }

 private:
  const bool terminal_{isatty(STDOUT_FILENO) == 1};
  bool open_{false};
  ros::WallTime printed_;
};

/// Publishes every status on a topic, and prints the progress periodically.
class StatusReporter {
 public:
  /// @param prints whether the progress is also printed, as on rank 0
  StatusReporter(ros::NodeHandle& node, agents::RunOptions options, bool prints)
      : options_(std::move(options)),
        prints_(prints),
        publisher_(node.advertise<TrainingStatus>(aquafarm_sim::names::kTraining, 10, true)) {}

  void Notify(const agents::RunStatus& status) {
    last_ = status;
    Publish(ToMsg(status, options_, ExitCode::kOk));
    if (!prints_) return;
    if (!status.message.empty()) {
      line_.Close();
      ROS_INFO("%s", status.message.c_str());
    }
    if (status.phase == RunPhase::kTraining) line_.Print(status.progress);
  }

  void Warn(const std::string& text) {
    line_.Close();
    ROS_WARN("%s", text.c_str());
    TrainingStatus message = ToMsg(last_, options_, ExitCode::kOk);
    message.phase = TrainingStatus::WAITING;
    message.message = text;
    Publish(message);
  }

  void End(const agents::RunReport& report) {
    line_.Close();
    Publish(ToMsg(report.status, options_, report.code));
    ros::WallDuration(0.2).sleep();  // lets the last status be sent before the node exits
  }

 private:
  void Publish(const TrainingStatus& message) { publisher_.publish(message); }

  const agents::RunOptions options_;
  const bool prints_;
  ros::Publisher publisher_;
  agents::RunStatus last_;
  ProgressLine line_;
};

agents::RunReport Train(ros::NodeHandle& node, TrainParams params, agents::ProcessGroup* group) {
  StatusReporter reporter(node, params.run, group == nullptr || group->rank() == 0);
  ValuesPublisher values(node, params.values_period_s);
  params.environment.stop = &stop_requested;
  params.environment.on_notice = [&reporter](const std::string& text) { reporter.Warn(text); };
  const auto make = [&node, &params](std::uint8_t observation_types) {
    RosEnvironmentOptions options = params.environment;
    options.observation_types = observation_types;
    return std::make_unique<RosEnvironment>(node, options);
  };
  const auto make_share = [&node, &params, group](std::uint8_t observation_types) {
    RosEnvironmentOptions options = params.environment;
    options.observation_types = observation_types;
    options.share = agents::ShareOfRank(options.farms, group->rank(), group->size());
    options.farms /= group->size();
    return std::make_unique<RosEnvironment>(node, options);
  };
  std::optional<agents::RankedRun> ranked;
  if (group != nullptr) ranked.emplace(agents::RankedRun{*group, make_share});
  agents::RunReport report = agents::Train(
      params.run, make,
      [&reporter, &values](const agents::RunStatus& status) {
        if (status.phase != RunPhase::kEnded) reporter.Notify(status);
        if (status.learner == nullptr) return;
        values.Refresh([&status] { return status.learner->GreedyPolicy(); });
      },
      &stop_requested, ranked ? &*ranked : nullptr);
  reporter.End(report);
  return report;
}

/// Connects to the other ranks: processes that train the same learner, each with its own sim node.
/// Returns null if this process trains alone.
std::unique_ptr<agents::ProcessGroup> JoinRanks(const TrainParams& params) {
  const agents::RankVariables variables =
      agents::ReadRankVariables([](const char* name) { return std::getenv(name); });
  if (variables.world_size < 2) return nullptr;
  agents::CheckRanks(params.run.algorithm, variables.world_size, variables.launcher);
  if (params.environment.farms == 0) {
    throw aquafarm::InputError("~farms: got 0 with " + std::to_string(variables.world_size) +
                               " ranks, expected the number of farms of all ranks");
  }
  return agents::JoinProcessGroup(variables, params.times);
}

int End(ExitCode code, const std::string& summary) {
  std::fprintf(code == ExitCode::kOk ? stdout : stderr, "%s", summary.c_str());
  std::fflush(stdout);
  return static_cast<int>(code);
}

/// Returns " name:=value" for a shell. The value is in quotes if it contains special characters.
std::string Argument(const std::string& name, const std::string& value) {
  static const std::regex special(R"(["\\$`])");
  const bool is_plain = value.find_first_of(" '\"\\$`;&|<>()*?#!") == std::string::npos;
  return ' ' + name +
         ":=" + (is_plain ? value : '"' + std::regex_replace(value, special, "\\$&") + '"');
}

/// Returns the launch arguments with the settings that a resumed run must repeat, each after a
/// space.
std::string Arguments(const agents::RunReport& report, const agents::RunOptions& run) {
  const agents::RunOptions defaults;
  std::string text = Argument("scenario", run.run_dir + "/scenario.yaml");
  const auto add = [&text](const std::string& name, const std::string& value, bool differs) {
    if (differs) text += Argument(name, value);
  };
  const std::string& algorithm = report.status.algorithm;
  add("algorithm", algorithm, algorithm != defaults.algorithm);
  add("options", run.options, run.options != defaults.options);
  add("exploration", run.exploration, run.exploration != defaults.exploration);
  add("credit", run.credit, run.credit != defaults.credit);
  add("seed", std::to_string(run.seed), run.seed != defaults.seed);
  add("farms", std::to_string(report.farms), report.farms != 0);
  return text;
}

/// Returns a line that suggests the next command; empty if there is none.
std::string Next(const agents::RunReport& report, const agents::RunOptions& run) {
  const char* const script = std::getenv("AQUAFARM_LAUNCHER");
  const auto launch = [script](const std::string& name) {
    return script != nullptr ? std::string(script) + " " + name
                             : "roslaunch aquafarm_bringup " + name + ".launch";
  };
  const bool can_resume = report.code == ExitCode::kInterrupted || report.code == ExitCode::kLost ||
                          report.code == ExitCode::kRankLost;
  if (can_resume) {
    if (report.farms == 0) return "";  // the training never started
    if (report.ranks > 1) {
      return "resume     roslaunch aquafarm_bringup ranks.launch" + Arguments(report, run) +
             " resume:=true" + Argument("run_dir", run.run_dir) +
             Argument("ranks", std::to_string(report.ranks)) + "\n";
    }
    // The script reads missing arguments from the run folder; roslaunch cannot.
    return "resume     " + launch("train") + (script != nullptr ? "" : Arguments(report, run)) +
           " resume:=true" + Argument("run_dir", run.run_dir) + "\n";
  }
  if (report.code != ExitCode::kOk) return "";
  return "watch it   " + launch("sim") + Argument("scenario", run.run_dir + "/scenario.yaml") +
         Argument("policy", run.run_dir) + "\n";
}

}  // namespace

int RunTrainNode() {
  try {
    RefuseTwin();  // mpirun, for example, may start several ranks with the same node name
    ros::NodeHandle node;
    const TrainParams params = ReadTrainParams(ros::NodeHandle("~"));
    const std::unique_ptr<agents::ProcessGroup> group = JoinRanks(params);
    const agents::RunReport report = Train(node, params, group.get());
    const bool is_first = group == nullptr || group->rank() == 0;
    return End(report.code, report.summary + (is_first ? Next(report, params.run) : ""));
  } catch (const agents::RankLost& error) {
    return End(ExitCode::kRankLost, std::string(error.what()) + "\n");
  } catch (const aquafarm::InputError& error) {
    return End(ExitCode::kBadInput, std::string("train_node: ") + error.what() + "\n");
  } catch (const std::exception& error) {
    return End(ExitCode::kInternal, std::string("train_node: ") + error.what() + "\n");
  }
}

}  // namespace aquafarm_agents
