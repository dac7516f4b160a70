// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Colours and outlines that pictures and markers share.

#include <cstdint>
#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

namespace aquafarm_viz {

/// An opaque colour.
struct Rgb {
  std::uint8_t r{};
  std::uint8_t g{};
  std::uint8_t b{};
};

/// Converts a colour to OpenCV's BGR order.
inline cv::Scalar Bgr(Rgb c) { return {double(c.b), double(c.g), double(c.r)}; }

/// Interpolates two colours: `share` 0 gives `from`, 1 gives `to`. Clamps `share` to [0, 1].
Rgb Mix(Rgb from, Rgb to, double share);

inline constexpr Rgb kSeaDeep{0x1b, 0x4f, 0x78};
inline constexpr Rgb kSeaShallow{0x5f, 0xa8, 0xc4};
inline constexpr Rgb kSand{0xe9, 0xd8, 0xa6};
inline constexpr Rgb kLand{0x7d, 0x9d, 0x6a};
inline constexpr Rgb kLandHigh{0x5b, 0x80, 0x52};
inline constexpr Rgb kRock{0x8a, 0x86, 0x80};
inline constexpr Rgb kRockDark{0x4a, 0x47, 0x45};
inline constexpr Rgb kPort{0xff, 0xff, 0xff};
inline constexpr Rgb kInk{0x12, 0x20, 0x2e};
inline constexpr Rgb kPaper{0xf4, 0xf7, 0xf9};
inline constexpr Rgb kUnknown{0xb4, 0xbd, 0xc4};
/// Colour of the choice of a compared policy: cyan, which neither risks nor values have.
inline constexpr Rgb kChoiceColor{0x4d, 0xe3, 0xff};

/// Colour of the arrows of legal moves and, in rviz, of the labels of devices. No risk has this
/// colour.
inline constexpr Rgb kDirectionColor{0xdd, 0xf4, 0xff};

/// Returns the colour of a device kind (DeviceState.kind); grey for an unknown kind. No risk has
/// one of these colours.
Rgb DeviceColor(std::uint8_t kind);

/// Returns the short name of a device kind, such as "monitoring"; "kind 7" for an unknown kind.
std::string DeviceName(std::uint8_t kind);

/// Returns the outline of a device kind around the origin: y up, within the unit circle,
/// counter-clockwise. An unknown kind has a diamond.
const std::vector<cv::Point2f>& DeviceOutline(std::uint8_t kind);

/// Returns the colour of a health: green at 1, amber at 0.5, red at 0, interpolated in between.
Rgb HealthColor(double health);

/// Returns the colour of the deck of a ship. Six colours repeat by id.
Rgb ShipColor(std::int32_t id);

/// Returns the outline of a ship's hull around the origin: bow at (0, 1), y up, counter-clockwise.
const std::vector<cv::Point2f>& HullOutline();

/// Returns the outline of the pointer to a centre outside the farm: tip up, y up, the origin
/// inside, counter-clockwise.
const std::vector<cv::Point2f>& PointerOutline();

/// Returns the severity of a risk: 0 at -5 and above, 1 at -20 and below, linear in between.
double Severity(double risk);

/// Returns the colour of a severity in [0, 1] on dark water: from yellow through orange and red to
/// magenta.
Rgb SeverityColor(double severity);

/// Returns the colour of a bulletin's grade: 1 blue, 2 yellow, 3 orange, 4 red; grey for another
/// grade.
Rgb GradeColor(std::uint8_t grade);

/// Returns the colour of a value: the colour map viridis from dark violet to green. The yellow part
/// is left out, because yellow marks a risk.
/// @param share 0 for the lowest value, 1 for the highest
Rgb ValueColor(double share);

/// Colours of the frames in rviz around cells whose greedy action is a pickup or a drop-off.
inline constexpr Rgb kPickupColor{0xff, 0xa6, 0xd9};
inline constexpr Rgb kDropOffColor{0xff, 0x8c, 0x42};

/// Returns the bearing of a move [degrees], clockwise from north; -1 if the action is not a move.
int MoveBearingDeg(std::uint8_t action);

/// Returns the one of 16 compass points that is nearest to a bearing [degrees], such as "NNE".
std::string CompassPoint(int bearing_deg);

/// Returns the letters of a port, by id: A, B, …, Z, AA, AB, …
std::string PortLetter(std::int32_t id);

}  // namespace aquafarm_viz
