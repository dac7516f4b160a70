// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The parts that a picture is put together from; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "aquafarm_viz/base/text.h"
#include "aquafarm_viz/draw/canvas.h"
#include "aquafarm_viz/draw/image_options.h"
#include "aquafarm_viz/draw/map_view.h"

namespace aquafarm_viz {

/// Where everything lies in a picture of some size; an empty rectangle is left out.
struct Layout {
  double unit{1.0};  ///< pixels of a design unit: 1 in a picture of 640 x 640
  cv::Rect top;
  cv::Rect map;
  cv::Rect panel;
  cv::Rect bottom;
  MapView view;

  /// Design units as whole pixels, at least 1.
  int Px(double units) const;
  /// Pixels from the middle of a device to its corners.
  double device_radius_px() const;
  /// Pixels from the middle of a ship to its bow.
  double ship_radius_px() const;
};

/// Lays a picture out.
Layout MakeLayout(int width, int height, ImageSize size);

/// The fonts of a picture.
struct Fonts {
  explicit Fonts(double unit);
  Font small;
  Font bold;
  Font title;
};

/// Steps of an axis: 1, 2 or 5 times a power of ten, at least `least_px` apart.
int TickStep(double cell_px, double least_px);

/// Draws what stays the same during an episode: sea, islands, rocks, axes, legend.
cv::Mat DrawBackground(const aquafarm_msgs::FarmSpec& spec, const Layout& layout,
                       const Fonts& fonts, ImageSize size);

/// Draws the legend, the north arrow and the scale bar into the panel.
void DrawLegend(cv::Mat& image, const aquafarm_msgs::FarmSpec& spec, const Layout& layout,
                const Fonts& fonts);

/// Paints a layer of the sea, named in the spec's scenario, onto a background's map.
/// @throws std::invalid_argument "layers: got 'sea:salt', expected one of the scenario's: warmth"
void DrawSea(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec, const std::string& name,
             const Layout& layout, const Fonts& fonts);

/// Shades the rings of all disasters on the map, the worst risk where they meet.
void ShadeDisasters(cv::Mat& map, const aquafarm_msgs::FarmState& state, const Layout& layout);

/// Draws each disaster's centre and heading, or at the border where it is outside.
void DrawDisasterSigns(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                       const aquafarm_msgs::FarmState& state, const Layout& layout,
                       const Fonts& fonts);

/// Draws the ways that ships came.
void DrawWakes(cv::Mat& map, const aquafarm_msgs::FarmState& state, const Wake& wake,
               const Layout& layout);

/// Draws the ways that ships came since the episode began, from violet over red to yellow.
void DrawRoutes(cv::Mat& map, const aquafarm_msgs::FarmState& state, const Wake& route,
                const Layout& layout);

/// Lays the colours of V_π over the map.
void DrawValues(cv::Mat& map, const Values& values);

/// Draws the scale of those colours into a corner of the map.
void DrawValueScale(cv::Mat& map, const Values& values, const Layout& layout, const Fonts& fonts);

/// What is drawn over a map, kept to be laid over others: premultiplied colours with what they keep
/// of what is below.
class Overlay {
 public:
  /// @param middle of what is drawn, on a canvas of a size
  /// @param draw draws the same onto whatever it is given
  Overlay(cv::Size size, cv::Point middle, const std::function<void(cv::Mat& map)>& draw);
  /// Puts the middle to a place of a map, which may leave out part of it.
  void LayOver(cv::Mat& map, cv::Point middle) const;

 private:
  struct Pixel {
    cv::Point at;     // from the middle
    cv::Vec3b color;  // as over black
    int keep;         // of 255
  };
  std::vector<Pixel> pixels_;
};

/// Draws one best move: an arrow, for a pickup a disc, for a drop-off a ring.
void DrawMove(cv::Mat& map, cv::Point2d at, std::uint8_t action, double size_px,
              const Layout& layout);

/// The best move of each cell, by signs that are drawn once and put to the nearest pixel.
class MoveSigns {
 public:
  explicit MoveSigns(const Layout& layout);
  void Draw(cv::Mat& map, const Values& values) const;
  /// Of cells that have a sign, along each axis.
  int every() const { return every_; }
  double size_px() const { return size_px_; }

 private:
  static constexpr std::uint8_t kSigns = 10;  // actions but hold

  MapView view_;
  int every_;
  double size_px_;
  cv::Point2d phase_;  // of a cell's middle within its pixel
  std::vector<Overlay> signs_;
};

/// Draws what another policy would do with each ship.
void DrawChoice(cv::Mat& map, const aquafarm_msgs::FarmState& state,
                const aquafarm_msgs::PolicyChoice& choice, const Layout& layout,
                const Fonts& fonts);

/// Draws how far each ship sees in partial view.
void DrawSight(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
               const aquafarm_msgs::FarmState& state, const Layout& layout);

/// Draws ports with their letters.
void DrawPorts(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec, const Layout& layout,
               const Fonts& fonts);

/// Draws devices that are deployed or delivered.
void DrawDevices(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                 const aquafarm_msgs::FarmState& state, const Layout& layout);

/// Draws ships with what they carry, and self-propelled devices.
void DrawShips(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
               const aquafarm_msgs::FarmState& state, const Wake* wake, const Layout& layout,
               const Fonts& fonts);

/// Draws the symbol of a device with a dark rim.
void DrawDeviceSymbol(cv::Mat& image, std::uint8_t kind, const Placing& placing, double faded);

/// Writes the lines above and below the map, the lists of the panel and how the episode ended.
void DrawWords(cv::Mat& image, const aquafarm_msgs::FarmSpec& spec,
               const aquafarm_msgs::FarmState& state, const Extras& extras, const Layout& layout,
               const Fonts& fonts);

inline constexpr Rgb kPanel{0x10, 0x1d, 0x2a};  ///< behind words
inline constexpr Rgb kRule{0x2b, 0x3d, 0x4f};   ///< thin lines between parts
inline constexpr Rgb kWords{0xe6, 0xed, 0xf3};  ///< words
inline constexpr Rgb kFaint{0x8b, 0x9b, 0xab};  ///< words that matter less
inline constexpr Rgb kGood{0x5f, 0xe0, 0x8a};   ///< a reward above 0
inline constexpr Rgb kBad{0xff, 0x7b, 0x72};    ///< a reward below 0

}  // namespace aquafarm_viz
