// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QString>
#include <QWidget>
#include <functional>
#include <string>
#include <vector>

#include "aquafarm_viz/scene/ranch_model.h"

namespace aquafarm_viz {

/// Converts a text in UTF-8 to a text of Qt.
inline QString Text(const std::string& text) { return QString::fromStdString(text); }

/// The range of an axis.
struct CurveRange {
  double low{};
  double high{};
};

/// Returns the range of the mean returns of a curve with a margin; [0, 1] if the curve is empty.
/// The margin does not extend across 0.
CurveRange RangeOfReturns(const std::vector<CurvePoint>& curve);

/// The scale of the axis of returns. It is linear unless the range contains negative and positive
/// values. For such a range it is logarithmic below 0, because the returns at the start of a
/// training are far below all others.
class ReturnScale {
 public:
  explicit ReturnScale(const CurveRange& range);

  /// Returns the height of a return on the scale.
  double Height(double value) const;
  /// Returns the values of the ticks: RoundTicks for a linear scale. A scale that is logarithmic
  /// below 0 has about max / 2 ticks from 0 on, and ticks at some of -1, -3, -10, -30, …
  std::vector<double> Ticks(int max) const;
  /// Returns true if the scale is logarithmic below 0.
  bool is_bent() const { return unit_ > 0.0; }

 private:
  CurveRange range_;
  double unit_{};  // below -unit_ the scale is about logarithmic; 0: the whole scale is linear
};

/// Returns ticks within a range: the multiples of 1, 2 or 5 times a power of ten. The spacing is
/// the smallest that gives at most `max` ticks. If that would give fewer than three ticks, the
/// spacing is smaller.
std::vector<double> RoundTicks(const CurveRange& range, int max);

/// Plots the mean return (axis on the left) as a solid line and the success rate (0 … 100 %, axis
/// on the right) as a dashed line, both over episodes.
class CurveWidget : public QWidget {
 public:
  explicit CurveWidget(QWidget* parent = nullptr);
  /// Replaces the plotted curve.
  void Show(const std::vector<CurvePoint>& curve);
  QSize sizeHint() const override { return {360, 170}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void DrawCurves(QPainter& painter, const QRectF& room, const std::function<double(double)>& x_of,
                  const std::function<double(double)>& y_of) const;

  std::vector<CurvePoint> curve_;
};

}  // namespace aquafarm_viz
