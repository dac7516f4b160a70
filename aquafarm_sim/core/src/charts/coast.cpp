// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/charts/coast.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/field_error.h"
#include "base/files.h"
#include "base/text.h"
#include "input/json_object.h"

namespace aquafarm {
namespace {

using internal::At;
using internal::Join;
using internal::ParseContext;
using Json = nlohmann::json;

constexpr std::size_t kMaxPoints = 20U << 20U;
constexpr int kMaxNested = 16;  // nesting depth of collections

double Cross(const GeoPoint& a, const GeoPoint& b, const GeoPoint& c) {
  return (b.longitude - a.longitude) * (c.latitude - a.latitude) -
         (b.latitude - a.latitude) * (c.longitude - a.longitude);
}

// Returns whether two segments cross in the interior of both; touching does not count.
bool Cross(const GeoPoint& a, const GeoPoint& b, const GeoPoint& c, const GeoPoint& d) {
  return Cross(a, b, c) * Cross(a, b, d) < 0.0 && Cross(c, d, a) * Cross(c, d, b) < 0.0;
}

// Returns whether two segments are collinear and share more than one point.
bool Doubles(const GeoPoint& a, const GeoPoint& b, const GeoPoint& c, const GeoPoint& d) {
  if (Cross(a, b, c) != 0.0 || Cross(a, b, d) != 0.0) return false;
  const auto overlap = [&](double GeoPoint::*along) {
    const auto [a_low, a_high] = std::minmax(a.*along, b.*along);
    const auto [c_low, c_high] = std::minmax(c.*along, d.*along);
    return std::min(a_high, c_high) - std::max(a_low, c_low);
  };
  return std::max(overlap(&GeoPoint::longitude), overlap(&GeoPoint::latitude)) > 0.0 &&
         std::min(overlap(&GeoPoint::longitude), overlap(&GeoPoint::latitude)) >= 0.0;
}

constexpr std::size_t kMaxComparisons = 50'000'000;  // protects against files designed to be slow

// Returns a description of the error in a ring, or "". Compares only segments whose longitude
// ranges overlap. `left` is the number of comparisons that remain for the file; each comparison
// subtracts 1. At 0, rings are no longer checked.
std::string FaultOf(const CoastRing& ring, std::size_t& left) {
  if (left == 0) return "";
  const std::size_t lines = ring.size() - 1;
  const auto west = [&ring](std::size_t i) {
    return std::min(ring[i].longitude, ring[i + 1].longitude);
  };
  const auto east = [&ring](std::size_t i) {
    return std::max(ring[i].longitude, ring[i + 1].longitude);
  };
  std::vector<std::size_t> order(lines);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&west](std::size_t a, std::size_t b) { return west(a) < west(b); });
  bool doubles = false;
  for (std::size_t i = 0; i < lines; ++i) {
    const std::size_t a = order[i];
    for (std::size_t k = i + 1; k < lines && west(order[k]) <= east(a); ++k) {
      const std::size_t b = order[k];
      if (Cross(ring[a], ring[a + 1], ring[b], ring[b + 1])) return "crosses itself";
      doubles = doubles || Doubles(ring[a], ring[a + 1], ring[b], ring[b + 1]);
      if (--left > 0) continue;
      return "of " + std::to_string(lines) + " lines " + (doubles ? "overlaps itself and " : "") +
             "was not fully checked for crossings, nor are the rings after it: the limit of " +
             std::to_string(kMaxComparisons) + " comparisons per file is reached";
    }
  }
  return doubles ? "overlaps itself" : "";
}

class CoastReader {
 public:
  CoastReader(Coast& coast, ParseContext& place) : coast_(coast), place_(place) {}

  void ReadObject(const Json& value, const std::string& path, int depth) {
    if (depth > kMaxNested)
      place_.FailValue(path, "got collections nested more deeply than " +
                                 std::to_string(kMaxNested) + " levels");
    const internal::JsonObject object(value, path, place_);
    const std::string type = object.Text({"type"});
    if (type == "FeatureCollection") return ReadList(object, "features", depth);
    if (type == "GeometryCollection") return ReadList(object, "geometries", depth);
    if (type == "Feature") {
      const Json* geometry = object.Find({"geometry"});
      if (geometry != nullptr) ReadObject(*geometry, Join(path, "geometry"), depth + 1);
      return;
    }
    const std::string here = Join(path, "coordinates");
    if (type == "Polygon") {
      ReadPolygon(Need(object, "coordinates", here), here);
    } else if (type == "MultiPolygon") {
      const Json& polygons = Need(object, "coordinates", here);
      for (std::size_t i = 0; i < polygons.size(); ++i) ReadPolygon(polygons[i], At(here, i));
    } else if (type.empty() || (type.find("Point") == std::string::npos &&
                                type.find("LineString") == std::string::npos)) {
      place_.FailValue(Join(path, "type"),
                       "got " + internal::Quoted(type) + ", expected a type of GeoJSON");
    }
  }

