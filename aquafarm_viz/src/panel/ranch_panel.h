// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rviz/panel.h>

#include <QTimer>
#include <map>
#include <memory>

#include "ranch_widget.h"
#include "service_caller.h"
#include "whole_view.h"

namespace aquafarm_viz {

/// The rviz panel "Ranch". It shows the topics of the ranch, running or replayed, whose namespace
/// is that of the rviz node. It also calls the services of this ranch.
class RanchPanel : public rviz::Panel {
 public:
  explicit RanchPanel(QWidget* parent = nullptr);

  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private:
  RanchButtons MakeButtons();
  std::unique_ptr<ServiceCaller> MakeCaller(double limit_s);

  ros::NodeHandle node_;
  RanchModel model_;
  RanchWidget* widget_;
  std::unique_ptr<ServiceCaller> caller_;
  // One caller for each ship, because a command may wait for the commands of other ships.
  std::map<int, std::unique_ptr<ServiceCaller>> helms_;
  ros::Subscriber spec_;
  ros::Subscriber state_;
  ros::Subscriber training_;
  ros::Subscriber plan_;
  ros::Subscriber plan_heartbeat_;
  rviz::VisualizationManager* rviz_{};  // null outside rviz, where vis_manager_ is not set
  WholeView whole_view_;
  QTimer timer_;
  bool changed_{};
  std::uint64_t token_{ros::WallTime::now().toNSec()};
};

}  // namespace aquafarm_viz
