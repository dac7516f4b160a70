// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace Ogre {
class SceneManager;
}

namespace aquafarm_viz {

/// Sets the width of the spaces in all texts of the 3D view to that of Liberation Sans. By default,
/// rviz makes a space as wide as a capital A. Must be called before each frame, because texts
/// change.
void NarrowSpaces(Ogre::SceneManager& scene);

}  // namespace aquafarm_viz
