// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QString>
#include <QWidget>
#include <functional>
#include <string>
#include <vector>

#include "aquafarm_viz/scene/ranch_model.h"

namespace aquafarm_viz {

/// Returns a text in UTF-8 as Qt has it.
inline QString Text(const std::string& text) { return QString::fromStdString(text); }

/// The part of an axis that is shown.
struct CurveRange {
  double low{};
  double high{};
};

/// Returns the range of the mean returns, with a margin.
CurveRange RangeOfReturns(const std::vector<CurvePoint>& curve);

/// A scale that is linear above 0 and, if the returns are on both sides of 0, logarithmic below,
/// because returns at the start of a training are far below the rest.
class ReturnScale {
 public:
  explicit ReturnScale(const CurveRange& range);

  /// Returns the height of a return on the scale.
  double Height(double value) const;
  /// Returns the values of the ticks: at most about `max` above 0, and powers of ten and three
  /// times these below.
  std::vector<double> Ticks(int max) const;
  bool is_bent() const { return unit_ > 0.0; }

 private:
  CurveRange range_;
  double unit_{};  // where the logarithmic part bends; 0: linear
};

/// Returns the multiples of 1, 2 or 5 times a power of ten within a range: as many as fit into
/// `most`, but at least three.
std::vector<double> RoundTicks(const CurveRange& range, int max);

/// Plots the mean return over episodes as a line and the success rate (0 … 100 %, on the right) as
/// a dashed one.
class CurveWidget : public QWidget {
 public:
  explicit CurveWidget(QWidget* parent = nullptr);
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
