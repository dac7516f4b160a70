// SPDX-License-Identifier: BSD-3-Clause
#include "curve_widget.h"

#include <QPainter>
#include <algorithm>
#include <cmath>
#include <string>

#include "aquafarm_viz/base/text.h"

namespace aquafarm_viz {
namespace {

const QColor kBack(0x10, 0x1d, 0x2a);
const QColor kGrid(0x2b, 0x3d, 0x4f);
const QColor kReturn(0xff, 0xd4, 0x3b);
const QColor kSuccess(0x5f, 0xe0, 0x8a);
const QColor kWords(0xe6, 0xed, 0xf3);

// Draws a text next to a point. @param side  -1: on its left, 0: below it, 1: on its right
void DrawTick(QPainter& painter, const QPointF& at, const QString& text, int side) {
  const QSizeF size(80.0, painter.fontMetrics().height());
  const QPointF corner = side < 0   ? at + QPointF(-size.width() - 4.0, -size.height() / 2.0)
                         : side > 0 ? at + QPointF(4.0, -size.height() / 2.0)
                                    : at + QPointF(-size.width() / 2.0, 2.0);
  const int across = side < 0 ? Qt::AlignRight : side > 0 ? Qt::AlignLeft : Qt::AlignHCenter;
  painter.drawText(QRectF(corner, size), across | Qt::AlignVCenter, text);
}

// Draws a short line and its name, as in a legend. Returns the x of the right end.
double DrawName(QPainter& painter, const QPointF& at, const QColor& color, const QString& name) {
  constexpr double kLine = 14.0;
  painter.setPen(QPen(color, 2.0));
  painter.drawLine(at, at + QPointF(kLine, 0.0));
  const double width = painter.fontMetrics().horizontalAdvance(name);
  const double height = painter.fontMetrics().height();
  painter.setPen(color);
  painter.drawText(QRectF(at.x() + kLine + 4.0, at.y() - height / 2.0, width + 2.0, height),
                   Qt::AlignLeft | Qt::AlignVCenter, name);
  return at.x() + kLine + 4.0 + width;
}

}  // namespace

CurveRange RangeOfReturns(const std::vector<CurvePoint>& curve) {
  if (curve.empty()) return {0.0, 1.0};
  const auto [low, high] = std::minmax_element(
      curve.begin(), curve.end(),
      [](const auto& a, const auto& b) { return a.mean_return < b.mean_return; });
  if (low->mean_return == 0.0 && high->mean_return == 0.0) return {0.0, 1.0};
  const double margin = 0.06 * std::max(high->mean_return - low->mean_return, 1e-6);
  if (low->mean_return < 0.0 && high->mean_return > 0.0) {
    return {low->mean_return - margin, 1.06 * high->mean_return};
  }
  // The margin must not cross 0, because a range across 0 makes the scale logarithmic below 0.
  return {low->mean_return >= 0.0 ? std::max(0.0, low->mean_return - margin)
                                  : low->mean_return - margin,
          high->mean_return <= 0.0 ? std::min(0.0, high->mean_return + margin)
                                   : high->mean_return + margin};
}

ReturnScale::ReturnScale(const CurveRange& range)
    : range_(range), unit_(range.low < 0.0 && range.high > 0.0 ? range.high / 3.0 : 0.0) {}

double ReturnScale::Height(double value) const {
  return is_bent() && value < 0.0 ? -unit_ * std::log1p(-value / unit_) : value;
}

std::vector<double> ReturnScale::Ticks(int max) const {
  if (!is_bent()) return RoundTicks(range_, max);
  std::vector<double> ticks = RoundTicks({0.0, range_.high}, std::max(3, max / 2));
  for (double power = 1.0; power <= -range_.low; power *= 10.0) {
    for (const double tick : {-power, -3.0 * power}) {
      if (tick >= range_.low && tick < -unit_) ticks.push_back(tick);
    }
  }
  return ticks;
}

std::vector<double> RoundTicks(const CurveRange& range, int max) {
  constexpr std::size_t kFewest = 3;
  const double span = range.high - range.low;
  const double power = std::pow(10.0, std::ceil(std::log10(span / std::max(1, max))));
  // Tries finer and finer steps until there are enough ticks.
  std::vector<double> ticks;
  for (const double factor : {1.0, 0.5, 0.2, 0.1, 0.05, 0.02}) {
    const double step = factor * power;
    std::vector<double> finer;
    for (double i = std::ceil(range.low / step); i * step <= range.high; i += 1.0) {
      finer.push_back(i == 0.0 ? 0.0 : i * step);
    }
    if (ticks.size() >= kFewest && int(finer.size()) > max) break;
    ticks = finer;
  }
  return ticks;
}

CurveWidget::CurveWidget(QWidget* parent) : QWidget(parent) {
  setMinimumHeight(100);
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
  painter.setPen(kWords);
  if (curve_.size() < 2) {
    painter.drawText(rect(), Qt::AlignCenter, "no training curve yet");
    return;
  }
  const int row = painter.fontMetrics().height();
  const QRectF room = QRectF(rect()).adjusted(58.0, row + 8.0, -52.0, -row - 6.0);
  const CurveRange returns = RangeOfReturns(curve_);
  const CurveRange episodes{curve_.front().episode,
                            std::max(curve_.back().episode, curve_.front().episode + 1.0)};
  const auto x_of = [&](double episode) {
    return room.left() + (episode - episodes.low) / (episodes.high - episodes.low) * room.width();
  };
  const ReturnScale scale(returns);
  const double lowest = scale.Height(returns.low);
  const auto y_of = [&](double value) {
    return room.bottom() -
           (scale.Height(value) - lowest) / (scale.Height(returns.high) - lowest) * room.height();
  };
  const int decimals = returns.high - returns.low < 4.0 ? 2 : 0;
  std::vector<double> used;  // heights of the ticks with a number
  for (const double tick : scale.Ticks(std::max(3, int(room.height()) / (2 * row)))) {
    const double y = y_of(tick);
    painter.setPen(kGrid);
    painter.drawLine(QPointF(room.left(), y), QPointF(room.right(), y));
    const bool is_crowded = std::any_of(used.begin(), used.end(), [y, row](double other) {
      return std::abs(other - y) < 1.2 * row;
    });
    if (is_crowded) continue;
    used.push_back(y);
    painter.setPen(kReturn);
    DrawTick(painter, {room.left(), y}, Text(Number(tick, decimals)), -1);
  }
  painter.setPen(kSuccess);
  for (const double share : {0.0, 0.5, 1.0}) {
    DrawTick(painter, {room.right(), room.bottom() - share * room.height()},
             Text(Number(100.0 * share, 0) + " %"), 1);
  }
  painter.setPen(kWords);
  for (const double tick : RoundTicks(episodes, std::max(2, int(room.width()) / 90))) {
    if (tick != std::floor(tick)) continue;
    DrawTick(painter, {x_of(tick), room.bottom()}, Text(Count(std::uint64_t(tick))), 0);
  }
  DrawCurves(painter, room, x_of, y_of);
  const CurvePoint& now = curve_.back();
  const double right = DrawName(painter, {room.left(), 4.0 + row / 2.0}, kReturn,
                                Text("mean return " + Number(now.mean_return, 1)));
  const double end = DrawName(painter, {right + 16.0, 4.0 + row / 2.0}, kSuccess,
                              Text("success " + Percent(now.success)));
  painter.setPen(kWords);
  painter.drawText(QRectF(end, 4.0, width() - 8.0 - end, row), Qt::AlignRight,
                   scale.is_bent() ? "by episode, logarithmic below 0" : "by episode");
}

void CurveWidget::DrawCurves(QPainter& painter, const QRectF& room,
                             const std::function<double(double)>& x_of,
                             const std::function<double(double)>& y_of) const {
  painter.setPen(kGrid);
  painter.drawRect(room);
  QPolygonF returns;
  QPolygonF success;
  for (const CurvePoint& point : curve_) {
    const double x = x_of(point.episode);
    returns << QPointF(x, y_of(point.mean_return));
    success << QPointF(x, room.bottom() - point.success * room.height());
  }
  painter.save();
  painter.setClipRect(room);
  painter.setPen(QPen(kSuccess, 1.4, Qt::DashLine));
  painter.drawPolyline(success);
  painter.setPen(QPen(kReturn, 2.0));
  painter.drawPolyline(returns);
  painter.restore();
}

}  // namespace aquafarm_viz
