// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/sea/sea_field.h"

#include <netcdf.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "aquafarm/base/check.h"
#include "base/text.h"
#include "base/time.h"
#include "sea/nc_file.h"

namespace aquafarm {
namespace {

using internal::NcFile;

constexpr std::size_t kMaxAlong = 1'000'000;    // max coordinates per axis
constexpr std::size_t kMaxValues = 64'000'000;  // max values that are read

enum class Axis { kTime, kDepth, kLatitude, kLongitude, kOther };

struct Dimension {
  Axis axis{};
  std::string name;
  int coordinate{-1};  // id of its 1-D coordinate variable
  std::vector<double> at;
};

int FindVariable(const NcFile& file, const std::string& wanted) {
  std::vector<std::string> names;
  for (const int variable : file.Variables()) {
    names.push_back(file.Name(variable));
    if (names.back() == wanted || file.Text(variable, "standard_name") == wanted) return variable;
  }
  file.Fail(wanted + ": no such variable; available: " + internal::List(names));
}

bool IsOneOf(const std::string& text, std::initializer_list<const char*> names) {
  return std::find(names.begin(), names.end(), text) != names.end();
}

// Returns the attribute `positive` in capitals, usually "UP" or "DOWN"; "" if absent.
std::string Positive(const NcFile& file, int coordinate) {
  return internal::Upper(file.Text(coordinate, "positive"));
}

bool IsUpwards(const NcFile& file, int coordinate) {
  const std::string positive = Positive(file, coordinate);
  return positive == "UP" || (positive.empty() && IsOneOf(file.Text(coordinate, "standard_name"),
                                                          {"height", "altitude"}));
}

// Returns the metres per unit of a vertical axis, or 0 for an unsupported unit. A decibar of sea
// water is approximately one metre.
double MetresPer(const std::string& units) {
  const std::string unit = internal::Upper(internal::Trim(units));
  if (unit == "KM") return 1000.0;
  if (unit == "CM") return 0.01;
  const bool metres =
      IsOneOf(unit, {"", "M", "METER", "METERS", "METRE", "METRES", "DBAR", "DECIBAR", "DECIBARS"});
  return metres ? 1.0 : 0.0;
}

// Determines an axis from its CF attributes, else from its name.
Axis AxisOf(const NcFile& file, int coordinate, const std::string& name) {
  const std::string standard = file.Text(coordinate, "standard_name");
  const std::string units = file.Text(coordinate, "units");
  const std::string axis = file.Text(coordinate, "axis");
  if (standard == "latitude" || axis == "Y" ||
      IsOneOf(units,
              {"degrees_north", "degree_north", "degrees_N", "degree_N", "degreesN", "degreeN"}) ||
      IsOneOf(name, {"lat", "latitude"})) {
    return Axis::kLatitude;
  }
  if (standard == "longitude" || axis == "X" ||
      IsOneOf(units,
              {"degrees_east", "degree_east", "degrees_E", "degree_E", "degreesE", "degreeE"}) ||
      IsOneOf(name, {"lon", "longitude"})) {
    return Axis::kLongitude;
  }
  if (standard == "time" || axis == "T" || units.find(" since ") != std::string::npos) {
    return Axis::kTime;
  }
  const bool pressure = IsOneOf(units, {"dbar", "decibar", "decibars", "bar", "mbar", "millibar",
                                        "millibars", "hPa", "Pa", "atm"});
  if (pressure || axis == "Z" || IsOneOf(Positive(file, coordinate), {"UP", "DOWN"}) ||
      IsOneOf(standard, {"depth", "height", "altitude", "sea_water_pressure"}) ||
      IsOneOf(name, {"depth", "lev", "zlev", "level"})) {
    return Axis::kDepth;
  }
  return Axis::kOther;
}

Dimension ReadDimension(const NcFile& file, int dimension, const std::string& variable) {
  std::array<char, NC_MAX_NAME + 1> name{};
  std::size_t length = 0;
  file.Need(nc_inq_dim(file.id(), dimension, name.data(), &length), variable);
  Dimension found;
  found.name = name.data();
  int rank = 0;
  const bool has_coordinate = nc_inq_varid(file.id(), name.data(), &found.coordinate) == NC_NOERR &&
                              nc_inq_varndims(file.id(), found.coordinate, &rank) == NC_NOERR &&
                              rank == 1;
  if (length == 0 || length > kMaxAlong) {
    file.Fail(found.name + ": got " + std::to_string(length) + " values, expected [1, " +
              std::to_string(kMaxAlong) + "]");
  }
  found.at.resize(length);
  if (!has_coordinate) {
    found.axis = Axis::kOther;
    return found;
  }
  int dimension_of_coordinate = -1;
  file.Need(nc_inq_vardimid(file.id(), found.coordinate, &dimension_of_coordinate), found.name);
  if (dimension_of_coordinate != dimension)
    file.Fail(found.name + ": got a coordinate of another dimension, expected one of its own");
  file.Need(nc_get_var_double(file.id(), found.coordinate, found.at.data()), found.name);
  const double scale = file.Number(found.coordinate, "scale_factor").value_or(1.0);
  const double offset = file.Number(found.coordinate, "add_offset").value_or(0.0);
  for (double& value : found.at) {
    value = value * scale + offset;
    if (!std::isfinite(value)) file.Fail(found.name + ": got no number, expected a coordinate");
  }
  found.axis = AxisOf(file, found.coordinate, found.name);
  return found;
}

std::vector<Dimension> ReadDimensions(const NcFile& file, int variable, const std::string& name) {
  int rank = 0;
  file.Need(nc_inq_varndims(file.id(), variable, &rank), name);
  std::vector<int> ids(static_cast<std::size_t>(rank));
  file.Need(nc_inq_vardimid(file.id(), variable, ids.data()), name);
  std::vector<Dimension> dimensions;
  dimensions.reserve(ids.size());
  for (const int id : ids) dimensions.push_back(ReadDimension(file, id, name));
  const auto count = [&dimensions](Axis axis) {
    return std::count_if(dimensions.begin(), dimensions.end(),
                         [axis](const Dimension& d) { return d.axis == axis; });
  };
  if (count(Axis::kLatitude) != 1 || count(Axis::kLongitude) != 1) {
    file.Fail(name +
              ": got no latitude and longitude of one dimension each (a curvilinear grid?"
              "), expected them along the variable's dimensions");
  }
  for (const Dimension& d : dimensions) {
    const bool along = d.axis == Axis::kLatitude || d.axis == Axis::kLongitude;
    if (d.axis == Axis::kOther && d.at.size() > 1) {
      file.Fail(name + ": got dimension " + d.name +
                ", expected time, depth, latitude or longitude");
    }
    if (along && !std::is_sorted(d.at.begin(), d.at.end()) &&
        !std::is_sorted(d.at.rbegin(), d.at.rend())) {
      file.Fail(d.name + ": got coordinates that rise and fall, expected one order");
    }
    const auto again = std::adjacent_find(d.at.begin(), d.at.end());
    if (along && again != d.at.end()) {
      file.Fail(d.name + ": got " + internal::Format(*again) + " twice, expected it once");
    }
    if (!along) continue;
    const bool is_latitude = d.axis == Axis::kLatitude;
    // The bounds are wide: packed coordinates have rounding errors, and grids may continue beyond
    // the date line.
    const double max = is_latitude ? 90.0 + 1.0e-3 : 720.0;
    for (const double degrees : d.at) {
      if (std::abs(degrees) <= max) continue;
      file.Fail(d.name + ": got a " + (is_latitude ? "latitude" : "longitude") + " of " +
                internal::Format(degrees) + ", expected " +
                (is_latitude ? "[-90, 90]" : "[-180, 360]"));
    }
  }
  return dimensions;
}

std::size_t Nearest(const std::vector<double>& at, double wanted) {
  const auto nearest = std::min_element(at.begin(), at.end(), [wanted](double a, double b) {
    return std::abs(a - wanted) < std::abs(b - wanted);
  });
  return static_cast<std::size_t>(nearest - at.begin());
}

// Converts a date and time that UDUNITS accepts to a form that ParseDateTime accepts. The time may
// be absent, or have a form such as "0:0:0", "00:00:00.0", "00:00:00 UTC" or "00:00:00 +00:00".
std::string PlainTime(std::string time) {
  for (const char* utc : {"UTC", "utc", "Z", "+00:00", "+0:00"}) {
    const std::string_view ending(utc);
    if (time.size() <= ending.size() ||
        time.compare(time.size() - ending.size(), time.npos, utc) != 0)
      continue;
    time = internal::Trim(time.substr(0, time.size() - ending.size()));
    break;
  }
  const std::size_t point = time.find('.');
  if (point != std::string::npos && time.find_first_not_of('0', point + 1) == std::string::npos) {
    time.resize(point);
  }
  for (std::size_t at = time.find(':'); at != time.npos; at = time.find(':', at + 1)) {
    if (at + 2 == time.size() || (at + 2 < time.size() && time[at + 2] == ':')) {
      time.insert(at + 1, "0");
    }
  }
  if (time.size() <= 10) return time + " 00:00";
  return time.find(':') == std::string::npos ? time + ":00" : time;
}

// Parses "hours since 2000-01-01 00:00:00" to the seconds per unit and the UTC seconds of value 0.
std::pair<double, double> TimeUnits(const NcFile& file, const Dimension& time) {
  const std::string units = file.Text(time.coordinate, "units");
  const std::size_t since = units.find(" since ");
  const std::string unit = internal::Upper(units.substr(0, since));
  const std::string calendar = file.Text(time.coordinate, "calendar");
  if (!IsOneOf(calendar, {"", "standard", "gregorian", "proleptic_gregorian"})) {
    file.Fail(time.name + ": calendar: got " + internal::Quoted(calendar) +
              ", expected standard, gregorian or proleptic_gregorian");
  }
  const std::string day = since == std::string::npos ? "" : PlainTime(units.substr(since + 7));
  const std::optional<std::int64_t> zero = internal::ParseDateTime(day, 0);
  const double seconds = IsOneOf(unit, {"SECOND", "SECONDS", "S"})     ? 1.0
                         : IsOneOf(unit, {"MINUTE", "MINUTES"})        ? 60.0
                         : IsOneOf(unit, {"HOUR", "HOURS", "H", "HR"}) ? 3600.0
                         : IsOneOf(unit, {"DAY", "DAYS", "D"})         ? 86400.0
                                                                       : 0.0;
  if (!zero || seconds == 0.0) {
    file.Fail(time.name + ": units: got " + internal::Quoted(units) +
              ", expected for example 'hours since 2000-01-01 00:00:00'");
  }
  return {seconds, static_cast<double>(*zero)};
}

// Range of indices that is read along one dimension.
struct Span {
  std::size_t first{};
  std::size_t count{1};
};

// Returns the indices of the values in [low, high] and of one more value on each side.
Span Window(const std::vector<double>& at, double low, double high) {
  std::size_t first = at.size();
  std::size_t last = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (at[i] < low || at[i] > high) continue;
    first = std::min(first, i);
    last = std::max(last, i);
  }
  if (first > last) {  // the ranch lies between two values or outside: uses the nearest ones
    first = last = Nearest(at, (low + high) / 2.0);
  }
  first = first == 0 ? 0 : first - 1;
  last = std::min(last + 1, at.size() - 1);
  return {first, last - first + 1};
}

// Bounding box of the ranch [degrees].
struct Extent {
  double south{90.0}, north{-90.0}, west{1.0e9}, east{-1.0e9};
};

Extent ExtentOf(const GeoFrame& frame, std::int32_t width, std::int32_t height) {
  Extent extent;
  for (const double x : {-0.5, width / 2.0, width - 0.5}) {
    for (const double y : {-0.5, height / 2.0, height - 0.5}) {
      const GeoPoint point = frame.ToGeo(x, y);
      extent.south = std::min(extent.south, point.latitude);
      extent.north = std::max(extent.north, point.latitude);
      extent.west = std::min(extent.west, point.longitude);
      extent.east = std::max(extent.east, point.longitude);
    }
  }
  return extent;
}

// Returns the offset (0, 360 or -360 degrees) to add to the file's longitudes so that their range
// contains the ranch's longitude `near`. Returns 0 if there is no such offset.
double TurnOf(const std::vector<double>& longitude, double near) {
  const auto [west, east] = std::minmax_element(longitude.begin(), longitude.end());
  for (const double turn : {0.0, 360.0, -360.0}) {
    if (near >= *west + turn - 1.0e-9 && near <= *east + turn + 1.0e-9) return turn;
  }
  return 0.0;
}

void Unpack(const NcFile& file, int variable, std::vector<float>& values) {
  const double scale = file.Number(variable, "scale_factor").value_or(1.0);
  const double offset = file.Number(variable, "add_offset").value_or(0.0);
  // The attributes below are compared with the packed values. A fill value outside the range of the
  // type matches no value.
  const std::optional<double> own = file.Number(variable, "_FillValue");
  const std::optional<double> fill = own ? own : file.DefaultFill(variable);
  const std::optional<double> missing = file.Number(variable, "missing_value");
  const auto range = file.Pair(variable, "valid_range");
  const double low = range ? (*range)[0] : file.Number(variable, "valid_min").value_or(-1.0e30);
  const double high = range ? (*range)[1] : file.Number(variable, "valid_max").value_or(1.0e30);
  const auto same = [](const std::optional<double>& mark, float value) {
    return mark && static_cast<float>(*mark) == value;
  };
  for (float& value : values) {
    const bool absent = same(fill, value) || same(missing, value) || !(value >= low) ||
                        !(value <= high) ||
                        std::abs(value) > 9.9e35F;  // larger numbers mark missing values
    value = absent ? kNoSeaValue : static_cast<float>(value * scale + offset);
  }
}

// The part of a variable that is read.
struct Block {
  std::vector<std::size_t> first;  // by dimension
  std::vector<std::size_t> count;
  std::size_t along_latitude{};   // index of the latitude's dimension
  std::size_t along_longitude{};  // index of the longitude's dimension
};

Span ChooseTime(const NcFile& file, std::optional<std::int64_t> time, Dimension& d,
                SeaField& field) {
  const auto [unit_s, zero] = TimeUnits(file, d);
  for (double& at : d.at) at = at * unit_s + zero;
  Span span;
  span.first = time ? Nearest(d.at, static_cast<double>(*time)) : 0;
  field.time = static_cast<std::int64_t>(std::llround(d.at[span.first]));
  return span;
}

Span ChooseDepth(const NcFile& file, double depth_m, Dimension& d, SeaField& field) {
  const std::string units = file.Text(d.coordinate, "units");
  const double metres = MetresPer(units);
  if (metres == 0.0 && d.at.size() > 1) {
    file.Fail(d.name + ": units: got " + internal::Quoted(units) +
              ", expected metres, km, cm or dbar, to find a depth among " +
              std::to_string(d.at.size()));
  }
  const double down = IsUpwards(file, d.coordinate) ? -metres : metres;
  for (double& at : d.at) at *= down;
  Span span;
  span.first = Nearest(d.at, depth_m);
  if (metres > 0.0) field.depth_m = d.at[span.first];
  return span;
}

// Chooses the time, the depth, and the window around the ranch. Converts the coordinates of the
// dimensions, and sets time, depth and extent of the field.
Block ChooseBlock(const NcFile& file, const SeaFieldChoice& choice, const Extent& extent,
                  std::vector<Dimension>& dimensions, SeaField& field) {
  Block block;
  for (std::size_t i = 0; i < dimensions.size(); ++i) {
    Dimension& d = dimensions[i];
    Span span;
    if (d.axis == Axis::kTime) {
      span = ChooseTime(file, choice.time, d, field);
    } else if (d.axis == Axis::kDepth) {
      span = ChooseDepth(file, choice.depth_m, d, field);
    } else if (d.axis == Axis::kLatitude) {
      block.along_latitude = i;
      span = Window(d.at, extent.south, extent.north);
      const auto [south, north] = std::minmax_element(d.at.begin(), d.at.end());
      field.extent[0] = *south;
      field.extent[1] = *north;
    } else if (d.axis == Axis::kLongitude) {
      block.along_longitude = i;
      const double turn = TurnOf(d.at, (extent.west + extent.east) / 2.0);
      for (double& at : d.at) at += turn;
      span = Window(d.at, extent.west, extent.east);
      const auto [west, east] = std::minmax_element(d.at.begin(), d.at.end());
      field.extent[2] = *west;
      field.extent[3] = *east;
    }
    block.first.push_back(span.first);
    block.count.push_back(span.count);
  }
  return block;
}

// Copies `values`, which have the order of the file, to the field, whose order is from south to
// north and from west to east.
void Arrange(const std::vector<Dimension>& dimensions, const Block& block,
             const std::vector<float>& values, SeaField& field) {
  const auto cut = [&](std::size_t i) {
    const auto from = dimensions[i].at.begin() + static_cast<std::ptrdiff_t>(block.first[i]);
    return std::vector<double>(from, from + static_cast<std::ptrdiff_t>(block.count[i]));
  };
  field.latitude = cut(block.along_latitude);
  field.longitude = cut(block.along_longitude);
  const std::size_t rows = field.latitude.size();
  const std::size_t columns = field.longitude.size();
  const bool north_first = field.latitude.front() > field.latitude.back();
  const bool east_first = field.longitude.front() > field.longitude.back();
  const bool latitude_slow = block.along_latitude < block.along_longitude;
  field.value.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t r = north_first ? rows - 1 - row : row;
      const std::size_t c = east_first ? columns - 1 - column : column;
      field.value(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
          values[latitude_slow ? r * columns + c : c * rows + r];
    }
  }
  if (north_first) std::reverse(field.latitude.begin(), field.latitude.end());
  if (east_first) std::reverse(field.longitude.begin(), field.longitude.end());
}

}  // namespace

SeaField LoadSeaField(const std::string& path, const SeaFieldChoice& choice, const GeoFrame& frame,
                      std::int32_t width, std::int32_t height) {
  const NcFile file(path);
  const int variable = FindVariable(file, choice.variable);
  SeaField field;
  field.name = file.Name(variable);
  field.units = file.Text(variable, "units");
  std::vector<Dimension> dimensions = ReadDimensions(file, variable, field.name);
  const Block block = ChooseBlock(file, choice, ExtentOf(frame, width, height), dimensions, field);
  const std::size_t size = block.count[block.along_latitude] * block.count[block.along_longitude];
  if (size > kMaxValues) {
    file.Fail(field.name + ": got " + std::to_string(size) +
              " values on this ranch, expected at most " + std::to_string(kMaxValues) +
              "; use a coarser field");
  }
  std::vector<float> values(size);
  file.Need(
      nc_get_vara_float(file.id(), variable, block.first.data(), block.count.data(), values.data()),
      field.name);
  Unpack(file, variable, values);
  Arrange(dimensions, block, values, field);
  return field;
}

}  // namespace aquafarm
