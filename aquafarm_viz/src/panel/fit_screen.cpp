// SPDX-License-Identifier: BSD-3-Clause
#include "fit_screen.h"

#include <QDockWidget>
#include <QGuiApplication>
#include <QMainWindow>
#include <QScreen>
#include <QTimer>
#include <algorithm>

namespace aquafarm_viz {

WindowFit FitToScreen(const WindowFit& now, const QSize& frame, const QSize& screen) {
  constexpr double kDockShare = 0.34;
  const QSize fits = now.window.boundedTo(screen - frame);
  if (fits == now.window) return now;
  const int dock = static_cast<int>(kDockShare * fits.width());
  return {fits, std::min(now.dock_width, dock)};
}

void FitWindow(QWidget& panel) {
  auto* window = qobject_cast<QMainWindow*>(panel.window());
  QDockWidget* dock = nullptr;
  for (QWidget* parent = panel.parentWidget(); parent != nullptr && dock == nullptr;
       parent = parent->parentWidget()) {
    dock = qobject_cast<QDockWidget*>(parent);
  }
  const QScreen* screen = QGuiApplication::primaryScreen();
  if (window == nullptr || dock == nullptr || screen == nullptr) return;
  const QRect available = screen->availableGeometry();
  const WindowFit now{window->size(), dock->width()};
  const QSize frame = window->frameGeometry().size() - window->size();
  const WindowFit fit = FitToScreen(now, frame, available.size());
  if (fit == now) return;
  window->resize(fit.window);
  window->move(available.topLeft());
  // Resizes the dock later, when Qt has computed the layout of the smaller window.
  QTimer::singleShot(0, window, [window, dock, fit] {
    window->resizeDocks({dock}, {fit.dock_width}, Qt::Horizontal);
  });
}

}  // namespace aquafarm_viz
