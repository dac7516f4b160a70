// SPDX-License-Identifier: BSD-3-Clause
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "draw/symbols.h"

namespace aquafarm_viz {
namespace {

struct SeaLayer {
  std::string name;
  std::string units;
  std::vector<float> values;  // [H, W] row-major; row 0 is the southernmost
};

// Reads a sea layer of the spec's scenario. A layer has one number per cell.
SeaLayer LayerOf(const aquafarm_msgs::FarmSpec& spec, const std::string& name) {
  std::string names;
  try {
    const YAML::Node layers = YAML::Load(spec.scenario_yaml)["seas"]["layers"];
    for (const YAML::Node& layer : layers) {
      const auto found = layer["name"].as<std::string>();
      names += (names.empty() ? "" : ", ") + found;
      if (found != name) continue;
      SeaLayer sea{name, layer["units"].as<std::string>(""),
                   layer["values"].as<std::vector<float>>()};
      if (sea.values.size() == std::size_t(spec.width) * std::size_t(spec.height)) return sea;
      throw std::invalid_argument("layers: sea:" + name + " has another size than the farm");
    }
  } catch (const YAML::Exception& error) {
    throw std::invalid_argument("layers: sea:" + name + ": the spec's scenario: " + error.what());
  }
  throw std::invalid_argument("layers: got 'sea:" + name + "', " +
                              (names.empty()
                                   ? "but the scenario has no sea layers"
                                   : "expected one of the scenario's sea layers: " + names));
}

// The colours of a layer, [H, W] with the northernmost row first, and a mask of the cells that have
// a value.
struct HeatMap {
  cv::Mat3b color;
  cv::Mat1b known;
  float min{std::numeric_limits<float>::infinity()};
  float max{-std::numeric_limits<float>::infinity()};
};

HeatMap Heat(const SeaLayer& layer, int width, int height) {
  HeatMap map;
  for (const float value : layer.values) {  // fmin and fmax ignore NaN
    map.min = std::fmin(map.min, value);
    map.max = std::fmax(map.max, value);
  }
  const float span = std::max(map.max - map.min, std::numeric_limits<float>::min());
  cv::Mat1b shade(height, width, std::uint8_t{0});
  map.known = cv::Mat1b(height, width, std::uint8_t{0});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float value = layer.values[static_cast<std::size_t>(y * width + x)];
      if (std::isnan(value)) continue;
      map.known(height - 1 - y, x) = 255;
      shade(height - 1 - y, x) =
          static_cast<std::uint8_t>(std::lround(255.0F * (value - map.min) / span));
    }
  }
  cv::applyColorMap(shade, map.color, cv::COLORMAP_VIRIDIS);
  return map;
}

}  // namespace

void DrawSea(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec, const std::string& name,
             const Layout& layout, const Fonts& fonts) {
  const SeaLayer layer = LayerOf(spec, name);
  const HeatMap heat = Heat(layer, spec.width, spec.height);
  const double cell_px = layout.view.cell_px();
  for (int y = 0; y < spec.height; ++y) {
    for (int x = 0; x < spec.width; ++x) {
      const int row = spec.height - 1 - y;
      if (heat.known(row, x) == 0) continue;
      const cv::Point2d middle = layout.view.ToPixel(x, y) + cv::Point2d(0.5, 0.5);
      const cv::Point low(cvRound(middle.x - cell_px / 2), cvRound(middle.y - cell_px / 2));
      const cv::Point high(cvRound(middle.x + cell_px / 2), cvRound(middle.y + cell_px / 2));
      const cv::Rect cell =
          cv::Rect(low, cv::Point(std::max(high.x, low.x + 1), std::max(high.y, low.y + 1))) &
          cv::Rect({0, 0}, map.size());
      cv::Mat part = map(cell);
      // The chart stays visible below, so that islands and rocks can be recognised.
      cv::addWeighted(part, 0.35, cv::Mat(part.size(), CV_8UC3, heat.color(row, x)), 0.65, 0.0,
                      part);
    }
  }
  const std::string words = heat.min > heat.max
                                ? layer.name + ": unknown"
                                : layer.name + ": " + Number(double(heat.min), 2) + " (dark) to " +
                                      Number(double(heat.max), 2) + " " + layer.units;
  const int margin = layout.Px(6.0);
  DrawLabel(map, fonts.bold, words, {margin, map.rows - margin - fonts.bold.cap_height()}, layout);
}

}  // namespace aquafarm_viz
