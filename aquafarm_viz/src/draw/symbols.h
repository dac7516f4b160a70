// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The parts of a picture; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "aquafarm_viz/base/text.h"
#include "aquafarm_viz/draw/canvas.h"
#include "aquafarm_viz/draw/image_options.h"
#include "aquafarm_viz/draw/map_view.h"
#include "aquafarm_viz/draw/style.h"
#include "aquafarm_viz/scene/directions.h"
#include "scene/outlook.h"
#include "scene/storm_track.h"

namespace aquafarm_viz {

class FreeSpace;

/// The future of a state's disasters.
struct Forecasts {
  std::vector<Course> courses;  ///< one per disaster of the state
  Outlook outlook;              ///< danger to the devices
};

/// The layout of a picture. A part with an empty rectangle is not drawn.
struct Layout {
  double unit{1.0};  ///< pixels per design unit: 1 in a picture of 640 x 640
  cv::Rect top;
  cv::Rect map;
  cv::Rect panel;
  cv::Rect bottom;
  MapView view;
  const Style* style{&DarkStyle()};

  /// Converts design units to whole pixels, at least 1.
  int Px(double units) const;
  /// Distance from the centre of a device to its corners [pixels].
  double device_radius_px() const;
  /// Radius of the disc of a port [pixels].
  double port_radius_px() const;
  /// Distance from the centre of a ship to its bow [pixels].
  double ship_radius_px() const;
};

/// Computes the layout of a picture of a width x height farm.
Layout MakeLayout(int width, int height, ImageSize size, const Style& style = DarkStyle());

/// The fonts of a picture.
struct Fonts {
  explicit Fonts(double unit);
  Font small;
  Font bold;
  Font title;
};

/// Draws the constant parts of an episode: sea, islands, rocks, axes, legend.
cv::Mat DrawBackground(const aquafarm_msgs::FarmSpec& spec, const Layout& layout,
                       const Fonts& fonts, ImageSize size);

/// Draws a sea layer of the spec's scenario onto the map of a background.
/// @throws std::invalid_argument "layers: got 'sea:salt', expected one of the scenario's: warmth"
void DrawSea(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec, const std::string& name,
             const Layout& layout, const Fonts& fonts);

/// Whether a disaster is drawn: it is known and has not ended.
inline bool IsDrawn(const aquafarm_msgs::DisasterState& disaster) {
  return disaster.known && disaster.steps_left > 0;
}

/// Returns the coverage of the map's pixels by islands: 0 water, 255 land. Coasts are rounded
/// within their cells.
cv::Mat1b IslandCoverage(const aquafarm_msgs::FarmSpec& spec, const Layout& layout);

/// Draws the rings of all disasters on the map: an outline, a tint and a pattern for each kind of
/// disaster. Where they overlap the worst risk counts.
/// @param land  IslandCoverage; fainter over land
/// @param is_tinted  false: nothing between the lines of the pattern
void ShadeDisasters(cv::Mat& map, const aquafarm_msgs::FarmState& state, const cv::Mat1b& land,
                    bool is_tinted, const Layout& layout);

/// Draws a part of an area at risk into a box of a legend: the pattern of the kind and the colour
/// of the risk.
void DrawRiskSample(cv::Mat& image, cv::Rect box, std::uint8_t kind, double risk,
                    const Layout& layout);

/// Draws the outline of a device, which marks where a ship fetched it.
void DrawFetched(cv::Mat& image, std::uint8_t kind, cv::Point2d at, double radius_px,
                 const Layout& layout);

/// Where the sign of a disaster is drawn [pixels of the map].
struct SignPlace {
  cv::Point2d at;        ///< centre, or the pointer at the border
  cv::Point2d arrow_to;  ///< `at` if it stands still or the centre lies outside the map
  bool is_inside{};      ///< false: the centre lies outside the map
};
SignPlace PlaceSign(const aquafarm_msgs::DisasterState& disaster, const Layout& layout);
/// Returns a place for each disaster of the state. Pointers that would overlap are moved apart
/// along the border.
std::vector<SignPlace> PlaceSigns(const aquafarm_msgs::FarmState& state, const Layout& layout);

/// Draws each disaster's centre and heading, or a pointer at the border if it is outside the map.
void DrawDisasterSigns(cv::Mat& map, const aquafarm_msgs::FarmState& state, const Layout& layout,
                       const Fonts& fonts);

/// Draws a text with an outline, so that it can be read on any background.
/// @param top_left  of its capital letters
/// @param color  without it, that of labels
void DrawLabel(cv::Mat& image, const Font& font, const std::string& text, cv::Point top_left,
               const Layout& layout);
void DrawLabel(cv::Mat& image, const Font& font, const std::string& text, cv::Point top_left,
               const Layout& layout, Rgb color);

/// Draws the trails or routes of the ships: older parts fade into the sea.
void DrawPaths(cv::Mat& map, const aquafarm_msgs::FarmState& state, const Trail& paths,
               const Layout& layout);

/// Draws the colours of paths along a short line, the start on the left.
void DrawPathSample(cv::Mat& image, cv::Point2d from, cv::Point2d to,
                    const aquafarm_msgs::FarmState& state, const Layout& layout);

/// Blends the colours of V_π over the map, and grey over rocks, which have no value.
void DrawValues(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec, const Values& values,
                const Layout& layout);

/// Draws the colour scale of V_π into a corner of the map.
/// @param space  free part of the map; the scale takes a part of it
void DrawValueScale(cv::Mat& map, const Values& values, FreeSpace& space, const Layout& layout,
                    const Fonts& fonts);

/// A cached drawing that can be blended over maps: premultiplied colours, and the fraction of the
/// background that each keeps.
class Overlay {
 public:
  /// @param size size of the canvas
  /// @param middle centre of the drawing on the canvas
  /// @param draw draws the same picture onto any map
  Overlay(cv::Size size, cv::Point middle, const std::function<void(cv::Mat& map)>& draw);
  /// Blends the drawing over a map with its centre at `middle`. Parts outside the map are clipped.
  void LayOver(cv::Mat& map, cv::Point middle) const;

