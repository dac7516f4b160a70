// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace Ogre {
class SceneManager;
}

namespace aquafarm_viz {

/// Gives the spaces of all texts in the 3D view the width that they have in Liberation Sans. By
/// default rviz makes a space as wide as a capital A. Call it before each frame.
void NarrowSpaces(Ogre::SceneManager& scene);

}  // namespace aquafarm_viz
