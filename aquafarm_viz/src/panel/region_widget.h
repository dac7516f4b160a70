// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QWidget>

#include "aquafarm_viz/scene/ranch_model.h"
#include "draw/region_painter.h"

namespace aquafarm_viz {

/// Shows the region around the farm with its disasters and their courses. It is visible only if a
/// disaster has its centre outside the farm.
class RegionWidget : public QWidget {
 public:
  explicit RegionWidget(QWidget* parent = nullptr);
  /// Shows a state, or hides the widget.
  /// @param is_wanted  false: hides the widget
  void Show(const Shown& shown, bool is_wanted);
  QSize sizeHint() const override { return {360, 150}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  Shown shown_;
  RegionPainter painter_;
};

}  // namespace aquafarm_viz
