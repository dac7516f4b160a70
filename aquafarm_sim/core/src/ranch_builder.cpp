// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/ranch_builder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "aquafarm/ascii_grid.h"
#include "aquafarm/check.h"
#include "aquafarm/coast.h"
#include "aquafarm/disaster_preset.h"
#include "aquafarm/hazard_file.h"
#include "aquafarm/layout.h"
#include "aquafarm/map_file.h"
#include "aquafarm/notice_file.h"
#include "aquafarm/scenario_yaml.h"
#include "aquafarm/sea_field.h"
#include "field_domain.h"
#include "hazard_text.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;
using internal::Format;
using internal::FormatTime;

template <typename... Args>
std::string Text(const char* format, Args... args) {
  char text[400];
  std::snprintf(text, sizeof(text), format, args...);
  return text;
}

std::string FileName(const std::string& path) { return fs::path(path).filename().string(); }

// What a file says of itself, on one line.
std::string OneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20U; }, '?');
  return text;
}

std::string InQuotes(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : OneLine(text))
    quoted += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  return quoted + "\"";
}

/// A number as a file should show it: of so many digits, no more.
std::string Short(double value, int digits) {
  return Format(std::stod(Text("%.*f", digits, value)));
}

// Everything that goes into the text of the file, collected part by part.
class Builder {
 public:
  explicit Builder(const RanchRequest& request) : request_(request) {
    ranch_.scenario.width = request.width;
    ranch_.scenario.height = request.height;
    cell_size_m_ = request.cell_size_m;
    CheckSize("size", request.width);
    CheckSize("size", request.height);
    internal::Check("cell", request.cell_size_m, internal::Interval<double>{0.01, 1.0e6});
    internal::Check("sea_level", request.sea_level, internal::Interval<float>{-1.0e5F, 1.0e5F});
    if (!request.center && (!request.track.empty() || !request.port_places.empty())) {
      throw InputError("center: got nothing, expected the place of the ranch for its storm");
    }
  }

  Ranch Build() {
    PlaceTerrain();
    const std::vector<Cell> ports = PlacePorts();
    SetTime();
    ReadSea();
    AddPresets();
    SayNotices();
    Write(ports);
    ranch_.scenario = ParseScenario(ranch_.yaml, request_.name);
    if (!request_.value.empty()) ValueDevices();
    return std::move(ranch_);
  }

 private:
  static void CheckSize(const char* what, std::int32_t side) {
    internal::Check(what, side, internal::Interval<std::int32_t>{2, kMaxSide});
  }
  std::int32_t width() const { return ranch_.scenario.width; }
  std::int32_t height() const { return ranch_.scenario.height; }
  void Say(const std::string& line) { ranch_.decided.push_back(OneLine(line)); }
  void Keep(const std::vector<std::string>& warnings) {
    ranch_.warnings.insert(ranch_.warnings.end(), warnings.begin(), warnings.end());
  }

  void Resize(Eigen::Index rows, Eigen::Index columns, double cell_size_m) {
    ranch_.scenario.width = static_cast<std::int32_t>(columns);
    ranch_.scenario.height = static_cast<std::int32_t>(rows);
    CheckSize("chart", width());
    CheckSize("chart", height());
    cell_size_m_ = cell_size_m;
  }

  // The origin is the centre of cell (0, 0); the place asked for is the middle of the ranch.
  GeoFrame Frame() {
    if (!request_.center) {
      throw InputError("center: got nothing, expected the place of the ranch on the chart");
    }
    const GeoPoint corner =
        GeoFrame(*request_.center, cell_size_m_).ToGeo(-(width() - 1) / 2.0, -(height() - 1) / 2.0);
    // Rounded as it is written, so that the file and this agree.
    origin_ = GeoPoint{std::stod(Short(corner.latitude, 6)), std::stod(Short(corner.longitude, 6))};
    return GeoFrame(*origin_, cell_size_m_);
  }

