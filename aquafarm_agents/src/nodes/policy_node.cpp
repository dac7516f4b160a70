// SPDX-License-Identifier: BSD-3-Clause
#include <ros/console.h>
#include <ros/node_handle.h>

#include <algorithm>
#include <climits>
#include <cstdio>
#include <memory>

#include "aquafarm/agents/base/exit_code.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/networks/torch_runtime.h"
#include "aquafarm/agents/training/saved_policy.h"
#include "aquafarm/base/check.h"
#include "aquafarm_agents/drive/agent_driver.h"
#include "aquafarm_agents/drive/ship_driver.h"
#include "aquafarm_agents/link/duplicate_node.h"
#include "aquafarm_agents/link/ros_environment.h"
#include "aquafarm_agents/nodes/node.h"
#include "aquafarm_agents/nodes/refuse.h"
#include "aquafarm_agents/nodes/signals.h"
#include "aquafarm_agents/values/values_publisher.h"
#include "aquafarm_sim/params.h"

namespace aquafarm_agents {
namespace {

namespace agents = aquafarm::agents;
using agents::ExitCode;

std::unique_ptr<agents::Policy> MakeAndWarn(const agents::SavedPolicy& saved,
                                            const agents::EnvironmentSpec& spec) {
  auto policy = agents::MakePolicy(saved, spec);
  const std::string warning = agents::TakeTorchWarning();
  if (!warning.empty()) ROS_WARN("%s", warning.c_str());
  return policy;
}

struct PolicyParams {
  std::string policy;
  std::string mode{"evaluate"};
  std::string output;  ///< prefix of the .csv and .json files to write; empty: none
  int episodes{-1};    ///< number of episodes; act: 0 for no limit; -1: not set
  int seed{1000};
  int ship{-1};
  double sim_timeout_s{20.0};
  double values_period_s{2.0};
};

PolicyParams ReadPolicyParams(const ros::NodeHandle& node) {
  PolicyParams params;
  aquafarm_sim::Params reader(node);
  reader.Text("policy", params.policy);
  reader.Text("mode", params.mode);
  reader.Text("output", params.output);
  reader.Int("episodes", 0, 10000000, params.episodes);
  reader.Int("seed", 0, INT_MAX, params.seed);
  reader.Int("ship", -1, INT_MAX, params.ship);
  reader.Number("sim_timeout_s", 0.0, 86400.0, params.sim_timeout_s);
  reader.Number("values_period_s", 0.0, 86400.0, params.values_period_s);
  reader.RefuseOthers();
  if (params.policy.empty()) {
    throw aquafarm::InputError(
        "~policy: got nothing, expected a run folder, a checkpoint file, "
        "FILE.py, FILE.zip, generalist, random, planner, clairvoyant, do_nothing or "
        "fetch_by_value");
  }
  if (params.mode != "evaluate" && params.mode != "act") {
    throw aquafarm::InputError("~mode: got '" + params.mode + "', expected evaluate or act");
  }
  const bool evaluates = params.mode == "evaluate";
  if (evaluates && params.episodes == 0) {
    throw aquafarm::InputError("~episodes: got 0, expected [1, 10000000]");
  }
  if (params.episodes < 0) params.episodes = evaluates ? 100 : 0;
  return params;
}

ExitCode Evaluate(const ros::NodeHandle& node, const PolicyParams& params,
                  const agents::SavedPolicy& saved) {
  RosEnvironmentOptions options;
  options.observation_types = saved.observation_types;
  options.wait_limit_s = params.sim_timeout_s;
  options.stop = &stop_requested;
  options.on_notice = [](const std::string& text) { ROS_WARN("%s", text.c_str()); };
  RosEnvironment environment(node, options);
  const auto policy = MakeAndWarn(saved, environment.spec());
  ValuesPublisher values(node, params.values_period_s);
  values.Offer(agents::MakePolicy(saved, environment.spec()));
  const agents::Evaluation evaluation =
      agents::Evaluate(environment, *policy, static_cast<std::uint64_t>(params.seed),
                       params.episodes, &stop_requested, [&params](std::size_t over) {
                         ROS_INFO("%zu of %d episodes played", over, params.episodes);
                       });
  const agents::EnvironmentSpec& spec = environment.spec();
  std::printf("%s on %s: %s\n", saved.checkpoint.algorithm.c_str(), spec.scenario_name.c_str(),
              agents::Describe(evaluation).c_str());
  if (!params.output.empty()) {
    agents::WriteEvaluation(params.output, evaluation,
                            {saved.path, saved.checkpoint.algorithm, saved.checkpoint.steps,
                             spec.scenario_name, spec.scenario_hash, spec.version, spec.farms});
  }
  return evaluation.complete ? ExitCode::kOk : ExitCode::kInterrupted;
}

void ReportEnded(std::size_t successes, std::size_t episodes) {
  std::printf("%zu of %zu episodes ended with every device delivered\n", successes, episodes);
}

// Value maps are those of ship 0. If each ship has its own node, only the node of ship 0 publishes
// them.
double ValuesPeriod_s(const PolicyParams& params) {
  return params.ship > 0 ? 0.0 : params.values_period_s;
}

// Runs the agent of one ship, which receives only that ship's observation.
ExitCode ActAlone(const ros::NodeHandle& node, const PolicyParams& params,
                  const agents::SavedPolicy& saved) {
  AgentDriver driver(node, saved.observation_types,
                     {params.ship, params.sim_timeout_s, &stop_requested});
  const auto policy = MakeAndWarn(saved, driver.spec());
  ValuesPublisher values(node, ValuesPeriod_s(params));
  values.Offer(agents::MakePolicy(saved, driver.spec()));
  ROS_INFO("driving ship %d with %s", params.ship, saved.path.c_str());
  const auto ended =
      driver.Drive(*policy, static_cast<std::uint64_t>(params.seed), params.episodes);
  ReportEnded(static_cast<std::size_t>(std::count(ended.begin(), ended.end(), true)), ended.size());
  return ExitCode::kOk;
}

ExitCode Act(const ros::NodeHandle& node, const PolicyParams& params,
             const agents::SavedPolicy& saved) {
  const bool needs_whole_farm = (saved.observation_types & agents::kStatesBit) != 0;
  if (params.ship >= 0 && !needs_whole_farm) return ActAlone(node, params, saved);
  ShipDriverOptions options;
  options.ship = params.ship;
  options.wait_limit_s = params.sim_timeout_s;
  options.stop = &stop_requested;
  ShipDriver driver(node, saved.observation_types, options);
  const auto policy = MakeAndWarn(saved, driver.spec());
  ValuesPublisher values(node, ValuesPeriod_s(params));
  values.Offer(agents::MakePolicy(saved, driver.spec()));
  ROS_INFO("driving with %s", saved.path.c_str());
  const auto ended =
      driver.Drive(*policy, static_cast<std::uint64_t>(params.seed), params.episodes);
  std::size_t successes = 0;
  for (const aquafarm::EpisodeSummary& result : ended) successes += result.Success() ? 1 : 0;
  ReportEnded(successes, ended.size());
  return ExitCode::kOk;
}

}  // namespace

int RunPolicyNode() {
  try {
    RefuseTwin();
    const ros::NodeHandle node;
    const PolicyParams params = ReadPolicyParams(ros::NodeHandle("~"));
    const agents::SavedPolicy saved = agents::FindPolicy(params.policy);
    return static_cast<int>(params.mode == "act" ? Act(node, params, saved)
                                                 : Evaluate(node, params, saved));
  } catch (const aquafarm::InputError& error) {
    return Refuse("policy_node", ExitCode::kBadInput, error.what());
  } catch (const agents::StorageError& error) {
    return Refuse("policy_node", ExitCode::kStorage, error.what());
  } catch (const agents::EnvironmentLost& error) {
    return Refuse("policy_node", stop_requested ? ExitCode::kInterrupted : ExitCode::kLost,
                  error.what());
  } catch (const std::exception& error) {
    return Refuse("policy_node", ExitCode::kInternal, error.what());
  }
}

}  // namespace aquafarm_agents
