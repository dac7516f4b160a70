// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The colours of pictures: a dark style for screens and a light one for paper.

#include <array>
#include <cstdint>
#include <string>

#include "aquafarm_viz/base/palette.h"

namespace aquafarm_viz {

/// The colours of a picture that depend on the style. Ships, devices and ports look the same in
/// both styles.
struct Style {
  Rgb panel;      ///< background of text
  Rgb rule;       ///< thin lines between parts
  Rgb words;      ///< text
  Rgb faint;      ///< secondary text
  Rgb good;       ///< a reward above 0
  Rgb bad;        ///< a reward below 0
  Rgb alarm;      ///< a device in danger
  Rgb sea_north;  ///< water away from the coast, at the upper and the lower end of the map
  Rgb sea_south;
  Rgb sea_shallow;
  Rgb sand;
  Rgb land;
  Rgb land_high;
  Rgb grid;
  Rgb label;                  ///< text and lines on the map
  Rgb halo;                   ///< outline of `label`
  std::array<Rgb, 4> risks;   ///< at -5, -10, -15 and -20; each darker in the light style
  std::array<Rgb, 4> grades;  ///< of text: blue, yellow, orange, red
  double ring_tint{1.0};      ///< strength of the tint of rings between their lines, [0, 1]

  /// The colour of a severity in [0, 1], interpolated between `risks`.
  Rgb Risk(double severity) const;
  /// The colour of a grade in text; `faint` for an unknown grade.
  Rgb GradeText(std::uint8_t grade) const;
};

/// For screens; the default.
const Style& DarkStyle();
/// For print: light background, dark lines, readable in grey.
const Style& LightStyle();

/// Returns a style by its name, "dark" or "light".
/// @throws std::invalid_argument "style: got 'blue', expected dark or light"
const Style& StyleByName(const std::string& name);

}  // namespace aquafarm_viz