  LandShare ReadChart() {
    const std::string extension = fs::path(request_.chart).extension().string();
    if (request_.chart.empty()) return LandShare::Zero(height(), width());
    if (extension == ".yaml" || extension == ".yml") {
      const MapFile map = LoadMap(request_.chart);
      Resize(map.occupancy.rows(), map.occupancy.cols(), map.cell_size_m);
      return ShareOfLand(map);
    }
    if (extension == ".asc" || extension == ".tt2") {
      const AsciiGrid grid = LoadAsciiGrid(request_.chart);
      if (grid.IsGeographic()) {
        return ShareOfLand(grid, Frame(), width(), height(), request_.sea_level);
      }
      Resize(grid.value.rows(), grid.value.cols(), grid.cell_size);
      return ShareOfLand(grid, request_.sea_level);
    }
    const Coast coast = LoadCoast(request_.chart);
    Keep(coast.warnings);
    return ShareOfLand(coast, Frame(), width(), height());
  }

  void PlaceTerrain() {
    terrain_ = ToTerrain(ReadChart());
    if (request_.center) Frame();
    Say(Text("ranch: %d x %d cells of %s m", width(), height(), Format(cell_size_m_).c_str()) +
        (request_.center
             ? Text(", middle %.3f N %.3f E", request_.center->latitude, request_.center->longitude)
             : std::string()));
    if (request_.chart.empty()) return;
    Say(Text("chart: %s: %d island cells, %d rocks, %d of water", FileName(request_.chart).c_str(),
             static_cast<int>(terrain_.land.cast<int>().sum()),
             static_cast<int>(terrain_.rocks.size()), terrain_.WaterCells()) +
        (terrain_.filled > 0 ? Text("; %d cells of enclosed water filled", terrain_.filled)
                             : std::string()));
  }

  std::vector<Cell> PlacePorts() {
    std::vector<Cell> ports;
    if (request_.port_places.empty()) {
      ports = SpreadPorts(terrain_, request_.ports);
    } else {
      const GeoFrame frame = Frame();
      for (const GeoPoint& place : request_.port_places) {
        const std::array<double, 2> wanted = frame.ToGrid(place);
        const Cell cell{static_cast<std::int32_t>(std::lround(wanted[0])),
                        static_cast<std::int32_t>(std::lround(wanted[1]))};
        ports.push_back(NearestShore(terrain_, cell, ports));
        Say(Text("port: asked for at (%d, %d), put at the shore at (%d, %d)", cell.x, cell.y,
                 ports.back().x, ports.back().y));
      }
    }
    if (ports.empty()) Say(Text("ports: no shore, so %d drawn at the edge", request_.ports));
    return ports;
  }

  // The storm of a track in another file: by id, else by name.
  static const HazardTrack& SameStorm(const HazardFile& file, const HazardTrack& track) {
    const auto letters = [](const std::string& name) {
      std::string bare = internal::Upper(name);
      bare.erase(std::remove(bare.begin(), bare.end(), '-'), bare.end());
      return bare;
    };
    const HazardTrack& first = file.tracks.front();
    const bool unnamed = first.name.empty() || track.name.empty();
    if (file.tracks.size() == 1 && (unnamed || letters(first.name) == letters(track.name))) {
      return first;
    }
    for (const HazardTrack& other : file.tracks) {
      if (other.id == track.id) return other;
    }
    try {
      return FindTrack(file, track.name.empty() ? track.id : track.name);
    } catch (const InputError& error) {
      throw InputError(std::string("radii: ") + error.what());
    }
  }

  HazardTrack ReadTrack() {
    const auto only = [](const HazardFile& file, const std::string& storm) {
      return storm.empty() && file.tracks.size() == 1 ? file.tracks[0] : FindTrack(file, storm);
    };
    const HazardFile file = LoadHazardFile(request_.track);
    Keep(file.warnings);
    HazardTrack track = only(file, request_.storm);
    std::string radii;
    if (!request_.radii.empty()) {
      const HazardFile other = LoadHazardFile(request_.radii);
      Keep(other.warnings);
      radii = Text("; radii of %d from %s", BorrowRings(SameStorm(other, track), track),
                   FileName(request_.radii).c_str());
    }
    storm_ = ToRings(track, request_.reduction);
    const std::int32_t averaging = track.fixes.front().averaging_min;
    storm_text_ = (track.name.empty() ? track.id : track.name + " (" + track.id + ")") + ", " +
                  std::string(ToString(file.format)) + " " + FileName(request_.track);
    Say("storm: " + storm_text_ +
        Text(", %d fixes, winds of %d minutes", static_cast<int>(track.fixes.size()), averaging) +
        radii + Text("; radii estimated at %d, unknown at %d", storm_.estimated, storm_.silent));
    return track;
  }

