// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The layout of a picture and the functions that draw its parts; private to this package.

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
#include "scene/coast.h"
#include "scene/outlook.h"
#include "scene/storm_track.h"

namespace aquafarm_viz {

class FreeSpace;

/// The expected courses of the disasters of a state, and the danger to the devices.
struct Forecasts {
  std::vector<Course> courses;  ///< one per disaster of the state
  Outlook outlook;              ///< danger to the devices
};

/// The rectangles of the parts of a picture [pixels]. A part with an empty rectangle is not drawn.
struct Layout {
  double unit{1.0};  ///< pixels per design unit: 1 in a picture of 640 x 640, at least 0.7
  cv::Rect top;
  cv::Rect map;
  cv::Rect panel;
  cv::Rect key;  ///< legend below the map; empty: the panel contains the legend
  cv::Rect bottom;
  MapView view;
  const Style* style{&DarkStyle()};

  /// Converts design units to whole pixels, at least 1.
  int Px(double units) const;
  /// Returns the distance from the centre of a device to its corners [pixels].
  double device_radius_px() const;
  /// Returns the radius of the disc of a port [pixels].
  double port_radius_px() const;
  /// Returns the distance from the centre of a ship to its bow [pixels].
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
  Font headline;  ///< its size is between those of `bold` and `title`
};

/// Draws the parts that are constant during an episode: sea, islands, rocks, axes and the constant
/// part of the legend.
cv::Mat DrawBackground(const aquafarm_msgs::FarmSpec& spec, const Layout& layout,
                       const Fonts& fonts, ImageSize size);

/// Draws a sea layer of the spec's scenario onto the map of a background.
/// @throws std::invalid_argument if the scenario cannot be read, if the size of the layer is not
///         that of the farm, or if there is no such layer: "layers: got 'sea:salt', expected one of
///         the scenario's sea layers: warmth"
void DrawSea(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec, const std::string& name,
             const Layout& layout, const Fonts& fonts);

/// Returns the colour of a risk.
inline Rgb RiskColor(double risk, const Layout& layout) {
  return layout.style->Risk(Severity(risk));
}

/// Returns the colour of a text about a risk.
inline Rgb RiskTextColor(double risk, const Layout& layout) {
  return layout.style->RiskText(Severity(risk));
}

/// Returns whether a disaster is drawn: it is known and has not ended.
inline bool IsDrawn(const aquafarm_msgs::DisasterState& disaster) {
  return disaster.known && disaster.steps_left > 0;
}

/// Returns the coverage of the map's pixels by islands: 0 water, 255 land. Coasts are rounded
/// within their cells.
cv::Mat1b IslandCoverage(const aquafarm_msgs::FarmSpec& spec, const Layout& layout);

/// Draws the rings of the disasters on the map (IsDrawn): their outlines, a tint, and the pattern
/// that marks the kind of disaster. Where rings overlap, tint and pattern are those of the worst
/// risk.
/// @param land  IslandCoverage; rings are fainter over land
/// @param is_filled  false: draws only the outlines
void ShadeDisasters(cv::Mat& map, const aquafarm_msgs::FarmState& state, const cv::Mat1b& land,
                    bool is_filled, const Layout& layout);

/// Fills a box of the legend like a ring on the map: with the pattern of a kind of disaster and the
/// colour of a risk.
/// @param is_filled  false: draws only the outline, as ShadeDisasters
void DrawRiskSample(cv::Mat& image, cv::Rect box, std::uint8_t kind, double risk, bool is_filled,
                    const Layout& layout);

/// Draws the outline that marks the cell from which a ship has fetched a device.
void DrawFetched(cv::Mat& image, std::uint8_t kind, cv::Point2d at, double radius_px,
                 const Layout& layout);

/// The position of the sign of a disaster [pixels of the map].
struct SignPlace {
  cv::Point2d at;        ///< the centre of the disaster, or its pointer at the border
  cv::Point2d arrow_to;  ///< tip of the arrow of its motion; equals `at` if there is no arrow
  bool is_inside{};      ///< false: the centre lies outside the map
};
/// Returns the position of the sign of one disaster. A sign has an arrow if the disaster moves, and
/// both its centre and the tip of the arrow are on the map.
SignPlace PlaceSign(const aquafarm_msgs::DisasterState& disaster, const Layout& layout);
/// Returns the position of the sign of each disaster of the state. Pointers that would overlap are
/// moved apart along the border if there is space.
std::vector<SignPlace> PlaceSigns(const aquafarm_msgs::FarmState& state, const Layout& layout);

/// Draws the centre of each disaster (IsDrawn) with its arrow (PlaceSign). If the centre is outside
/// the map, draws a pointer at the border instead.
void DrawDisasterSigns(cv::Mat& map, const aquafarm_msgs::FarmState& state, const Layout& layout,
                       const Fonts& fonts);

/// Draws a text with an outline, so that it can be read on any background.
/// @param top_left  the upper left corner of its capital letters [pixels]
/// @param color  default: Style::label
void DrawLabel(cv::Mat& image, const Font& font, const std::string& text, cv::Point top_left,
               const Layout& layout);
void DrawLabel(cv::Mat& image, const Font& font, const std::string& text, cv::Point top_left,
               const Layout& layout, Rgb color);

/// Blends the colours of V_π over the map, and grey over the cells of rocks, which have no value.
void DrawValues(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec, const Values& values,
                const Layout& layout);

/// Draws the colour scale of V_π near the lower left corner of the map. Draws nothing if all values
/// are equal or there is no space.
/// @param space  free part of the map; the part under the scale is then marked as used
void DrawValueScale(cv::Mat& map, const Values& values, FreeSpace& space, const Layout& layout,
                    const Fonts& fonts);

/// A cached drawing that can be blended over maps. Each pixel has a premultiplied colour and the
/// fraction of the background that stays visible.
class Overlay {
 public:
  /// @param size size of the canvas
  /// @param middle centre of the drawing on the canvas
  /// @param draw draws the picture; it is called with a black and with a white canvas
  Overlay(cv::Size size, cv::Point middle, const std::function<void(cv::Mat& map)>& draw);
  /// Blends the drawing over a map with its centre at `middle`. Parts outside the map are clipped.
  void LayOver(cv::Mat& map, cv::Point middle) const;

