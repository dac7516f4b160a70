// SPDX-License-Identifier: BSD-3-Clause
#include "curve_widget.h"

#include <QPainter>
#include <algorithm>
#include <string>

#include "aquafarm_viz/base/text.h"

namespace aquafarm_viz {
namespace {

const QColor kBack(0x10, 0x1d, 0x2a);
const QColor kFrame(0x2b, 0x3d, 0x4f);
const QColor kReturn(0xff, 0xd4, 0x3b);
const QColor kSuccess(0x5f, 0xe0, 0x8a);
const QColor kWords(0xe6, 0xed, 0xf3);

QString Text(const std::string& text) { return QString::fromStdString(text); }

}  // namespace

CurveWidget::CurveWidget(QWidget* parent) : QWidget(parent) {
  setMinimumHeight(90);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
}

void CurveWidget::Show(const std::vector<CurvePoint>& curve) {
  curve_ = curve;
  update();
}

void CurveWidget::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.fillRect(rect(), kBack);
  const QRectF room = QRectF(rect()).adjusted(8, 18, -8, -18);
  painter.setPen(kFrame);
  painter.drawRect(room);
  painter.setPen(kWords);
  if (curve_.size() < 2) {
    painter.drawText(rect(), Qt::AlignCenter, "the curve of a training comes here");
    return;
  }
  const auto [low, high] = std::minmax_element(
      curve_.begin(), curve_.end(),
      [](const CurvePoint& a, const CurvePoint& b) { return a.mean_return < b.mean_return; });
  const double range = std::max(high->mean_return - low->mean_return, 1e-6);
  const double first = curve_.front().episode;
  const double episodes = std::max(curve_.back().episode - first, 1.0);
  QPolygonF returns;
  QPolygonF success;
  for (const CurvePoint& point : curve_) {
    const double x = room.left() + (point.episode - first) / episodes * room.width();
    returns << QPointF(
        x, room.bottom() - (point.mean_return - low->mean_return) / range * room.height());
    success << QPointF(x, room.bottom() - point.success * room.height());
  }
  painter.setPen(QPen(kSuccess, 1.2));
  painter.drawPolyline(success);
  painter.setPen(QPen(kReturn, 2.0));
  painter.drawPolyline(returns);
  const QRectF top(8, 1, width() - 16, 16);
  const QRectF bottom(8, height() - 17, width() - 16, 16);
  painter.drawText(top, Qt::AlignLeft, Text("mean return " + Number(high->mean_return, 1)));
  painter.drawText(bottom, Qt::AlignLeft, Text(Number(low->mean_return, 1)));
  painter.setPen(kSuccess);
  painter.drawText(top, Qt::AlignRight,
                   Text("success " + Number(100.0 * curve_.back().success, 0) + " %"));
  painter.setPen(kWords);
  painter.drawText(bottom, Qt::AlignRight,
                   Text("episode " + Count(std::uint64_t(curve_.back().episode))));
}

}  // namespace aquafarm_viz