  // When the episode starts and ends, from when the storm is over the ranch.
  void SetTime() {
    step_s_ = request_.step_s.value_or(
        std::max(1.0, std::round(cell_size_m_ / (request_.speed_kn * kMpsPerKnot))));
    internal::Check("step", step_s_, internal::Interval<double>{0.001, 1.0e6});
    start_ = request_.start.value_or(0);
    if (request_.track.empty()) return Say(Text("time: %g s a step; no storm", step_s_));
    ReadTrack();
    const double half_diagonal_km = std::hypot(width(), height()) / 2.0 * cell_size_m_ / 1000.0;
    const Passage passage = PassOver(storm_, *request_.center, half_diagonal_km);
    const std::int32_t widest_kt = storm_.wind_kt.back();
    const bool reaches = passage.worst_wind_kt > 0;
    Say(Text("nearest: %.0f km at %s", passage.nearest_km,
             FormatTime(passage.nearest_time).c_str()));
    Say(reaches ? Text("%d kt over the ranch for %.1f h, from %s to %s; strongest ring %d kt",
                       widest_kt, passage.widest_h, FormatTime(passage.first).c_str(),
                       FormatTime(passage.last).c_str(), passage.worst_wind_kt)
                : Text("%d kt never come over the ranch", widest_kt));
    constexpr std::int64_t kHour_s = 3600;
    const std::int64_t half_day_s = 12 * kHour_s;
    const auto lead_s = static_cast<std::int64_t>(request_.lead_h * kHour_s);
    const std::int64_t first = reaches ? passage.first - lead_s : passage.nearest_time - half_day_s;
    const std::int64_t last = reaches ? passage.last : passage.nearest_time + half_day_s;
    const auto hour_before = [](std::int64_t time) { return time - ((time % 3600) + 3600) % 3600; };
    start_ = request_.start.value_or(std::max(hour_before(first), storm_.waypoints.front().time));
    const std::int64_t end =
        std::min(hour_before(last) + 2 * kHour_s, storm_.waypoints.back().time);
    if (end <= start_) {
      throw InputError("start: got " + FormatTime(start_) + ", expected a time before " +
                       FormatTime(end) + ", when the storm is over");
    }
    duration_ = StepsToCover(static_cast<double>(end - start_), step_s_);
    storm_steps_ = duration_;
    Say(Text("time: %g s a step, from %s, over after %d steps", step_s_, FormatTime(start_).c_str(),
             duration_));
    Trim(end);
  }

  // Keeps the waypoints from the last before the start to the first after the end.
  void Trim(std::int64_t end) {
    std::vector<StormWaypoint>& all = storm_.waypoints;
    std::size_t from = 0;
    while (from + 1 < all.size() && all[from + 1].time <= start_) ++from;
    std::size_t to = all.size();
    while (to > from + 1 && all[to - 2].time >= end) --to;
    all = {all.begin() + static_cast<std::ptrdiff_t>(from),
           all.begin() + static_cast<std::ptrdiff_t>(to)};
  }

  // Once all disasters are known.
  std::int32_t StepLimit() const { return duration_ > 0 ? duration_ + 100 : 5000; }

  // Those that are in force during the episode, or all where it has no time.
  void SayNotices() {
    if (request_.notices.empty()) return;
    const NoticeFile file = LoadNotices(request_.notices);
    Keep(file.warnings);
    const bool timed = request_.start || !storm_.waypoints.empty();
    const std::int64_t end = start_ + static_cast<std::int64_t>(StepLimit() * step_s_);
    int others = 0;
    for (const Notice& notice : file.notices) {
      const bool in_force = !timed || (notice.start < end && notice.end > start_);
      others += in_force ? 0 : 1;
      if (in_force) Say("notice: " + Describe(notice));
    }
    if (others > 0) Say(Text("notices: %d more at other times", others));
  }