 private:
  struct Pixel {
    cv::Point at;     // offset from the centre
    cv::Vec3b color;  // colour over black
    int keep;         // fraction of the background, 0 … 255
  };
  std::vector<Pixel> pixels_;
};

/// Draws an arrow around `middle`, 0.76 * size_px long. @param bearing_deg  clockwise from north
void DrawArrow(cv::Mat& map, cv::Point2d middle, int bearing_deg, double size_px,
               const cv::Scalar& color, int thickness);

/// Draws the arrows of the legal moves around each port.
void DrawDirections(cv::Mat& map, const std::vector<PortDirections>& ports, const Layout& layout);
/// Marks the space of the arrows of DrawDirections as used.
void BlockDirections(const std::vector<PortDirections>& ports, const Layout& layout,
                     FreeSpace& space);

/// Draws the symbol of one greedy action: an arrow for a move, a disc for a pickup, a ring for a
/// drop-off.
void DrawMove(cv::Mat& map, cv::Point2d at, std::uint8_t action, double size_px,
              const Layout& layout);

/// Returns the distance between symbols of greedy actions along each axis [cells].
int MoveSpacing(const Layout& layout);

/// Draws the greedy actions that ShownActions selects. The symbol of each action is drawn once and
/// then copied to the pixel that is nearest to the centre of each cell.
class MoveSigns {
 public:
  explicit MoveSigns(const Layout& layout);
  /// @param space  symbols are drawn only where it is free; nullptr: everywhere
  void Draw(cv::Mat& map, const Values& values, const FreeSpace* space = nullptr) const;
  /// Returns MoveSpacing.
  int every() const { return every_; }
  /// Returns the size of the symbols, as for DrawMove [pixels].
  double size_px() const { return size_px_; }

 private:
  static constexpr std::uint8_t kSigns = 10;  // all actions except hold

  MapView view_;
  int every_;
  double size_px_;
  cv::Point2d phase_;  // position of a cell's centre within its pixel
  std::vector<Overlay> signs_;
};

/// Draws the action that a policy chooses for each ship, for comparison with the recorded action
/// (PolicyChoice). Draws nothing if the choice was made in another state.
void DrawChoice(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                const aquafarm_msgs::FarmState& state, const aquafarm_msgs::PolicyChoice& choice,
                const Layout& layout);

/// Writes the actions of DrawChoice near the lower right corner of the map. Writes nothing if the
/// choice was made in another state.
/// @param space  free part of the map; the part under the text is then marked as used
void DrawChoiceWords(cv::Mat& map, const aquafarm_msgs::FarmState& state,
                     const aquafarm_msgs::PolicyChoice& choice, FreeSpace& space,
                     const Layout& layout, const Fonts& fonts);

/// Draws the sensor range of each ship. Draws nothing if the scenario has full view.
void DrawSight(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
               const aquafarm_msgs::FarmState& state, const Layout& layout);

/// Returns where a ship is drawn [pixels of the map]: in its cell, or next to the port in this
/// cell.
cv::Point2d ShipPlace(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                      const aquafarm_msgs::ShipState& ship, const Layout& layout);

/// Draws ports with their letters.
void DrawPorts(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec, const Layout& layout,
               const Fonts& fonts);

/// Draws the deployed and the delivered devices, and the outlines of fetched devices in their
/// former cells. Self-propelled devices are drawn by DrawShips until they are delivered.
void DrawDevices(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                 const aquafarm_msgs::FarmState& state, const Layout& layout);

/// Draws the ships, each with at most three of its devices aboard, and the self-propelled devices.
/// @param trail  gives the bearing of ships that do not move; may be null
void DrawShips(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
               const aquafarm_msgs::FarmState& state, const Trail* trail, const Layout& layout);

/// Draws a rock.
void DrawRock(cv::Mat& image, cv::Point2d at, double radius_px);

/// Draws the symbol of a device with a dark rim. @param faded  0: in its colour, 1: grey
void DrawDeviceSymbol(cv::Mat& image, std::uint8_t kind, const Pose2& placing, double faded);

/// Draws the texts above and below the map. After the end of an episode, draws why it ended.
void DrawWords(cv::Mat& image, const aquafarm_msgs::FarmSpec& spec,
               const aquafarm_msgs::FarmState& state, const Overlays& overlays,
               const Outlook& outlook, const Layout& layout, const Fonts& fonts);

/// Draws the panel: the lists, the key of a policy (its values, best moves and choice), the region,
/// and the variable part of the legend.
/// @param values  values for this farm; nullptr: none
/// @param coast  CoastAround of the farm
/// @return whether there is a policy and its key was drawn
bool DrawPanel(cv::Mat& image, const aquafarm_msgs::FarmSpec& spec,
               const aquafarm_msgs::FarmState& state, const Overlays& overlays,
               const Values* values, const Forecasts& forecasts,
               const std::vector<CoastRing>& coast, const Layout& layout, const Fonts& fonts);

}  // namespace aquafarm_viz
