// SPDX-License-Identifier: BSD-3-Clause
// Ships follow the planners, and now and then take a random action, after which a new plan is made.
// Episodes alternate between the forecast and the true future. soak.h checks the farm after each
// step. A scenario that the planners refuse is left out with a line.
//   planner_soak STEPS SEED SCENARIO.yaml…    (or folders of scenarios; STEPS for each)
#include <array>

#include "aquafarm/agents/planning/team_planner.h"
#include "soak/soak.h"

namespace {

using namespace aquafarm;
using agents::Foresight;
using agents::TeamPlanner;

constexpr int kRandomEvery = 50;  // steps between random actions, on average

/// The plans of one farm. TeamPlanner plans for one ship, too.
class PlannerChooser {
 public:
  explicit PlannerChooser(const Scenario& scenario)
      : planners_{TeamPlanner(scenario, Foresight::kPersistence),
                  TeamPlanner(scenario, Foresight::kOracle)} {}

  void Choose(const Farm& farm, std::mt19937_64& rng, std::vector<std::uint8_t>& actions) {
    const std::size_t kind = farm.episode() % planners_.size();
    if (farm.episode() != episode_) plans_[kind] = {};
    episode_ = farm.episode();
    planners_[kind].Act(farm, plans_[kind], actions.data());
    if (rng() % kRandomEvery != 0) return;
    for (std::uint8_t& action : actions) action = static_cast<std::uint8_t>(rng() % kActionCount);
  }

 private:
  std::array<TeamPlanner, 2> planners_;
  std::array<TeamPlanner::PlanState, 2> plans_;
  std::uint64_t episode_{};
};

}  // namespace

int main(int argc, char** argv) {
  return soak::Main(
      argc, argv, "planner_soak", [](const std::shared_ptr<const Scenario>& scenario) {
        const auto planner = std::make_shared<PlannerChooser>(*scenario);
        return soak::Chooser(
            [planner](const Farm& farm, const std::vector<ActionMask>&, std::mt19937_64& rng,
                      std::vector<std::uint8_t>& actions) { planner->Choose(farm, rng, actions); });
      });
}