  NamedLayer ReadLayer(const SeaLayerRequest& sea) {
    const GeoFrame frame = Frame();
    const std::optional<std::int64_t> time =
        request_.track.empty() ? request_.start : std::optional<std::int64_t>(start_);
    SeaField field = LoadSeaField(sea.file, {sea.variable, time, request_.sea_depth_m}, frame,
                                  width(), height());
    NamedLayer layer{sea.name, ToLayer(field, frame, width(), height())};
    // Rounded as they are written, so that the rules of the file and of this command agree.
    layer.layer = layer.layer.unaryExpr([](float value) {
      return std::isnan(value)
                 ? value
                 : std::strtof(Text("%.6g", static_cast<double>(value)).c_str(), nullptr);
    });
    const Layer known = layer.layer.isNaN().select(Layer::Zero(height(), width()), layer.layer);
    const auto cells = static_cast<float>((!layer.layer.isNaN()).count());
    if (cells == 0.0F) {
      throw InputError(sea.file + ": " + field.name + ": has no value on this ranch");
    }
    Say(sea.name + ": " + field.name + " of " + FileName(sea.file) +
        (field.time ? " at " + FormatTime(*field.time) : "") +
        Text(", mean %.4g %s, on %.0f of %d cells", static_cast<double>(known.sum() / cells),
             field.units.c_str(), static_cast<double>(cells), width() * height()));
    sea_units_.push_back(std::move(field.units));
    return layer;
  }

  void AddPresets() {
    const bool south = request_.center && request_.center->latitude < 0.0;
    for (const std::string& text : request_.disasters) {
      const DisasterSpec disaster = ParseDisasterPreset(text, {cell_size_m_, step_s_, south});
      presets_.push_back(disaster);
      Say(Text("disaster: %s: grade %d, radius %.1f cells, %.3g cells a step, %d steps",
               text.c_str(), disaster.grade, static_cast<double>(disaster.radii.back()),
               static_cast<double>(disaster.speed), disaster.duration));
      duration_ = std::max(duration_, disaster.duration);
    }
  }

  void ReadSea() {
    for (const SeaLayerRequest& sea : request_.sea) layers_.push_back(ReadLayer(sea));
    if (!request_.sea_risk.empty()) Say("risk of the sea: " + request_.sea_risk);
    if (request_.value.empty()) return;
    try {
      value_ = Evaluate(request_.value, layers_);
    } catch (const InputError& error) {
      throw InputError(std::string("value: ") + error.what());
    }
    Say("values: " + request_.value);
  }

  // The devices stay where they were drawn, each with the value of its cell.
  void ValueDevices() {
    Layout layout;
    LayoutGenerator(ranch_.scenario).Generate(request_.seed, 0, layout);
    std::string sites = "  devices:\n    placement: explicit\n    sites:\n";
    for (const PlacedDevice& device : layout.devices) {
      const float worth = value_(device.cell.y, device.cell.x);
      if (!(worth >= 0.0F && worth <= 10000.0F)) {
        throw InputError("value: got " + Format(worth) + " at the device at " +
                         CellText(device.cell) + ", expected a number in [0, 10000]");
      }
      sites += "      - {cell: " + CellText(device.cell) +
               ", kind: " + std::string(ToString(device.kind)) +
               ", value: " + Short(static_cast<double>(worth), 2) + "}\n";
    }
    ranch_.yaml.replace(ranch_.yaml.find(DevicesLine()), DevicesLine().size(), sites);
    ranch_.scenario = ParseScenario(ranch_.yaml, request_.name);
  }

  std::string DevicesLine() const {
    return "  devices: {placement: " + std::string(ToString(request_.placement)) +
           Text(", count: %d}\n", request_.devices);
  }

  void Line(const std::string& line) { ranch_.yaml += line + "\n"; }

