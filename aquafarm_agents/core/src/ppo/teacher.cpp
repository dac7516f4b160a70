// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/teacher.h"

#include <string>
#include <utility>

#include "aquafarm/base/check.h"
#include "ppo/route_rule.h"

namespace aquafarm::agents {
namespace {

class RuleTeacher final : public Teacher {
 public:
  explicit RuleTeacher(const EnvironmentSpec& spec)
      : rule_(LayoutOfTokens(spec.feature_names)),
        features_(static_cast<std::size_t>(spec.feature_count)) {}
  bool sees_farms() const override { return false; }
  void Act(const StepResults& results, const std::vector<ActionMask>& allowed,
           std::vector<std::uint8_t>& actions) override {
    actions.resize(allowed.size());
    const float* tokens = results.features.data();
    for (std::size_t i = 0; i < allowed.size(); ++i, tokens += features_) {
      actions[i] = rule_.ActionOf(tokens, allowed[i]);
    }
  }

 private:
  const RouteRule rule_;
  const std::size_t features_;
};

class PlannerTeacher final : public Teacher {
 public:
  PlannerTeacher(std::unique_ptr<Policy> planner, std::int32_t farms)
      : planner_(std::move(planner)), farms_(farms) {}
  bool sees_farms() const override { return true; }
  void Act(const StepResults& results, const std::vector<ActionMask>&,
           std::vector<std::uint8_t>& actions) override {
    planner_->Begin(0, farms_);  // discards its earlier plans
    planner_->Act(results, actions);
  }

 private:
  const std::unique_ptr<Policy> planner_;
  const std::int32_t farms_;
};

}  // namespace

std::unique_ptr<Teacher> MakeTeacher(const EnvironmentSpec& spec, TeacherPolicy which,
                                     PlannerMaker make_planner) {
  if (which == TeacherPolicy::kRule) return std::make_unique<RuleTeacher>(spec);
  AQUAFARM_CHECK_EQ(make_planner != nullptr, true);
  try {
    return std::make_unique<PlannerTeacher>(make_planner(spec), spec.farms);
  } catch (const InputError& error) {
    throw InputError("teacher_policy: got planner, which does not support this ranch (" +
                     std::string(error.what()) +
                     "); use teacher=0, or teacher_policy=rule with "
                     "view.tokens");
  }
}

}  // namespace aquafarm::agents
