// SPDX-License-Identifier: BSD-3-Clause
#include "draw/region_painter.h"

#include <string>
#include <vector>

#include "draw/region.h"
#include "draw/symbols.h"

namespace aquafarm_viz {

struct RegionPainter::Parts {
  Layout layout;  // one pixel per design unit
  Fonts fonts{layout.unit};
  CourseReader courses;
  std::string scenario_yaml;     // scenario of `coast`
  std::vector<CoastRing> coast;  // CoastAround of that scenario
  cv::Mat image;
};

RegionPainter::RegionPainter(const Style& style) : parts_(std::make_unique<Parts>()) {
  parts_->layout.style = &style;
}
RegionPainter::~RegionPainter() = default;

const cv::Mat& RegionPainter::Draw(const aquafarm_msgs::FarmSpec& spec,
                                   const aquafarm_msgs::FarmState& state, cv::Size size) {
  Parts& p = *parts_;
  if (p.scenario_yaml != spec.scenario_yaml) {
    p.coast = CoastAround(spec);
    p.scenario_yaml = spec.scenario_yaml;
  }
  p.image.create(size, CV_8UC3);
  p.image.setTo(Bgr(p.layout.style->panel));
  DrawWideRegion(p.image, spec, state, p.courses.Read(spec, state), p.coast, p.layout, p.fonts);
  return p.image;
}

}  // namespace aquafarm_viz
