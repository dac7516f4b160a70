// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <string>

#include "aquafarm_viz/base/checks.h"
#include "draw/legend.h"
#include "draw/symbols.h"
#include "scene/graticule.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::FarmSpec;

// Returns the distance of each pixel to the nearest zero pixel of `away_from` [cells]; 1e6 if there
// is none.
cv::Mat1f DistanceCells(const cv::Mat1b& away_from, double cell_px) {
  if (cv::countNonZero(away_from) == away_from.size().area()) {
    return cv::Mat1f(away_from.size(), 1e6F);
  }
  cv::Mat1f distance;
  cv::distanceTransform(away_from, distance, cv::DIST_L2, cv::DIST_MASK_5);
  distance *= 1.0 / cell_px;
  return distance;
}

cv::Vec3b Pixel(Rgb color) { return {color.b, color.g, color.r}; }

void PaintSeaAndLand(cv::Mat& map, const FarmSpec& spec, const Layout& layout) {
  const Style& style = *layout.style;
  const cv::Mat1b land = IslandCoverage(spec, layout);
  cv::Mat1b reefs(map.size(), std::uint8_t{255});
  for (const auto& rock : spec.rocks) {
    if (!InGrid(spec, rock.cell.x, rock.cell.y)) continue;
    const cv::Point2d middle = layout.view.ToPixel(rock.cell.x, rock.cell.y);
    reefs(cv::Rect(cvRound(middle.x), cvRound(middle.y), 1, 1) & cv::Rect({0, 0}, reefs.size())) =
        0;
  }
  const double cell_px = layout.view.cell_px();
  const cv::Mat1f offshore = DistanceCells(255 - land, cell_px);
  const cv::Mat1f off_reef = DistanceCells(reefs, cell_px);
  const cv::Mat1f inland = DistanceCells(land, cell_px);
  for (int row = 0; row < map.rows; ++row) {
    const Rgb deep = Mix(style.sea_north, style.sea_south, double(row) / std::max(1, map.rows - 1));
    for (int column = 0; column < map.cols; ++column) {
      const double shore = std::max(0.75 * std::exp(-0.9 * offshore(row, column)),
                                    0.40 * std::exp(-1.8 * off_reef(row, column)));
      Rgb color = Mix(deep, style.sea_shallow, shore);
      if (const double cover = land(row, column) / 255.0; cover > 0.0) {
        const double depth = inland(row, column);
        const Rgb ground = depth < 0.45 ? Mix(style.sand, style.land, (depth - 0.12) / 0.33)
                                        : Mix(style.land, style.land_high, (depth - 0.45) / 2.0);
        color = Mix(color, ground, cover);
      }
      map.at<cv::Vec3b>(row, column) = Pixel(color);
    }
  }
}

void DrawGrid(cv::Mat& map, const Layout& layout) {
  const MapView& view = layout.view;
  const int step = view.cell_px() >= 8.0 ? 1 : CellTickStep(24.0 / view.cell_px());
  for (int x = step; x < view.width(); x += step) {
    const int column = cvRound(view.ToPixel(x - 0.5, 0).x);
    Tint(map, {column, 0, 1, map.rows}, Bgr(layout.style->grid), 0.08);
  }
  for (int y = step; y < view.height(); y += step) {
    const int row = cvRound(view.ToPixel(0, y - 0.5).y);
    Tint(map, {0, row, map.cols, 1}, Bgr(layout.style->grid), 0.08);
  }
}

// Writes a label below the map, centred on a column of pixels.
void LabelColumn(cv::Mat& image, const std::string& text, double column, const Layout& layout,
                 const Fonts& fonts) {
  fonts.small.Draw(image, text,
                   {layout.map.x + cvRound(column) - fonts.small.Width(text) / 2,
                    layout.map.y + layout.map.height + layout.Px(4) + fonts.small.cap_height()},
                   Bgr(layout.style->faint));
}

// Writes a label to the left of the map, centred on a row of pixels.
void LabelRow(cv::Mat& image, const std::string& text, double row, const Layout& layout,
              const Fonts& fonts) {
  fonts.small.Draw(image, text,
                   {layout.map.x - layout.Px(5) - fonts.small.Width(text),
                    layout.map.y + cvRound(row) + fonts.small.cap_height() / 2},
                   Bgr(layout.style->faint));
}

// Formats minutes of arc as degrees and minutes, such as 30°06'N.
std::string DegreesText(int minutes, char positive, char negative) {
  const int all = std::abs(minutes);
  const std::string rest = std::to_string(all % 60);
  return std::to_string(all / 60) + "\u00b0" + (rest.size() < 2 ? "0" : "") + rest + "'" +
         (minutes < 0 ? negative : positive);
}