  void Write(const std::vector<Cell>& ports) {
    Line("# SPDX-License-Identifier: BSD-3-Clause");
    Line("# Made by `aquafarm scenario`:");
    for (const std::string& line : ranch_.decided) Line("#   " + line);
    Line("name: " + InQuotes(request_.name));
    Line("description: " +
         InQuotes("A ranch" +
                  (request_.chart.empty() ? "" : " on the chart " + FileName(request_.chart)) +
                  (request_.track.empty() ? " in calm weather."
                                          : " while " + storm_text_ + " passes.")));
    Line("grid:");
    Line(Text("  width: %d\n  height: %d", width(), height()));
    Line("  cell_size_m: " + Format(cell_size_m_));
    if (origin_) {
      Line("  origin: {latitude: " + Format(origin_->latitude) +
           ", longitude: " + Format(origin_->longitude) + "}");
    }
    Line("time: {step_duration_s: " + Format(step_s_) +
         (storm_.waypoints.empty() && !request_.start ? std::string()
                                                      : ", start: " + FormatTime(start_)) +
         Text(", step_limit: %d}", StepLimit()));
    WriteLayout(ports);
    Line(Text("ships: {count: %d, capacity: 1}", request_.ships));
    if (!storm_.waypoints.empty() || !presets_.empty()) Line("disasters:");
    if (!storm_.waypoints.empty()) WriteStorm();
    for (const DisasterSpec& disaster : presets_) WritePreset(disaster);
    Line("view: {mode: full}");
    if (!layers_.empty()) WriteSeas();
  }

