// SPDX-License-Identifier: BSD-3-Clause
#include "policies.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/agents/base/text.h"
#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/learning/do_nothing.h"
#include "aquafarm/agents/learning/random_policy.h"
#include "aquafarm/agents/learning/tabular.h"
#include "aquafarm/agents/planning/fetch_by_value.h"
#include "aquafarm/agents/planning/planner_policy.h"
#include "aquafarm/agents/planning/team_bound.h"
#include "aquafarm/agents/planning/team_planner.h"
#include "aquafarm/agents/rescue/plan_report.h"
#include "aquafarm/base/check.h"
#include "aquafarm/grid/step_buffers.h"
#include "arguments.h"
#include "batch.h"
#include "ppo/ppo_policy.h"
#include "ppo/token_layout.h"
#include "training/token_policy.h"
#include "turn.h"

namespace aquafarm::python {
namespace py = pybind11;
namespace {

using agents::Checkpoint;
using agents::EnvironmentSpec;
using agents::Foresight;

using Make = std::unique_ptr<agents::Policy> (*)(const Checkpoint&, const EnvironmentSpec&);

template <Foresight foresight>
std::unique_ptr<agents::Policy> MakePlanner(const Checkpoint&, const EnvironmentSpec& spec) {
  if (spec.agents > 1) return std::make_unique<agents::TeamPlannerPolicy>(spec, foresight);
  return std::make_unique<agents::PlannerPolicy>(spec, foresight);
}

template <typename T>
std::unique_ptr<agents::Policy> MakePlain(const Checkpoint&, const EnvironmentSpec& spec) {
  return std::make_unique<T>(spec);
}

/// Returns the factories of the policies that need no training, by the names that
/// aquafarm_evaluate uses.
const std::map<std::string, Make>& BuiltIn() {
  static const std::map<std::string, Make> makers{
      {"clairvoyant", MakePlanner<Foresight::kOracle>},
      {"do_nothing", MakePlain<agents::DoNothingPolicy>},
      {"fetch_by_value", MakePlain<agents::FetchByValuePolicy>},
      {"planner", MakePlanner<Foresight::kPersistence>},
      {"random", MakePlain<agents::RandomPolicy>}};
  return makers;
}

/// Returns the factories of the learned policies that do not need libtorch, by the algorithm in the
/// checkpoint.
const std::map<std::string, Make>& Learned() {
  static const std::map<std::string, Make> makers{{"mappo", agents::MakePpoPolicyWithoutTorch},
                                                  {"ppo", agents::MakePpoPolicyWithoutTorch},
                                                  {"q_learning", agents::MakeTabularPolicy},
                                                  {"sarsa", agents::MakeTabularPolicy}};
  return makers;
}

std::string NamesOf(const std::map<std::string, Make>& makers) {
  std::vector<std::string> names;
  for (const auto& [name, make] : makers) names.push_back(name);
  return agents::Join(names);
}

std::string& PolicyFolder() {
  static std::string folder;
  return folder;
}

/// Makes a learned policy. A policy that reads entity tokens (docs/generalist.md) also plays on
/// farms without view.tokens.
std::unique_ptr<agents::Policy> MakeLearned(Make make, const Checkpoint& checkpoint,
                                            const EnvironmentSpec& spec) {
  if (agents::HasTokens(checkpoint.spec) && !agents::HasTokens(spec)) {
    return std::make_unique<agents::TokenPolicy>(
        spec, [&](const EnvironmentSpec& farms) { return make(checkpoint, farms); });
  }
  return make(checkpoint, spec);
}

std::unique_ptr<agents::Policy> MakePolicy(const std::string& name, const EnvironmentSpec& spec) {
  if (const auto found = BuiltIn().find(name); found != BuiltIn().end()) {
    return found->second({}, spec);
  }
  namespace fs = std::filesystem;
  std::error_code ignored;
  const bool is_shipped = name == "generalist";
  const std::string path = is_shipped                        ? PolicyFolder() + "/generalist.ckpt"
                           : fs::is_directory(name, ignored) ? name + "/policy.ckpt"
                                                             : name;
  if (!fs::exists(path, ignored)) {
    throw InputError("policy: got '" + name + "', expected one of: " + NamesOf(BuiltIn()) +
                     ", generalist; or a run folder with policy.ckpt, or a checkpoint file");
  }
  const Checkpoint checkpoint = agents::ReadCheckpoint(path);
  const auto found = Learned().find(checkpoint.algorithm);
  if (found == Learned().end()) {
    throw InputError(path + ": got a policy of " + checkpoint.algorithm +
                     ", which this package cannot play; expected one of: " + NamesOf(Learned()) +
                     "; evaluate it with aquafarm_evaluate");
  }
  // The shipped policy may have any version. The factory that MakeLearned calls checks that the
  // policy and the farms have the same feature names.
  if (!is_shipped && checkpoint.version != spec.version) {
    throw InputError(path + ": got a policy of aquafarm " + checkpoint.version + ", expected " +
                     spec.version + "; train it again, or use the version that trained it");
  }
  try {
    return MakeLearned(found->second, checkpoint, spec);
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
}

/// A policy for all farms of a batch.
class BatchPolicy {
 public:
  BatchPolicy(const std::string& name, std::shared_ptr<const Scenario> scenario, py::handle farms,
              py::handle seed)
      : sample_(std::move(scenario), 1) {
    const auto count = static_cast<std::int32_t>(WholeNumber(
        farms, "Policy: farms", 1, Batch::kMaxFarms, "pass the number of farms of the batch"));
    spec_ = agents::MakeSpec(sample_.scenario(), sample_.encoder(), count);
    policy_ = MakePolicy(name, spec_);
    Allocate();
    Begin(seed);
  }

  void Begin(py::handle seed) {
    const Turn turn(busy_, "Policy");
    constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
    policy_->Begin(WholeNumber(seed, "Policy: seed", 0, kMax, "pass a seed of this range"),
                   spec_.farms);
  }

  py::array_t<std::uint8_t> Act(Batch& batch) {
    const Turn turn(busy_, "Policy");
    if (batch.batch().farms() != spec_.farms ||
        batch.batch().scenario().hash != spec_.scenario_hash) {
      throw InputError("Policy: got a batch of " + std::to_string(batch.batch().farms()) +
                       " farms of " + batch.batch().scenario().name + ", expected " +
                       std::to_string(spec_.farms) + " of " + spec_.scenario_name +
                       "; make the policy for this batch");
    }
    batch.InspectAll([&](FarmBatch& farms) {
      farms.Write(output_);
      for (std::size_t i = 0; i < results_.states.size(); ++i) {
        const auto farm = static_cast<std::int32_t>(i);
        copies_->farm(farm).CopyStateFrom(farms.farm(farm));
        results_.states[i] = &copies_->farm(farm);
      }
    });
    {
      const py::gil_scoped_release release;
      policy_->Act(results_, actions_);
    }
    py::array_t<std::uint8_t> actions({spec_.farms, spec_.agents});
    std::copy(actions_.begin(), actions_.end(), actions.mutable_data());
    return actions;
  }

  py::object Values() const {
    const Turn turn(busy_, "Policy");
    const std::vector<float>& values = policy_->values();
    if (values.empty()) return py::none();
    py::array_t<float> array({spec_.farms, spec_.agents});
    std::copy(values.begin(), values.end(), array.mutable_data());
    return array;
  }

 private:
  void Allocate() {
    const std::uint8_t bits =
        policy_->observation_types() &
        (agents::kIndexBit | agents::kFeaturesBit | agents::kPlanesBit | agents::kOwnRewardsBit);
    if ((bits & agents::kIndexBit) != 0 && spec_.state_count == 0) {
      throw InputError("Policy: scenario " + spec_.scenario_name +
                       " has too many states for a table, expected a policy of a network");
    }
    StepShape shape = sample_.shape();
    shape.farms = static_cast<std::size_t>(spec_.farms);
    SizeStepFields(shape, bits, results_, output_);
    if ((policy_->observation_types() & agents::kStatesBit) == 0) return;
    copies_ = std::make_unique<FarmBatch>(sample_.farm(0).shared_scenario(), spec_.farms);
    results_.states.resize(shape.farms);
  }

  FarmBatch sample_;  // one farm, for the shapes of the results
  EnvironmentSpec spec_;
  std::unique_ptr<agents::Policy> policy_;
  agents::StepResults results_;
  BatchOutput output_;
  // Copies of the farms, for policies that read states. They are needed because other threads may
  // step the batch while the policy chooses actions.
  std::unique_ptr<FarmBatch> copies_;
  std::vector<std::uint8_t> actions_;
  mutable bool busy_{};
};

/// A planner for farms of a scenario that has one agent.
class ShipPlanner {
 public:
  ShipPlanner(std::shared_ptr<const Scenario> scenario, bool clairvoyant)
      : scenario_(std::move(scenario)),
        foresight_(clairvoyant ? Foresight::kOracle : Foresight::kPersistence),
        planner_(*scenario_) {
    if (scenario_->AgentCount() != 1) {
      throw InputError("Planner: got " + std::to_string(scenario_->AgentCount()) +
                       " agents, expected 1; use Policy('planner') or Policy('clairvoyant')");
    }
  }

  py::tuple Solve(const Batch& batch, py::handle farm) {
    const auto last = static_cast<std::uint64_t>(batch.batch().farms()) - 1;
    const auto number = static_cast<std::int32_t>(
        WholeNumber(farm, "Planner: farm", 0, last, "pass the number of one farm of this batch"));
    if (batch.batch().scenario().hash != scenario_->hash) {
      throw InputError("Planner: got a batch of " + batch.batch().scenario().name + ", expected " +
                       scenario_->name + "; make a planner for this scenario");
    }
    const Turn turn(busy_, "Planner");
    agents::Plan plan;
    batch.Inspect(number, [&](const Encoder&, const Farm& shown) {
      const py::gil_scoped_release release;
      plan = planner_.Solve(shown, foresight_);
    });
    py::array_t<std::uint8_t> actions(static_cast<py::ssize_t>(plan.actions.size()));
    std::copy(plan.actions.begin(), plan.actions.end(), actions.mutable_data());
    return py::make_tuple(actions, plan.expected_return);
  }

 private:
  std::shared_ptr<const Scenario> scenario_;
  Foresight foresight_;
  agents::Planner planner_;
  bool busy_{};
};

double BoundOf(const Batch& batch, py::handle farm) {
  const auto last = static_cast<std::uint64_t>(batch.batch().farms()) - 1;
  const auto number = static_cast<std::int32_t>(
      WholeNumber(farm, "team_bound: farm", 0, last, "pass the number of one farm of this batch"));
  double bound = 0.0;
  batch.Inspect(number, [&](const Encoder&, const Farm& shown) {
    if (shown.step() != 0) {
      throw InputError("team_bound: got a farm at step " + std::to_string(shown.step()) +
                       ", expected step 0; reset it first");
    }
    const py::gil_scoped_release release;
    bound = agents::TeamBound(shown);
  });
  return bound;
}

/// Plans a rescue. Returns the content of plan.json, in the format of aquafarm_plan.
std::string PlanRescue(const std::shared_ptr<Scenario>& scenario,
                       const agents::RescueRequest& request, const std::string& command) {
  using Clock = std::chrono::steady_clock;
  const py::gil_scoped_release release;
  const Clock::time_point began = Clock::now();
  agents::RescueCase rescue = agents::MakeRescueCase(scenario, request);
  const agents::Ensemble ensemble(rescue.forecast, rescue.ensemble, rescue.Sites());
  const agents::PlanReport report = agents::MakeReport(rescue, ensemble);
  agents::PlanProvenance provenance;
  provenance.command = command;
  provenance.computed_at = request.now.value_or(0);
  provenance.compute_s = std::chrono::duration<double>(Clock::now() - began).count();
  for (const auto& [role, path] : {std::pair{"bulletin", request.bulletin},
                                   {"storm", request.storm},
                                   {"devices", request.devices},
                                   {"ships", request.ships_file}}) {
    if (!path.empty()) provenance.inputs.emplace_back(role, path);
  }
  return agents::ToJson(rescue, ensemble, report, provenance);
}

void DefineRescue(py::module_& module) {
  using agents::RescueRequest;
  py::class_<RescueRequest>(module, "_RescueRequest")
      .def(py::init<>())
      .def_readwrite("bulletin", &RescueRequest::bulletin)
      .def_readwrite("storm", &RescueRequest::storm)
      .def_readwrite("storm_name", &RescueRequest::storm_name)
      .def_readwrite("at", &RescueRequest::at)
      .def_readwrite("now", &RescueRequest::now)
      .def_readwrite("devices", &RescueRequest::devices)
      .def_readwrite("ships_file", &RescueRequest::ships_file)
      .def_readwrite("ships", &RescueRequest::ships)
      .def_readwrite("speed_kn", &RescueRequest::speed_kn)
      .def_readwrite("capacity", &RescueRequest::capacity)
      .def_readwrite("depart_s", &RescueRequest::depart_s)
      .def_readwrite("abort_wind_kt", &RescueRequest::abort_wind_kt)
      .def_readwrite("risk_averse", &RescueRequest::risk_averse)
      .def_readwrite("currency", &RescueRequest::currency)
      .def_readwrite("utc_offset_h", &RescueRequest::utc_offset_h)
      .def_readwrite("members", &RescueRequest::members)
      .def_readwrite("seed", &RescueRequest::seed);
  module.def("_plan_rescue", PlanRescue, py::arg("scenario"), py::arg("request"),
             py::arg("command"));
}

}  // namespace

void DefinePolicies(py::module_& module) {
  py::class_<BatchPolicy>(module, "Policy", R"(Chooses the actions of all agents of a batch.

name: planner, clairvoyant, fetch_by_value, do_nothing, random or generalist (docs/generalist.md);
or a run folder or checkpoint of ppo, mappo, q_learning or sarsa. planner, clairvoyant and
fetch_by_value see the complete farms. farms: number of farms of the batch.)")
      .def(py::init([](const std::string& name, std::shared_ptr<Scenario> scenario,
                       const py::object& farms, const py::object& seed) {
             return std::make_unique<BatchPolicy>(name, std::move(scenario), farms, seed);
           }),
           py::arg("name"), py::arg("scenario"), py::arg("farms") = 1, py::arg("seed") = 0)
      .def("begin", &BatchPolicy::Begin, py::arg("seed") = 0,
           "Resets the recurrent state and the random numbers. Call it after FarmBatch.reset.")
      .def("act", &BatchPolicy::Act, py::arg("batch"),
           "Returns the actions of the next step, uint8 [N, S], for FarmBatch.step.")
      .def_property_readonly("values", &BatchPolicy::Values,
                             "The value estimates of the last act, float32 [N, S]. None before the "
                             "first act, or if the policy has no values.");
  py::class_<ShipPlanner>(module, "Planner", R"(Plans for a farm with one agent.

clairvoyant=True plans with the true future of the disasters. The return of the plan is the exact
max from the present step on. clairvoyant=False plans with the forecast in force. A disaster without
a forecast is assumed to keep its heading.)")
      .def(py::init([](std::shared_ptr<Scenario> scenario, bool clairvoyant) {
             return std::make_unique<ShipPlanner>(std::move(scenario), clairvoyant);
           }),
           py::arg("scenario"), py::arg("clairvoyant") = true)
      .def("solve", &ShipPlanner::Solve, py::arg("batch"), py::arg("farm") = 0,
           "Returns the best plan of a farm from its present step on: (actions uint8 [T], return). "
           "T is 0 if the episode is over.");
  module.def("team_bound", BoundOf, py::arg("batch"), py::arg("farm") = 0,
             "Returns an upper bound of the sum of all agents' returns in the episode of a farm, "
             "which must be at step 0.");
  module.def(
      "_set_policy_folder", [](const std::string& folder) { PolicyFolder() = folder; },
      py::arg("folder"), "Sets the folder of the shipped policies.");
  DefineRescue(module);
}

}  // namespace aquafarm::python
