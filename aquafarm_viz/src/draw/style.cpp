// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/draw/style.h"

#include <algorithm>
#include <stdexcept>

namespace aquafarm_viz {

Rgb Style::Risk(double severity) const {
  const double at = std::clamp(severity, 0.0, 1.0) * double(risks.size() - 1);
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), risks.size() - 2);
  return Mix(risks[i], risks[i + 1], at - static_cast<double>(i));
}

Rgb Style::RiskText(double severity) const { return Mix(Risk(severity), words, 0.25); }

Rgb Style::GradeText(std::uint8_t grade) const {
  return grade >= 1 && grade <= grades.size() ? grades[grade - 1U] : faint;
}

const Style& DarkStyle() {
  static const Style kStyle{
      /*panel=*/{0x10, 0x1d, 0x2a},
      /*rule=*/{0x2b, 0x3d, 0x4f},
      /*words=*/{0xe6, 0xed, 0xf3},
      /*faint=*/{0x9a, 0xa9, 0xb8},
      /*good=*/{0x5f, 0xe0, 0x8a},
      /*bad=*/{0xff, 0x7b, 0x72},
      /*sea_north=*/{0x24, 0x60, 0x8c},
      kSeaDeep,
      kSeaShallow,
      kSand,
      kLand,
      kLandHigh,
      /*grid=*/kPaper,
      /*label=*/kPaper,
      /*halo=*/kInk,
      /*risks=*/
      {{SeverityColor(0.0), SeverityColor(1.0 / 3.0), SeverityColor(2.0 / 3.0),
        SeverityColor(1.0)}},
      /*grades=*/{{GradeColor(1), GradeColor(2), GradeColor(3), {0xff, 0x6b, 0x6b}}}};
  return kStyle;
}

const Style& LightStyle() {
  static const Style kStyle{
      /*panel=*/{0xff, 0xff, 0xff},
      /*rule=*/{0xc3, 0xcc, 0xd4},
      /*words=*/{0x12, 0x20, 0x2e},
      /*faint=*/{0x52, 0x60, 0x6d},
      /*good=*/{0x12, 0x6b, 0x3a},
      /*bad=*/{0xb0, 0x1e, 0x1e},
      /*sea_north=*/{0xd3, 0xe7, 0xf5},
      /*sea_south=*/{0xc6, 0xdf, 0xf0},
      /*sea_shallow=*/{0xea, 0xf5, 0xfb},
      /*sand=*/{0xa8, 0x93, 0x5e},
      /*land=*/{0xd4, 0xc9, 0x9f},
      /*land_high=*/{0xbd, 0xb1, 0x82},
      /*grid=*/{0x5b, 0x7f, 0x99},
      /*label=*/kInk,
      /*halo=*/{0xff, 0xff, 0xff},
      /*risks=*/{{{0xb4, 0x83, 0x00}, {0xad, 0x46, 0x00}, {0x8a, 0x15, 0x15}, {0x3d, 0x04, 0x30}}},
      /*grades=*/
      {{{0x1c, 0x5f, 0xa8}, {0x8a, 0x65, 0x00}, {0xb4, 0x50, 0x00}, {0xb0, 0x1e, 0x1e}}},
      /*ring_tint=*/0.3};
  return kStyle;
}

const Style& StyleByName(const std::string& name) {
  if (name == "dark") return DarkStyle();
  if (name == "light") return LightStyle();
  throw std::invalid_argument("style: got '" + name + "', expected dark or light");
}

}  // namespace aquafarm_viz
