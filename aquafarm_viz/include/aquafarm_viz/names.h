// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Names of the topics and frames of this package, and of the parameters of viz_node. The names of
/// topics are relative.

namespace aquafarm_viz::names {

inline constexpr char kSpec[] = "spec";
inline constexpr char kState[] = "state";
inline constexpr char kTraining[] = "training";
inline constexpr char kPlan[] = "plan";
inline constexpr char kPlanHeartbeat[] = "plan/heartbeat";
inline constexpr char kValuePoints[] = "values/points";
inline constexpr char kChoice[] = "choice";
inline constexpr char kMarkers[] = "markers";
inline constexpr char kMoves[] = "moves";
inline constexpr char kImage[] = "image";
inline constexpr char kCompressed[] = "image/compressed";

inline constexpr char kRoute[] = "route";  ///< in the namespace ship_<id>

inline constexpr char kLayersParam[] = "layers";
inline constexpr char kStyleParam[] = "style";
inline constexpr char kRateParam[] = "rate_hz";
inline constexpr char kWidthParam[] = "image_width";
inline constexpr char kHeightParam[] = "image_height";

inline constexpr char kMapFrame[] = "map";

}  // namespace aquafarm_viz::names
