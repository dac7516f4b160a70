// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QTableWidget>
#include <QWidget>
#include <cstdint>
#include <functional>
#include <string>

#include "aquafarm_viz/scene/ranch_model.h"
#include "curve_widget.h"

class QBoxLayout;

namespace aquafarm_viz {

/// What the buttons do; each must return at once.
struct RanchButtons {
  std::function<void(bool paused, std::uint32_t steps)> pause;
  std::function<void(std::uint64_t seed)> reset;
  std::function<void(const std::string& pace, double rate_hz)> set_pace;
  std::function<void(int ship, std::uint8_t action)> drive;
  std::function<void(int id, const aquafarm_msgs::DisasterInfo& info)> send_disaster;
  std::function<void(std::uint64_t step)> jump;
};

/// The panel "Ranch" without rviz and ROS: shows a model, and its buttons call functions.
class RanchWidget : public QWidget {
 public:
  /// @param model is looked at by Refresh; must outlive the widget
  RanchWidget(const RanchModel& model, RanchButtons buttons, QWidget* parent = nullptr);

  /// Shows what the model says now.
  void Refresh();
  /// The line at the bottom: what became of the last button.
  void Tell(const std::string& line);

 private:
  QLabel* AddLine(QBoxLayout* layout);
  QPushButton* AddButton(QBoxLayout* layout, const QString& text, std::function<void()> act);
  void AddTime(QBoxLayout* layout);
  void AddPlaces(QBoxLayout* layout);
  void AddHelm(QBoxLayout* layout);
  void AddDisaster(QBoxLayout* layout);

  const RanchModel& model_;
  const RanchButtons buttons_;
  QLabel* headline_;
  QLabel* reward_;
  QLabel* training_;
  QLabel* told_;
  QTableWidget* ships_;
  QTableWidget* devices_;
  CurveWidget* curve_;
  QSpinBox* ship_{};
};

}  // namespace aquafarm_viz