void DrawGeographicAxes(cv::Mat& image, const FarmSpec& spec, const Layout& layout,
                        const Fonts& fonts) {
  const double cell_px = layout.view.cell_px();
  const int bottom = layout.map.y + layout.map.height;
  for (const auto& [minutes, cells] : LongitudeTicks(spec, 60.0 * layout.unit / cell_px)) {
    const double at = cells * cell_px;
    LabelColumn(image, DegreesText(minutes, 'E', 'W'), at, layout, fonts);
    Tint(image, {layout.map.x + cvRound(at), bottom, 1, layout.Px(3)}, Bgr(layout.style->faint),
         1.0);
  }
  for (const auto& [minutes, cells] : LatitudeTicks(spec, 34.0 * layout.unit / cell_px)) {
    const double at = cells * cell_px;
    LabelRow(image, DegreesText(minutes, 'N', 'S'), layout.map.height - at, layout, fonts);
    Tint(image, {layout.map.x - layout.Px(3), bottom - cvRound(at), layout.Px(3), 1},
         Bgr(layout.style->faint), 1.0);
  }
}

void DrawAxes(cv::Mat& image, const FarmSpec& spec, const Layout& layout, const Fonts& fonts) {
  if (HasGraticule(spec)) return DrawGeographicAxes(image, spec, layout, fonts);
  const MapView& view = layout.view;
  const int step = CellTickStep(34.0 * layout.unit / view.cell_px());
  for (int x = 0; x < view.width(); x += step) {
    LabelColumn(image, std::to_string(x), view.ToPixel(x, 0).x, layout, fonts);
  }
  for (int y = 0; y < view.height(); y += step) {
    LabelRow(image, std::to_string(y), view.ToPixel(0, y).y, layout, fonts);
  }
}

}  // namespace

void DrawRock(cv::Mat& image, cv::Point2d at, double radius_px) {
  static const std::vector<cv::Point2f> kBody{{-0.95F, -0.55F}, {-0.6F, 0.25F}, {-0.1F, 0.8F},
                                              {0.4F, 0.55F},    {0.9F, -0.1F},  {0.8F, -0.6F}};
  static const std::vector<cv::Point2f> kShade{{-0.1F, 0.8F}, {0.4F, 0.55F},  {0.9F, -0.1F},
                                               {0.8F, -0.6F}, {0.1F, -0.55F}, {0.15F, 0.1F}};
  const Pose2 placing{at, radius_px, 0.0};
  FillShape(image, kBody, placing, Bgr(kRock));
  FillShape(image, kShade, placing, Bgr(Mix(kRock, kRockDark, 0.55)));
  if (radius_px >= 4.0) StrokeShape(image, kBody, placing, Bgr(kRockDark), 1);
}

cv::Mat1b IslandCoverage(const FarmSpec& spec, const Layout& layout) {
  cv::Mat1b land(layout.map.size(), std::uint8_t{0});
  const double cell_px = layout.view.cell_px();
  for (const auto& cell : spec.islands) {
    if (!InGrid(spec, cell.x, cell.y)) continue;
    const cv::Point2d middle = layout.view.ToPixel(cell.x, cell.y) + cv::Point2d(0.5, 0.5);
    const cv::Point low(cvRound(middle.x - cell_px / 2), cvRound(middle.y - cell_px / 2));
    const cv::Point high(cvRound(middle.x + cell_px / 2), cvRound(middle.y + cell_px / 2));
    land(cv::Rect(low, cv::Point(std::max(high.x, low.x + 1), std::max(high.y, low.y + 1))) &
         cv::Rect({0, 0}, land.size())) = 255;
  }
  if (cell_px < 3.0 || spec.islands.empty()) return land;
  const double sigma = 0.27 * cell_px;
  // Replicates the border pixels, as if an island at the edge of the farm continued beyond it.
  cv::GaussianBlur(land, land, {}, sigma, sigma, cv::BORDER_REPLICATE);
  const double steepness = std::max(1.0, 1.7 * sigma);
  land.convertTo(land, -1, steepness, 127.5 * (1.0 - steepness));
  return land;
}

cv::Mat DrawBackground(const FarmSpec& spec, const Layout& layout, const Fonts& fonts,
                       ImageSize size) {
  cv::Mat image(size.height, size.width, CV_8UC3, Bgr(layout.style->panel));
  cv::Mat map = image(layout.map);
  PaintSeaAndLand(map, spec, layout);
  DrawGrid(map, layout);
  const double rock_px = std::max(0.42 * layout.view.cell_px(), 1.5);
  for (const auto& rock : spec.rocks) {
    if (!InGrid(spec, rock.cell.x, rock.cell.y)) continue;
    DrawRock(map, layout.view.ToPixel(rock.cell.x, rock.cell.y), rock_px);
  }
  if (layout.top.empty()) return image;
  cv::rectangle(
      image,
      cv::Rect(layout.map.x - 1, layout.map.y - 1, layout.map.width + 2, layout.map.height + 2),
      Bgr(layout.style->rule), 1);
  DrawAxes(image, spec, layout, fonts);
  for (const int y : {layout.top.height - 1, layout.bottom.y}) {
    cv::rectangle(image, cv::Rect(0, y, size.width, 1), Bgr(layout.style->rule), cv::FILLED);
  }
  DrawLegend(image, spec, layout, fonts);
  if (layout.panel.empty()) return image;
  cv::rectangle(image, cv::Rect(layout.panel.x, layout.panel.y, 1, layout.panel.height),
                Bgr(layout.style->rule), cv::FILLED);
  return image;
}

}  // namespace aquafarm_viz
