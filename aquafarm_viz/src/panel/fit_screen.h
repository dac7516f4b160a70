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

/// Returns the largest size up to the window's own that a screen can show. The dock keeps its width
/// if the window fits, else it gets a share of the window's width.
/// @param frame  size that the window manager adds to the window
WindowFit FitToScreen(const WindowFit& now, const QSize& frame, const QSize& screen);

/// Shrinks the main window that contains a docked panel, if the window is larger than its screen.
void FitWindow(QWidget& panel);

}  // namespace aquafarm_viz
