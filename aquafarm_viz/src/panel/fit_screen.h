// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Fits the window of rviz to the screen.

#include <QSize>
#include <QWidget>

namespace aquafarm_viz {

/// Size of a window and of the dock on its left [pixels].
struct WindowFit {
  QSize window;
  int dock_width{};

  bool operator==(const WindowFit& other) const {
    return window == other.window && dock_width == other.dock_width;
  }
};

/// Returns the size of the window reduced to what the screen can show. If the window must be
/// reduced, the dock is reduced to at most 34 % of the new width of the window.
/// @param frame  size that the window manager adds to the window
/// @param screen  size of the part of the screen that windows may use, without task bars
WindowFit FitToScreen(const WindowFit& now, const QSize& frame, const QSize& screen);

/// Applies FitToScreen to the main window that contains a docked panel. If the window was reduced,
/// moves it to the upper left corner of the available part of the primary screen.
void FitWindow(QWidget& panel);

}  // namespace aquafarm_viz
