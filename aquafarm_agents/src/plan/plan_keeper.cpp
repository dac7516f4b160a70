// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/plan/plan_keeper.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "aquafarm/agents/rescue/plan_report.h"

namespace aquafarm_agents {
namespace {

namespace agents = aquafarm::agents;
using aquafarm_msgs::RescuePlan;

bool SameFiles(const std::vector<StampedFile>& a, const std::vector<StampedFile>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const StampedFile& one, const StampedFile& other) {
                      return one.path == other.path && one.stamp == other.stamp;
                    });
}

bool SameFleet(const PlanInputs& a, const PlanInputs& b) {
  if (a.fleet.has_value() != b.fleet.has_value()) return false;
  return !a.fleet || (*a.fleet == *b.fleet && a.step == b.step);
}

std::vector<std::pair<std::string, std::string>> InputFiles(const agents::RescueRequest& request) {
  std::vector<std::pair<std::string, std::string>> files;
  const auto add = [&files](const char* role, const std::string& path) {
    if (!path.empty() && !StampOf(path).stamp.empty()) files.emplace_back(role, path);
  };
  add("bulletin", request.bulletin);
  add("storm", request.storm);
  add("devices", request.devices);
  add("ships", request.ships_file);
  return files;
}

// Returns why the plan of a newer file must not replace the present plan; empty if it may. A
// bulletin of another storm, or an older bulletin that was copied later, would hide the approaching
// storm.
std::string WhyNotInstead(const RescuePlan& made, const RescuePlan& present) {
  if (made.storm_name != present.storm_name && made.start < present.end) {
    return "got a bulletin of '" + made.storm_name + "', expected '" + present.storm_name +
           "'; remove the other storm's file, or start the node with storm_name";
  }
  if (!made.issued.isZero() && made.issued < present.issued) {
    return "got a bulletin that was issued before the one in use";
  }
  return "";
}

}  // namespace

bool SamePlan(const PlanInputs& a, const PlanInputs& b) {
  return a.scenario == b.scenario && SameFiles(a.bulletins, b.bulletins) &&
         SameFiles(a.files, b.files) && SameFleet(a, b) && a.refresh == b.refresh &&
         a.request.at == b.request.at;
}

PlanMessages MakePlan(const PlanInputs& inputs, const std::string& bulletin) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point began = Clock::now();
  const auto seconds = [began] {
    return std::chrono::duration<double>(Clock::now() - began).count();
  };
  agents::RescueRequest request = inputs.request;
  request.bulletin = bulletin;
  agents::RescueCase rescue = agents::MakeRescueCase(inputs.scenario, request);
  if (inputs.fleet) agents::UseFleet(request, *inputs.fleet, rescue);
  const bool is_done = rescue.problem.devices.empty();
  const bool has_others =
      inputs.fleet &&
      std::any_of(inputs.fleet->devices.begin(), inputs.fleet->devices.end(),
                  [](const auto& one) { return one.self_propelled && one.is_deployed; });
  const agents::Ensemble ensemble(rescue.forecast, rescue.ensemble, rescue.Sites());
  const agents::PlanReport report = agents::MakeReport(rescue, ensemble);
  agents::PlanProvenance provenance;
  provenance.command = inputs.command;
  provenance.computed_at = request.now.value_or(rescue.start);
  provenance.inputs = InputFiles(request);
  PlanMessages messages =
      ReadPlan(agents::ToJson(rescue, ensemble, report, provenance), "the plan");
  messages.plan.compute_s = seconds();
  if (is_done && messages.plan.result != RescuePlan::STORM_UNKNOWN) {
    // The core reports this case as a storm that reaches no device.
    messages.plan.result = has_others ? RescuePlan::NOTHING_SAVED : RescuePlan::PLAN;
    messages.plan.text = has_others ? "Ships have nothing left to fetch. The plan contains no "
                                      "self-propelled devices: bring those at sea to a "
                                      "port."
                                    : "Every device is in port: there is nothing left to fetch.";
    auto& warnings = messages.plan.warnings;
    warnings.erase(std::remove_if(warnings.begin(), warnings.end(),
                                  [](const auto& one) { return one.code == "storm_stays_away"; }),
                   warnings.end());
  }
  return messages;
}

bool PlanKeeper::Update(const PlanInputs& inputs) {
  const bool is_new = !inputs_ || !SamePlan(*inputs_, inputs);
  const auto stamp_before = plan_.plan.computed_at;
  const std::string fault_before = plan_.plan.fault;
  if (!inputs_) {
    plan_.plan.result = RescuePlan::NONE;
    plan_.plan.text = "There is no plan yet.";
  }
  bool has_planned = false;
  if (is_new && inputs.scenario && (!inputs.bulletins.empty() || !inputs.request.storm.empty())) {
    refused_ = TryAll(inputs);
    has_planned = refused_.empty() || !good_.empty();
  }
  inputs_ = inputs;
  plan_.plan.fault = inputs.fault;
  if (!refused_.empty()) plan_.plan.fault += (inputs.fault.empty() ? "" : "; ") + refused_;
  return has_planned || stamp_before != plan_.plan.computed_at || fault_before != plan_.plan.fault;
}

// Plans as described at PlanKeeper. Returns why plan_ does not use the newest bulletin, or an empty
// string.
std::string PlanKeeper::TryAll(const PlanInputs& inputs) {
  const std::string newest = inputs.bulletins.empty() ? "" : inputs.bulletins[0].path;
  std::string why;
  try {
    PlanMessages made = MakePlan(inputs, newest);
    why = good_.empty() || good_ == newest ? "" : WhyNotInstead(made.plan, plan_.plan);
    if (why.empty()) {
      Use(std::move(made), inputs);
      good_ = newest;
      return "";
    }
    why = newest + ": " + why;
  } catch (const std::exception& error) {
    why = error.what();
  }
  // If no bulletin is in use yet, uses the next older bulletin with which a plan can be made.
  for (std::size_t i = 1; good_.empty() && i < inputs.bulletins.size(); ++i) {
    try {
      Use(MakePlan(inputs, inputs.bulletins[i].path), inputs);
      good_ = inputs.bulletins[i].path;
      return why + "; this plan uses " + good_;
    } catch (const std::exception&) {  // tries the next bulletin
    }
  }
  const bool has_other = !good_.empty() && good_ != newest && !StampOf(good_).stamp.empty();
  if (has_other) {
    try {
      Use(MakePlan(inputs, good_), inputs);
      return why + "; this plan uses " + good_;
    } catch (const std::exception&) {  // keeps the earlier plan
    }
  }
  if (plan_.plan.result == RescuePlan::NONE) return why;
  return why + "; this plan is an earlier one";
}

void PlanKeeper::Use(PlanMessages plan, const PlanInputs& inputs) {
  plan_ = std::move(plan);
  plan_.plan.follows_ranch = inputs.fleet.has_value();
  plan_.plan.episode = inputs.fleet ? inputs.fleet->episode : 0;
  plan_.plan.step = inputs.fleet ? inputs.step : 0;
}

}  // namespace aquafarm_agents
