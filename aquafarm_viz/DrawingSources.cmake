# SPDX-License-Identifier: BSD-3-Clause
# The sources that draw pictures. They use messages but neither nodes nor bags. The Python module of
# aquafarm_gym compiles them with plain structs instead of ROS messages.
set(AQUAFARM_DRAWING_SOURCES
  src/base/checks.cpp
  src/base/disaster_kinds.cpp
  src/base/palette.cpp
  src/base/text.cpp
  src/draw/background.cpp
  src/draw/canvas.cpp
  src/draw/course.cpp
  src/draw/disaster_rings.cpp
  src/draw/disasters.cpp
  src/draw/entities.cpp
  src/draw/free_space.cpp
  src/draw/image.cpp
  src/draw/label_space.cpp
  src/draw/layout.cpp
  src/draw/legend.cpp
  src/draw/map_labels.cpp
  src/draw/panel_text.cpp
  src/draw/policy_layers.cpp
  src/draw/region.cpp
  src/draw/sea_layer.cpp
  src/draw/style.cpp
  src/draw/words.cpp
  src/scene/coast.cpp
  src/scene/directions.cpp
  src/scene/graticule.cpp
  src/scene/labels.cpp
  src/scene/layers.cpp
  src/scene/nautical.cpp
  src/scene/outlook.cpp
  src/scene/outlook_text.cpp
  src/scene/ship_place.cpp
  src/scene/shown_actions.cpp
  src/scene/storm_track.cpp
  src/scene/trail.cpp)
