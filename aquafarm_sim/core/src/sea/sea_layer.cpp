// SPDX-License-Identifier: BSD-3-Clause
// Interpolates fields of the sea on the cells of a ranch. A build without netCDF compiles this
// file, too.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "aquafarm/sea/sea_field.h"

namespace aquafarm {
namespace {

// Position of a coordinate between two coordinates of the field. Locate returns nullopt for a
// coordinate that is outside the field by more than half a mean step, or by more than 0.5 degrees
// if the field has a single coordinate.
struct Between {
  std::array<Eigen::Index, 2> index{};
  double part{};
};

std::optional<Between> Locate(const std::vector<double>& at, double wanted) {
  const double margin =
      at.size() > 1 ? (at.back() - at.front()) / static_cast<double>(at.size() - 1) / 2.0 : 0.5;
  if (wanted < at.front() - margin || wanted > at.back() + margin) return std::nullopt;
  const auto next = std::upper_bound(at.begin(), at.end(), wanted);
  const auto last = static_cast<Eigen::Index>(at.size()) - 1;
  const auto i = static_cast<Eigen::Index>(next - at.begin());
  const Eigen::Index low = std::clamp<Eigen::Index>(i - 1, 0, last);
  const Eigen::Index high = std::clamp<Eigen::Index>(i, 0, last);
  const double span = at[static_cast<std::size_t>(high)] - at[static_cast<std::size_t>(low)];
  const double part = span > 0.0 ? (wanted - at[static_cast<std::size_t>(low)]) / span : 0.0;
  return Between{{low, high}, std::clamp(part, 0.0, 1.0)};
}

float ValueAt(const SeaField& field, GeoPoint point) {
  double longitude = point.longitude;
  while (longitude < field.longitude.front() - 180.0) longitude += 360.0;
  while (longitude > field.longitude.back() + 180.0) longitude -= 360.0;
  const std::optional<Between> row = Locate(field.latitude, point.latitude);
  const std::optional<Between> column = Locate(field.longitude, longitude);
  if (!row || !column) return kNoSeaValue;
  double sum = 0.0;
  double weights = 0.0;
  for (std::size_t r = 0; r < 2; ++r) {
    for (std::size_t c = 0; c < 2; ++c) {
      const double weight =
          (r == 0 ? 1.0 - row->part : row->part) * (c == 0 ? 1.0 - column->part : column->part);
      const float value = field.value(row->index[r], column->index[c]);
      if (std::isnan(value)) continue;
      sum += weight * static_cast<double>(value);
      weights += weight;
    }
  }
  return weights > 0.0 ? static_cast<float>(sum / weights) : kNoSeaValue;
}

}  // namespace

Layer ToLayer(const SeaField& field, const GeoFrame& frame, std::int32_t width,
              std::int32_t height) {
  Layer layer(height, width);
  for (std::int32_t y = 0; y < height; ++y) {
    for (std::int32_t x = 0; x < width; ++x) layer(y, x) = ValueAt(field, frame.ToGeo(x, y));
  }
  return layer;
}

}  // namespace aquafarm
