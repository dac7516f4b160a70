// SPDX-License-Identifier: BSD-3-Clause
#include "region_widget.h"

#include <QImage>
#include <QPainter>

#include "draw/region.h"

namespace aquafarm_viz {

RegionWidget::RegionWidget(QWidget* parent) : QWidget(parent) {
  setMinimumHeight(80);
  setMaximumHeight(220);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setVisible(false);
}

void RegionWidget::Show(const Shown& shown, bool is_wanted) {
  const bool is_new = shown.state != shown_.state || shown.spec != shown_.spec;
  shown_ = shown;
  setVisible(is_wanted && shown.state != nullptr && HasRegion(*shown.spec, *shown.state));
  if (is_new) update();
}

void RegionWidget::paintEvent(QPaintEvent*) {
  if (shown_.state == nullptr) return;
  const cv::Mat& image = painter_.Draw(*shown_.spec, *shown_.state, {width(), height()});
  QPainter(this).drawImage(
      0, 0, QImage(image.data, image.cols, image.rows, int(image.step), QImage::Format_BGR888));
}

}  // namespace aquafarm_viz
