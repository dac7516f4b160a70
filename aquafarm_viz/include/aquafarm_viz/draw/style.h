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
  Rgb panel;        ///< background outside the map
  Rgb rule;         ///< thin lines between the parts of the picture
  Rgb words;        ///< text
  Rgb faint;        ///< secondary text
  Rgb good;         ///< reward above 0, return of 0 or more, delivered device, path of the only
                    ///< ship, end of an episode in which every device was delivered
  Rgb bad;          ///< a reward or a return below 0
  Rgb sea_north;    ///< water away from the coast, at the upper end of the map
  Rgb sea_south;    ///< water away from the coast, at the lower end of the map
  Rgb sea_shallow;  ///< water at the coast and around rocks
  Rgb sand;
  Rgb land;
  Rgb land_high;
  Rgb grid;
  Rgb label;                  ///< text and lines on the map
  Rgb halo;                   ///< outline of `label`
  std::array<Rgb, 4> risks;   ///< colours of the risks -5, -10, -15 and -20
  std::array<Rgb, 4> grades;  ///< text colours of the grades blue, yellow, orange and red
  double ring_tint{1.0};      ///< opacity factor of the tint that fills a ring, [0, 1]

  /// Returns the colour of a severity, interpolated between `risks`; values outside [0, 1] are
  /// clamped.
  Rgb Risk(double severity) const;
  /// Returns the text colour of a severity: Risk with more contrast to `panel`.
  Rgb RiskText(double severity) const;
  /// Returns the text colour of a grade, 1 to 4; `faint` for an unknown grade.
  Rgb GradeText(std::uint8_t grade) const;
};

/// Returns the style for screens, which is the default.
const Style& DarkStyle();
/// Returns the style for print: a light background and dark lines. Higher risks are darker, so that
/// they can be distinguished in a greyscale print.
const Style& LightStyle();

/// Returns a style by its name, "dark" or "light".
/// @throws std::invalid_argument "style: got 'blue', expected dark or light" for any other name
const Style& StyleByName(const std::string& name);

}  // namespace aquafarm_viz