 private:
  const Json& Need(const internal::JsonObject& object, const char* key, const std::string& path) {
    const Json* list = object.List({key});
    if (list == nullptr) place_.FailValue(path, "got nothing, expected a list");
    return *list;
  }

  void ReadList(const internal::JsonObject& object, const char* key, int depth) {
    const std::string here = Join(object.path(), key);
    const Json& list = Need(object, key, here);
    for (std::size_t i = 0; i < list.size(); ++i) ReadObject(list[i], At(here, i), depth + 1);
  }

  void ReadPolygon(const Json& value, const std::string& path) {
    if (!value.is_array() || value.empty()) {
      place_.FailValue(path, "got no list of rings, expected a polygon");
    }
    CoastPolygon polygon;
    for (std::size_t i = 0; i < value.size(); ++i)
      polygon.push_back(ReadRing(value[i], At(path, i)));
    coast_.polygons.push_back(std::move(polygon));
  }

  CoastRing ReadRing(const Json& value, const std::string& path) {
    if (!value.is_array() || value.size() < 4) {
      place_.FailValue(path, "got " +
                                 (value.is_array() ? std::to_string(value.size()) + " points"
                                                   : std::string("no list of points")) +
                                 ", expected a ring of at least 4, the last equal to the first");
    }
    CoastRing ring;
    for (std::size_t i = 0; i < value.size(); ++i) {
      const Json& point = value[i];
      const bool numbers =
          point.is_array() && point.size() >= 2 && point[0].is_number() && point[1].is_number();
      const double longitude = numbers ? point[0].get<double>() : 1000.0;
      const double latitude = numbers ? point[1].get<double>() : 1000.0;
      if (!(longitude >= -180.0 && longitude <= 360.0) || !(std::abs(latitude) <= 90.0)) {
        place_.FailValue(At(path, i), "got " + internal::Quoted(point.dump()) +
                                          ", expected [longitude, latitude] in degrees");
      }
      if (++points_ > kMaxPoints) {
        place_.FailValue(path, "got more than " + std::to_string(kMaxPoints) +
                                   " points in one chart; cut it to the area that you need");
      }
      ring.push_back({latitude, longitude});
    }
    if (ring.front().latitude != ring.back().latitude ||
        ring.front().longitude != ring.back().longitude) {
      place_.FailValue(path, "got an open ring, expected its last point to equal its first");
    }
    const std::string fault = FaultOf(ring, comparisons_left_);
    if (!fault.empty()) {
      place_.WarnValue(path, "the ring " + fault +
                                 "; an area that the ring encloses an odd number of times is land");
    }
    return ring;
  }

  Coast& coast_;
  ParseContext& place_;
  std::size_t points_{};
  std::size_t comparisons_left_{kMaxComparisons};
};

// A geographic bounding box; longitudes are relative to `middle`.
struct GeoBox {
  double middle{};
  std::array<double, 2> longitude{};
  std::array<double, 2> latitude{};
};

// Returns the bounding box of the ranch with a margin on each side. The margin is the size of the
// box along this axis, but at least one degree.
GeoBox BoxOf(const GeoFrame& frame, std::int32_t width, std::int32_t height) {
  GeoBox box;
  box.middle = frame.ToGeo(width / 2.0, height / 2.0).longitude;
  box.longitude = {0.0, 0.0};
  box.latitude = {90.0, -90.0};
  constexpr int kParts = 8;
  for (int i = 0; i <= kParts; ++i) {
    for (int k = 0; k <= kParts; ++k) {
      const GeoPoint at = frame.ToGeo(-0.5 + width * (static_cast<double>(i) / kParts),
                                      -0.5 + height * (static_cast<double>(k) / kParts));
      const double east = std::remainder(at.longitude - box.middle, 360.0);
      box.longitude = {std::min(box.longitude[0], east), std::max(box.longitude[1], east)};
      box.latitude = {std::min(box.latitude[0], at.latitude),
                      std::max(box.latitude[1], at.latitude)};
    }
  }
  for (auto* span : {&box.longitude, &box.latitude}) {
    const double margin = std::max(1.0, (*span)[1] - (*span)[0]);
    *span = {(*span)[0] - margin, (*span)[1] + margin};
  }
  return box;
}

// Returns the part of a closed ring where sign * (coordinate - limit) >= 0 (Sutherland and Hodgman
// 1974).
CoastRing Clip(const CoastRing& ring, double GeoPoint::*coordinate, double limit, double sign) {
  CoastRing kept;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    const GeoPoint& a = ring[i];
    const GeoPoint& b = ring[i + 1];
    const double from = sign * (a.*coordinate - limit);
    const double to = sign * (b.*coordinate - limit);
    if (from >= 0.0) kept.push_back(a);
    if ((from >= 0.0) == (to >= 0.0)) continue;
    const double part = from / (from - to);
    GeoPoint border{a.latitude + (b.latitude - a.latitude) * part,
                    a.longitude + (b.longitude - a.longitude) * part};
    border.*coordinate = limit;
    kept.push_back(border);
  }
  if (!kept.empty()) kept.push_back(kept.front());
  return kept;
}