  // As numbers, so that the file needs no other.
  void WriteSeas() {
    Line("seas:\n  layers:");
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      Line("    - name: " + layers_[i].name);
      Line("      units: " + InQuotes(sea_units_[i]));
      Line("      values: [");
      const Layer& layer = layers_[i].layer;
      for (Eigen::Index y = 0; y < layer.rows(); ++y) {
        std::string row;
        for (Eigen::Index x = 0; x < layer.cols(); ++x) {
          const float value = layer(y, x);
          row += std::isnan(value) ? ".nan, " : Format(value) + ", ";
        }
        Line("        " + row);
      }
      Line("      ]");
    }
    if (!request_.sea_risk.empty()) Line("  risk: " + InQuotes(request_.sea_risk));
  }

  static std::string CellText(Cell cell) { return Text("[%d, %d]", cell.x, cell.y); }
  static std::string CellList(const std::vector<Cell>& cells) {
    std::string text;
    for (const Cell cell : cells) text += (text.empty() ? "[" : ", ") + CellText(cell);
    return text + "]";
  }

  void WriteLayout(const std::vector<Cell>& ports) {
    Line("layout:\n  mode: fixed\n  seed: " + Format(request_.seed));
    const std::vector<IslandBlock> islands = ToIslands(terrain_.land);
    if (!islands.empty()) Line("  islands:");
    for (const IslandBlock& block : islands) {
      Line(Text("    - {x: %d, y: %d, width: %d, height: %d}", block.south_west.x,
                block.south_west.y, block.width, block.height));
    }
    Line(terrain_.rocks.empty() ? "  rocks: {count: [0, 0]}"
                                : "  rocks: {cells: " + CellList(terrain_.rocks) + "}");
    Line(ports.empty() ? Text("  ports: {count: %d}", request_.ports)
                       : "  ports: {cells: " + CellList(ports) + "}");
    ranch_.yaml += DevicesLine();
  }

  static std::string Numbers(const std::vector<float>& values) {
    std::string text;
    for (const float value : values) text += (text.empty() ? "[" : ", ") + Format(value);
    return text + "]";
  }

  void WritePreset(const DisasterSpec& disaster) {
    Line("  - kind: " + std::string(ToString(disaster.kind)));
    Line(Text("    grade: %d\n    radii: ", disaster.grade) + Numbers(disaster.radii) +
         "\n    risks: " + Numbers(disaster.risks));
    Line("    speed: " + Format(disaster.speed) +
         Text("\n    heading_deg: %d", disaster.heading_deg.value_or(0)) +
         "\n    turn_probability: 0\n    radius_growth: " + Format(disaster.radius_growth));
    Line("    border: " + std::string(ToString(disaster.border)) +
         Text("\n    duration: %d", disaster.duration));
  }

  void WriteStorm() {
    const GradeRisks& table = DefaultGradeRisks();
    Line("  - kind: typhoon");
    std::string rows;
    for (const std::vector<float>& row : table) {
      rows += rows.empty() ? "[" : ", ";
      const std::size_t rings = storm_.wind_kt.size();
      for (std::size_t k = row.size() - rings; k < row.size(); ++k) {
        rows += (k == row.size() - rings ? "[" : ", ") + Format(row[k]);
      }
      rows += "]";
    }
    std::string winds;
    for (const std::int32_t wind_kt : storm_.wind_kt) {
      winds += (winds.empty() ? "" : ", ") + std::to_string(wind_kt);
    }
    Line("    grade_risks: [" + rows.substr(1) + "]  # grades 1 to 4, rings of " + winds + " kt");
    Line(Text("    duration: %d\n    track:", storm_steps_));
    for (const StormWaypoint& waypoint : storm_.waypoints) {
      std::string radii;
      for (const double radius : waypoint.radii_km) {
        radii += (radii.empty() ? "" : ", ") + Short(radius, 1);
      }
      std::string quadrants;
      for (const std::array<double, 4>& ring : waypoint.quadrants_km) {
        quadrants += (quadrants.empty() ? "[" : ", [") + Short(ring[0], 1);
        for (std::size_t q = 1; q < ring.size(); ++q) quadrants += ", " + Short(ring[q], 1);
        quadrants += "]";
      }
      Line("      - {time: " + FormatTime(waypoint.time) +
           ", latitude: " + Short(waypoint.position.latitude, 3) +
           ", longitude: " + Short(waypoint.position.longitude, 3) +
           (quadrants.empty() ? ", radii_km: [" + radii : ", quadrants_km: [" + quadrants) + "],");
      Line(Text("         grade: %d", DisasterGrade(waypoint.grade)) +
           (waypoint.pressure_hpa ? ", pressure_hpa: " + Short(*waypoint.pressure_hpa, 1) : "") +
           (waypoint.wind_mps ? ", wind_mps: " + Short(*waypoint.wind_mps, 1) : "") + "}" +
           (waypoint.estimated ? "  # radii estimated" : ""));
    }
  }

  const RanchRequest& request_;
  Ranch ranch_;
  Terrain terrain_;
  StormRings storm_;
  std::vector<DisasterSpec> presets_;
  std::string storm_text_;
  std::vector<NamedLayer> layers_;
  std::vector<std::string> sea_units_;  // by layer
  Layer value_;                         // of a device, by cell
  std::optional<GeoPoint> origin_;
  double cell_size_m_{};
  double step_s_{};
  std::int64_t start_{};
  std::int32_t duration_{};     // of all
  std::int32_t storm_steps_{};  // of the storm
};

}  // namespace

Ranch BuildRanch(const RanchRequest& request) {
  Ranch ranch = Builder(request).Build();
  LayoutGenerator generator(ranch.scenario);
  Layout layout;
  generator.Generate(0, 0, layout);  // refuses what does not fit on the water there is
  return ranch;
}

std::string Sketch(const Scenario& scenario) {
  LayoutGenerator generator(scenario);
  Layout layout;
  generator.Generate(scenario.layout_seed, 0, layout);
  std::string text;
  for (std::int32_t y = scenario.height; y-- > 0;) {
    for (std::int32_t x = 0; x < scenario.width; ++x) {
      const std::uint8_t bits = layout.bits({x, y});
      const char mark = (bits & kIslandBit) != 0       ? '#'
                        : (bits & kRockBit) != 0       ? 'o'
                        : (bits & kPortBit) != 0       ? 'P'
                        : (bits & kDeviceSiteBit) != 0 ? 'd'
                                                       : '.';
      text += mark;
    }
    text += '\n';
  }
  return text;
}

}  // namespace aquafarm
