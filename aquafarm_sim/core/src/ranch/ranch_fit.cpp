// SPDX-License-Identifier: BSD-3-Clause
#include "ranch/ranch_fit.h"

#include <algorithm>
#include <cmath>

#include "aquafarm/base/check.h"
#include "base/text.h"
#include "base/time.h"
#include "grid/longitude.h"
#include "ranch/ranch_text.h"

namespace aquafarm::internal {
namespace {

// A region of the globe [degrees]; longitudes are relative to the ranch's middle.
struct Extent {
  double south{90.0}, north{-90.0}, west{1.0e9}, east{-1.0e9};

  void Add(GeoPoint point, double middle) {
    const double east_of = std::remainder(point.longitude - middle, 360.0);
    south = std::min(south, point.latitude);
    north = std::max(north, point.latitude);
    west = std::min(west, east_of);
    east = std::max(east, east_of);
  }
  bool Meets(const Extent& other) const {
    return south <= other.north && north >= other.south && west <= other.east && east >= other.west;
  }
};

GeoPoint MiddleOf(const RanchArea& ranch) {
  return ranch.frame.ToGeo((ranch.width - 1) / 2.0, (ranch.height - 1) / 2.0);
}

Extent ExtentOf(const RanchArea& ranch) {
  const double middle = MiddleOf(ranch).longitude;
  Extent extent;
  for (const double x : {-0.5, ranch.width / 2.0, ranch.width - 0.5}) {
    for (const double y : {-0.5, ranch.height / 2.0, ranch.height - 0.5}) {
      extent.Add(ranch.frame.ToGeo(x, y), middle);
    }
  }
  return extent;
}

std::string Degrees(const Extent& extent, double middle) {
  return Text("latitude %.3f to %.3f, longitude %.3f to %.3f", extent.south, extent.north,
              NormalLongitude(std::remainder(extent.west + middle, 360.0)),
              NormalLongitude(std::remainder(extent.east + middle, 360.0)));
}

[[noreturn]] void RefuseElsewhere(const std::string& what, const Extent& got,
                                  const RanchArea& ranch, const std::string& next) {
  const double middle = MiddleOf(ranch).longitude;
  throw InputError(what + ": got " + Degrees(got, middle) +
                   ", expected an area with the ranch at " + Degrees(ExtentOf(ranch), middle) +
                   "; " + next);
}

}  // namespace

void NeedCover(const Coast& coast, const RanchArea& ranch, const std::string& path) {
  const double middle = MiddleOf(ranch).longitude;
  const Extent wanted = ExtentOf(ranch);
  Extent all;
  for (const CoastPolygon& polygon : coast.polygons) {
    for (const CoastRing& ring : polygon) {
      for (const GeoPoint& point : ring) all.Add(point, middle);
    }
  }
  if (!all.Meets(wanted)) {
    RefuseElsewhere(path, all, ranch, "check --center, or leave out --chart for open sea");
  }
}

std::string NeedCover(const AsciiGrid& grid, const RanchArea& ranch, const std::string& path) {
  std::int32_t outside = 0;
  for (std::int32_t y = 0; y < ranch.height; ++y) {
    for (std::int32_t x = 0; x < ranch.width; ++x) {
      outside += grid.Covers(ranch.frame.ToGeo(x, y)) ? 0 : 1;
    }
  }
  const std::int32_t cells = ranch.width * ranch.height;
  if (outside == 0) return "";
  if (outside < cells) {
    return path + Text(": %d of %d cells of the ranch lie outside the grid and become land",
                       outside, cells);
  }
  const double middle = MiddleOf(ranch).longitude;
  const double half = grid.cell_size / 2.0;
  Extent all;
  all.south = grid.south - half;
  all.north = grid.south + (static_cast<double>(grid.value.rows()) - 0.5) * grid.cell_size;
  all.west = std::remainder(grid.west - half - middle, 360.0);
  all.east = all.west + static_cast<double>(grid.value.cols()) * grid.cell_size;
  RefuseElsewhere(path, all, ranch, "check --center, or leave out --chart for open sea");
}

void NeedValues(const SeaField& field, const Layer& layer, const RanchArea& ranch,
                const std::string& path) {
  if (!layer.isNaN().all()) return;
  const double middle = MiddleOf(ranch).longitude;
  const Extent file{field.extent[0], field.extent[1], field.extent[2] - middle,
                    field.extent[3] - middle};
  const std::string what = path + ": " + field.name;
  if (!file.Meets(ExtentOf(ranch))) {
    RefuseElsewhere(what, file, ranch, "check --center, or use another file with --sea");
  }
  throw InputError(what +
                   ": got no value on this ranch, expected at least one; its cells there are " +
                   "land or missing: use another file with --sea");
}

std::string CheckTime(const SeaField& field, std::optional<std::int64_t> start,
                      const std::string& path) {
  constexpr double kDay_s = 86400.0;
  constexpr double kMax_days = 2.0;
  if (!start || !field.time) return "";
  const double days = std::abs(static_cast<double>(*field.time - *start)) / kDay_s;
  if (days <= kMax_days) return "";
  return path + ": " + field.name + ": got " + FormatTime(*field.time) +
         " as the time nearest to the start, expected one within " + Format(kMax_days) +
         " days of " + FormatTime(*start) + Text("; it is %.0f days off: check --start", days);
}

std::string CheckPort(GeoPoint wanted, Cell shore, const RanchRequest& request,
                      const RanchArea& ranch, const Terrain& terrain) {
  const std::array<double, 2> at = ranch.frame.ToGrid(wanted);
  const bool inside =
      at[0] >= -0.5 && at[1] >= -0.5 && at[0] <= ranch.width - 0.5 && at[1] <= ranch.height - 0.5;
  const auto nearest = [](double position, std::int32_t size) {
    return std::clamp(static_cast<std::int32_t>(std::lround(position)), 0, size - 1);
  };
  const bool is_land =
      inside && terrain.land(nearest(at[1], ranch.height), nearest(at[0], ranch.width)) != 0;
  if (inside && !is_land) return "";
  const std::string got = Text("port: got %.4f,%.4f, ", wanted.latitude, wanted.longitude);
  const std::string fault =
      got + (is_land ? std::string("which is land, expected water")
                     : "expected a place in the ranch at " +
                           Degrees(ExtentOf(ranch), MiddleOf(ranch).longitude));
  if (!request.exact_ports) return fault + "; it is put on the nearest shore of the ranch";
  const GeoPoint place = ranch.frame.ToGeo(shore.x, shore.y);
  throw InputError(fault +
                   Text("; the nearest shore of the ranch is at %.4f,%.4f: give that place, "
                        "or another one",
                        place.latitude, place.longitude));
}

}  // namespace aquafarm::internal