 private:
  struct Pixel {
    cv::Point at;     // offset from the centre
    cv::Vec3b color;  // colour over black
    int keep;         // fraction of the background, [0, 255]
  };
  std::vector<Pixel> pixels_;
};

/// Draws an arrow 0.76 * size_px long around `middle`.
void DrawArrow(cv::Mat& map, cv::Point2d middle, int bearing_deg, double size_px,
               const cv::Scalar& color, int thickness);

/// Draws the arrows of the legal moves around each port.
void DrawDirections(cv::Mat& map, const std::vector<PortDirections>& ports, const Layout& layout);

/// Draws one greedy action: an arrow for a move, a disc for a pickup, a ring for a drop-off.
void DrawMove(cv::Mat& map, cv::Point2d at, std::uint8_t action, double size_px,
              const Layout& layout);

/// Returns the distance of two symbols of best moves along each axis [cells].
int MoveSpacing(const Layout& layout);

/// Draws the greedy actions of ShownActions with symbols that are drawn once and then copied to the
/// nearest pixel.
class MoveSigns {
 public:
  explicit MoveSigns(const Layout& layout);
  /// @param space  symbols are left out where it is used; null draws all
  void Draw(cv::Mat& map, const Values& values, const FreeSpace* space = nullptr) const;
  /// Distance of two symbols along each axis [cells].
  int every() const { return every_; }
  double size_px() const { return size_px_; }

 private:
  static constexpr std::uint8_t kSigns = 10;  // all actions except hold

  MapView view_;
  int every_;
  double size_px_;
  cv::Point2d phase_;  // position of a cell's centre within its pixel
  std::vector<Overlay> signs_;
};

/// Draws the actions that a compared policy chooses for each ship.
void DrawChoice(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                const aquafarm_msgs::FarmState& state, const aquafarm_msgs::PolicyChoice& choice,
                const Layout& layout);

/// Writes these actions into a corner of the map.
void DrawChoiceWords(cv::Mat& map, const aquafarm_msgs::FarmState& state,
                     const aquafarm_msgs::PolicyChoice& choice, FreeSpace& space,
                     const Layout& layout, const Fonts& fonts);

/// Draws the sensor range of each ship in partial view.
void DrawSight(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
               const aquafarm_msgs::FarmState& state, const Layout& layout);

/// Returns where a ship is drawn: in its cell, or next to the port in this cell.
cv::Point2d ShipPlace(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                      const aquafarm_msgs::ShipState& ship, const Layout& layout);

/// Draws ports with their letters.
void DrawPorts(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec, const Layout& layout,
               const Fonts& fonts);

/// Draws devices that are deployed or delivered.
void DrawDevices(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                 const aquafarm_msgs::FarmState& state, const Layout& layout);

/// Draws ships with the devices aboard, and self-propelled devices.
void DrawShips(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
               const aquafarm_msgs::FarmState& state, const Trail* trail, const Layout& layout);

/// Draws a rock.
void DrawRock(cv::Mat& image, cv::Point2d at, double radius_px);

/// Draws the symbol of a device with a dark rim.
void DrawDeviceSymbol(cv::Mat& image, std::uint8_t kind, const Pose2& placing, double faded);

/// Draws the text above and below the map, and the end of the episode.
void DrawWords(cv::Mat& image, const aquafarm_msgs::FarmSpec& spec,
               const aquafarm_msgs::FarmState& state, const Overlays& overlays,
               const Outlook& outlook, const Layout& layout, const Fonts& fonts);

/// Draws the lists of the panel, the key of a policy and the region.
/// @param values  of this farm; null without any
/// @return whether the key of a policy is drawn: its values, best moves and choice
bool DrawPanel(cv::Mat& image, const aquafarm_msgs::FarmSpec& spec,
               const aquafarm_msgs::FarmState& state, const Overlays& overlays,
               const Values* values, const Forecasts& forecasts, const Layout& layout,
               const Fonts& fonts);

}  // namespace aquafarm_viz
