// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rviz/panel.h>

#include <QTimer>
#include <map>
#include <memory>

#include "ranch_widget.h"
#include "service_caller.h"

namespace aquafarm_viz {

/// The panel "Ranch" of rviz: topics of the ranch in whose namespace rviz runs, live or replayed,
/// and its services.
class RanchPanel : public rviz::Panel {
 public:
  explicit RanchPanel(QWidget* parent = nullptr);

 private:
  RanchButtons MakeButtons();
  std::unique_ptr<ServiceCaller> MakeCaller(double limit_s);

  ros::NodeHandle node_;
  RanchModel model_;
  RanchWidget* widget_;
  std::unique_ptr<ServiceCaller> caller_;
  std::map<int, std::unique_ptr<ServiceCaller>> helms_;  // by ship: one that waits blocks no other
  ros::Subscriber spec_;
  ros::Subscriber state_;
  ros::Subscriber training_;
  QTimer timer_;
  bool changed_{};
  std::uint64_t token_{ros::WallTime::now().toNSec()};
};

}  // namespace aquafarm_viz