// Returns the part of a ring inside a box, after adding `shift` to its longitudes. The longitudes
// of the result lie in [-180, 180] and are no longer relative to box.middle.
CoastRing Clip(CoastRing ring, double shift, const GeoBox& box) {
  for (GeoPoint& point : ring) point.longitude += shift;
  ring = Clip(ring, &GeoPoint::longitude, box.longitude[0], 1.0);
  ring = Clip(ring, &GeoPoint::longitude, box.longitude[1], -1.0);
  ring = Clip(ring, &GeoPoint::latitude, box.latitude[0], 1.0);
  ring = Clip(ring, &GeoPoint::latitude, box.latitude[1], -1.0);
  for (GeoPoint& point : ring) {
    point.longitude = std::remainder(point.longitude + box.middle, 360.0);
  }
  return ring;
}

constexpr int kSamples = 5;  // per side of a cell

// Appends the x coordinates at which a ring crosses the line of constant `y`.
void Crossings(const std::vector<std::array<double, 2>>& points, double y,
               std::vector<double>& crossings) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto& a = points[i];
    const auto& b = points[i + 1];
    if ((a[1] > y) == (b[1] > y)) continue;
    crossings.push_back(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
  }
}

// Counts the sample points of one line that lie between the two crossings of each pair. Adds the
// counts to row y of `samples`.
void AddSpans(const std::vector<double>& crossings, std::int32_t y, Grid<std::uint16_t>& samples) {
  const auto last = static_cast<double>(samples.cols() * kSamples - 1);
  // Sample k of a row lies at (k + 1/2) / kSamples - 1/2.
  const auto first_from = [](double x) { return std::ceil((x + 0.5) * kSamples - 0.5); };
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    const double from = std::max(first_from(crossings[i]), 0.0);
    const double to = std::min(first_from(crossings[i + 1]) - 1.0, last);
    if (!(from <= to)) continue;
    // Here `from` and `to` are whole numbers with 0 <= from <= to <= last.
    for (auto k = static_cast<Eigen::Index>(from); k <= static_cast<Eigen::Index>(to); ++k) {
      ++samples(y, k / kSamples);
    }
  }
}

}  // namespace

Coast ParseCoast(const std::string& text, const std::string& origin_name) {
  Coast coast;
  const std::string clean = internal::CleanJson(text);
  ParseContext place(origin_name, coast.warnings);
  place.locate_bytes = clean.size();
  place.locate = [&clean](const std::string& path) { return internal::LineOfJson(clean, path); };
  const Json document = internal::ParseJson(clean, place);
  place.line = 0;
  CoastReader(coast, place).ReadObject(document, "", 0);
  if (coast.polygons.empty()) {
    place.line = 1;
    place.Fail("got no polygon, expected a coast");
  }
  return coast;
}

Coast LoadCoast(const std::string& path) { return ParseCoast(internal::ReadTextFile(path), path); }

LandShare ShareOfLand(const Coast& coast, const GeoFrame& frame, std::int32_t width,
                      std::int32_t height) {
  Grid<std::uint16_t> samples = Grid<std::uint16_t>::Zero(height, width);
  std::vector<std::vector<std::array<double, 2>>> rings;
  std::vector<double> crossings;
  const GeoBox box = BoxOf(frame, width, height);
  for (const CoastPolygon& polygon : coast.polygons) {
    rings.clear();
    double low = 1.0e9;
    double high = -1.0e9;
    for (const CoastRing& whole : polygon) {
      for (const double turn : {-360.0, 0.0, 360.0}) {
        rings.emplace_back();
        for (const GeoPoint& point : Clip(whole, turn - box.middle, box)) {
          rings.back().push_back(frame.ToGrid(point));
          low = std::min(low, rings.back().back()[1]);
          high = std::max(high, rings.back().back()[1]);
        }
      }
    }
    if (low > high) continue;  // the polygon lies outside the box
    const auto first = static_cast<std::int32_t>(std::max(std::floor(low), 0.0));
    const auto last =
        static_cast<std::int32_t>(std::min(std::ceil(high), static_cast<double>(height - 1)));
    for (std::int32_t y = first; y <= last; ++y) {
      for (int k = 0; k < kSamples; ++k) {
        crossings.clear();
        for (const auto& ring : rings) {
          Crossings(ring, y + (k + 0.5) / kSamples - 0.5, crossings);
        }
        std::sort(crossings.begin(), crossings.end());
        AddSpans(crossings, y, samples);
      }
    }
  }
  constexpr float kAll = kSamples * kSamples;
  return (samples.cast<float>() / kAll).min(1.0F);  // polygons may overlap
}

}  // namespace aquafarm
