// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QComboBox>
#include <QIcon>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QTableWidget>
#include <QWidget>
#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "aquafarm_viz/scene/ranch_model.h"
#include "curve_widget.h"
#include "region_widget.h"

class QBoxLayout;

namespace aquafarm_viz {

/// The functions that the buttons call. Each must return immediately.
struct RanchButtons {
  std::function<void(bool paused, std::uint32_t steps)> pause;
  std::function<void(std::uint64_t seed)> reset;
  std::function<void(const std::string& pace, double rate_hz)> set_pace;
  std::function<void(int ship, std::uint8_t action)> drive;
  std::function<void(int id, const aquafarm_msgs::DisasterInfo& info)> send_disaster;
  std::function<void(std::uint64_t step)> jump;
};

/// The widget of the panel "Ranch". It shows a RanchModel, and its buttons call RanchButtons. It
/// needs neither rviz nor a node.
class RanchWidget : public QWidget {
 public:
  /// @param model must outlive the widget; Refresh, RefreshPlanAge and buttons read it
  RanchWidget(const RanchModel& model, RanchButtons buttons, QWidget* parent = nullptr);

  /// Shows the current content of the model.
  void Refresh();
  /// Updates the line of the plan, which warns if plan_node is silent (PlanHeadline).
  void RefreshPlanAge();
  /// Sets the line at the bottom, which contains the result of the last service call.
  void ShowMessage(const std::string& line);

 private:
  QLabel* AddLine(QBoxLayout* layout);
  QPushButton* AddButton(QBoxLayout* layout, const QString& text, std::function<void()> act);
  void RefreshPlan();
  /// Adds the symbol of each device in the column "kind".
  void AddSymbols();
  void AddTime(QBoxLayout* layout);
  void AddPlaces(QBoxLayout* layout);
  void AddHelm(QBoxLayout* layout);
  void AddDisaster(QBoxLayout* layout);

  const RanchModel& model_;
  const RanchButtons buttons_;
  QLabel* headline_;
  QLabel* reward_;
  QLabel* training_;
  QLabel* message_;
  QTableWidget* ships_;
  QTableWidget* devices_;
  QTableWidget* disasters_;
  QLabel* plan_;
  QTableWidget* plan_ships_;
  QTableWidget* plan_devices_;
  CurveWidget* curve_;
  RegionWidget* region_;
  QSpinBox* ship_{};
  std::map<std::uint8_t, QIcon> icons_;  // by kind of device
};

}  // namespace aquafarm_viz
