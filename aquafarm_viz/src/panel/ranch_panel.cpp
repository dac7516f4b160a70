// SPDX-License-Identifier: BSD-3-Clause
#include "ranch_panel.h"

#include <aquafarm_msgs/Command.h>
#include <aquafarm_msgs/Jump.h>
#include <aquafarm_msgs/Pause.h>
#include <aquafarm_msgs/Reset.h>
#include <aquafarm_msgs/SetDisaster.h>
#include <aquafarm_msgs/SetPace.h>
#include <rviz/visualization_manager.h>
#include <std_msgs/Time.h>

#include <QVBoxLayout>
#include <pluginlib/class_list_macros.hpp>
#include <string>

#include "aquafarm_sim/checked_topics.h"
#include "aquafarm_viz/base/disaster_kinds.h"
#include "aquafarm_viz/base/palette.h"
#include "aquafarm_viz/base/text.h"
#include "aquafarm_viz/names.h"
#include "aquafarm_viz/scene/labels.h"
#include "fit_screen.h"
#include "narrow_spaces.h"

namespace aquafarm_viz {
namespace {

constexpr double kCallLimit_s = 5.0;
// A command in lockstep waits for the commands of the other ships, at most ~barrier_timeout_s of
// the sim node.
constexpr double kCommandLimit_s = 60.0;
constexpr int kRefresh_ms = 200;
constexpr char kWholeFarm[] = "Whole Farm";

std::string InWords(const aquafarm_msgs::Command& answer) {
  const auto& result = answer.response.result;
  const std::string what = "ship " + std::to_string(answer.request.ship) + " " +
                           ActionName(answer.request.action) + ": ";
  return what + (result.ok ? DescribeResult(result) : result.message);
}

}  // namespace

RanchPanel::RanchPanel(QWidget* parent)
    : rviz::Panel(parent), widget_(new RanchWidget(model_, MakeButtons())) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(widget_);
  caller_ = MakeCaller(kCallLimit_s);
  // rviz calls these callbacks in the thread of its window, so they may use the model.
  spec_ = aquafarm_sim::Subscribe<aquafarm_msgs::FarmSpec>(
      node_, names::kSpec, Pairing::kSpecs, [this](const aquafarm_msgs::FarmSpecConstPtr& spec) {
        model_.Take(spec);
        changed_ = true;
      });
  state_ = aquafarm_sim::Subscribe<aquafarm_msgs::FarmState>(
      node_, names::kState, 2, [this](const aquafarm_msgs::FarmStateConstPtr& state) {
        model_.Take(state);
        changed_ = true;
      });
  training_ = aquafarm_sim::Subscribe<aquafarm_msgs::TrainingStatus>(
      node_, names::kTraining, 10, [this](const aquafarm_msgs::TrainingStatusConstPtr& training) {
        model_.Take(training);
        changed_ = true;
      });
  plan_ = aquafarm_sim::Subscribe<aquafarm_msgs::RescuePlan>(
      node_, names::kPlan, 2, [this](const aquafarm_msgs::RescuePlanConstPtr& plan) {
        model_.Take(plan, ros::SteadyTime::now());
        changed_ = true;
      });
  plan_heartbeat_ = aquafarm_sim::Subscribe<std_msgs::Time>(
      node_, names::kPlanHeartbeat, 2, [this](const std_msgs::TimeConstPtr&) {
        model_.MarkPlanNodePresent(ros::SteadyTime::now());
      });
  QTimer::singleShot(kRefresh_ms, this, [this] { FitWindow(*this); });  // now shown
  connect(&timer_, &QTimer::timeout, this, [this] {
    // Adjusts the view also without new messages, because the size of the window may have changed.
    if (rviz_ != nullptr && model_.shown().spec) {
      whole_view_.Follow(*rviz_, *model_.shown().spec);
    }
    widget_->RefreshPlanAge();
    if (!changed_) return;
    changed_ = false;
    widget_->Refresh();
  });
  timer_.start(kRefresh_ms);
}

void RanchPanel::onInitialize() {
  rviz_ = vis_manager_;
  connect(rviz_, &rviz::VisualizationManager::preUpdate, this,
          [this] { NarrowSpaces(*rviz_->getSceneManager()); });
}

void RanchPanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  config.mapGetBool(kWholeFarm, &whole_view_.wanted);
}

void RanchPanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue(kWholeFarm, rviz_ != nullptr && whole_view_.IsKept(*rviz_));
}

std::unique_ptr<ServiceCaller> RanchPanel::MakeCaller(double limit_s) {
  return std::make_unique<ServiceCaller>(node_, limit_s, [this](const std::string& line) {
    QMetaObject::invokeMethod(
        widget_, [this, line] { widget_->ShowMessage(line); }, Qt::QueuedConnection);
  });
}

RanchButtons RanchPanel::MakeButtons() {
  RanchButtons buttons;
  buttons.pause = [this](bool paused, std::uint32_t steps) {
    aquafarm_msgs::Pause call;
    call.request.paused = paused;
    call.request.steps = steps;
    caller_->Call<aquafarm_msgs::Pause>("pause", call, [](const aquafarm_msgs::Pause& answer) {
      const std::uint32_t wanted = answer.request.steps;
      return std::string(wanted > 0               ? "one step, then paused"
                         : answer.response.paused ? "paused"
                                                  : "resumed");
    });
  };
  buttons.reset = [this](std::uint64_t seed) {
    aquafarm_msgs::Reset call;
    call.request.has_seed = true;
    call.request.seed = seed;
    caller_->Call<aquafarm_msgs::Reset>("reset", call, [](const aquafarm_msgs::Reset& answer) {
      return "seed " + std::to_string(answer.response.seed) + ", episode " +
             Count(answer.response.episode);
    });
  };
  buttons.set_pace = [this](const std::string& pace, double rate_hz) {
    aquafarm_msgs::SetPace call;
    call.request.pace = pace;
    call.request.rate_hz = rate_hz;
    caller_->Call<aquafarm_msgs::SetPace>(
        "set_pace", call, [](const aquafarm_msgs::SetPace& answer) {
          return answer.response.pace + ", " + Number(answer.response.rate_hz, 1) + " steps/s";
        });
  };
  buttons.drive = [this](int ship, std::uint8_t action) {
    aquafarm_msgs::Command call;
    call.request.ship = ship;
    call.request.action = action;
    call.request.token = ++token_;
    auto& caller = helms_[ship];
    if (caller == nullptr) caller = MakeCaller(kCommandLimit_s);
    caller->Call<aquafarm_msgs::Command>("command", call, InWords);
  };
  buttons.send_disaster = [this](int id, const aquafarm_msgs::DisasterInfo& info) {
    aquafarm_msgs::SetDisaster call;
    call.request.id = id;
    call.request.info = info;
    caller_->Call<aquafarm_msgs::SetDisaster>(
        "set_disaster", call, [](const aquafarm_msgs::SetDisaster& answer) {
          return DisasterName(answer.request.info.kind) + " sent as disaster " +
                 std::to_string(answer.request.id);
        });
  };
  buttons.jump = [this](std::uint64_t step) {
    aquafarm_msgs::Jump call;
    call.request.step = step;
    caller_->Call<aquafarm_msgs::Jump>("jump", call, [](const aquafarm_msgs::Jump& answer) {
      return "episode " + Count(answer.response.episode) + ", step " + Count(answer.response.step);
    });
  };
  return buttons;
}

}  // namespace aquafarm_viz

PLUGINLIB_EXPORT_CLASS(aquafarm_viz::RanchPanel, rviz::Panel)
