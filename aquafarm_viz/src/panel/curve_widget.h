// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QWidget>
#include <vector>

#include "aquafarm_viz/scene/ranch_model.h"

namespace aquafarm_viz {

/// Plots the mean return over episodes as a line and the success rate (0 … 100 %) as a fainter one.
class CurveWidget : public QWidget {
 public:
  explicit CurveWidget(QWidget* parent = nullptr);
  void Show(const std::vector<CurvePoint>& curve);
  QSize sizeHint() const override { return {360, 130}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::vector<CurvePoint> curve_;
};

}  // namespace aquafarm_viz
