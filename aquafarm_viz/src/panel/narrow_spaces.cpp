// SPDX-License-Identifier: BSD-3-Clause
#include "narrow_spaces.h"

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <rviz/ogre_helpers/movable_text.h>

#include <cmath>

namespace aquafarm_viz {
namespace {

// A space of Liberation Sans is 0.278 em wide. In rviz, 1 em is 0.853 heights of a text.
constexpr float kSpace = 0.237F;  // [heights of a text]

void NarrowSpacesBelow(Ogre::Node& node) {
  if (auto* scene_node = dynamic_cast<Ogre::SceneNode*>(&node)) {
    for (unsigned short i = 0; i < scene_node->numAttachedObjects(); ++i) {
      auto* text = dynamic_cast<rviz::MovableText*>(scene_node->getAttachedObject(i));
      if (text == nullptr) continue;
      const float wanted = kSpace * text->getCharacterHeight();
      // Setting a width makes rviz rebuild the text, so an unchanged width is not set.
      if (std::abs(text->getSpaceWidth() - wanted) > 1e-3F * wanted) text->setSpaceWidth(wanted);
    }
  }
  for (unsigned short i = 0; i < node.numChildren(); ++i) NarrowSpacesBelow(*node.getChild(i));
}

}  // namespace

void NarrowSpaces(Ogre::SceneManager& scene) { NarrowSpacesBelow(*scene.getRootSceneNode()); }

}  // namespace aquafarm_viz
