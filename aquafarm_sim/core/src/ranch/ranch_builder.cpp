// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/ranch/ranch_builder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "aquafarm/base/check.h"
#include "aquafarm/charts/ascii_grid.h"
#include "aquafarm/charts/coast.h"
#include "aquafarm/charts/map_file.h"
#include "aquafarm/farm/farm_text.h"
#include "aquafarm/farm/layout.h"
#include "aquafarm/observation/encoder.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/scenario/validate.h"
#include "aquafarm/sea/expression.h"
#include "aquafarm/sea/sea_field.h"
#include "aquafarm/storms/notices.h"
#include "aquafarm/storms/presets.h"
#include "aquafarm/tracks/fine_rings.h"
#include "aquafarm/tracks/reader.h"
#include "base/files.h"
#include "base/text.h"
#include "base/time.h"
#include "input/file_type.h"
#include "ranch/ranch_fit.h"
#include "ranch/ranch_storm.h"
#include "ranch/ranch_text.h"
#include "scenario/domains.h"
#include "scenario/yaml_writer.h"

namespace aquafarm {
namespace {

using internal::FileName;
using internal::Format;
using internal::FormatTime;
using internal::OneLine;
using internal::Short;
using internal::Text;
using internal::YamlWriter;

// Builds a ranch: fills the plan part by part, then writes the scenario's text and parses it.
class Builder {
 public:
  explicit Builder(const RanchRequest& request) : request_(request) {
    plan_.width = request.width;
    plan_.height = request.height;
    plan_.cell_size_m = request.cell_size_m;
    CheckSize("size", request.width);
    CheckSize("size", request.height);
    internal::Check("cell", request.cell_size_m, internal::Interval<double>{0.01, 1.0e6});
    internal::Check("sea_level", request.sea_level, internal::Interval<float>{-1.0e5F, 1.0e5F});
    if (!request.archive.files.empty() && !request.track.empty()) {
      throw InputError("archive: got an archive and a track, expected one of them");
    }
    const bool storm = !request.track.empty() || !request.archive.files.empty();
    if (!request.center && (storm || !request.port_places.empty())) {
      throw InputError(
          "center: got none, expected the position of the ranch, which storms and ports require");
    }
  }

  BuiltRanch Build() {
    PlaceTerrain();
    PlacePorts();
    SetTime();
    ReadSea();
    AddPresets();
    SayNotices();
    plan_.step_limit = StepLimit();
    Write();
    if (CompleteFromDraft()) Write();
    return std::move(ranch_);
  }

 private:
  // Completes the plan with the parts that depend on the first draft of the scenario: the storms in
  // reach, the view, and the values of devices. Returns whether the plan has changed.
  bool CompleteFromDraft() {
    const bool storms = !request_.archive.files.empty();
    if (storms) SelectStorms();
    plan_.routes = IsForNetworks();
    const bool values = !request_.value.empty();
    if (values) ValueDevices();
    return storms || plan_.routes || values;
  }

  // Replaces the files of the archive by the storms in reach, which ParseScenario has selected.
  void SelectStorms() {
    const StormsSpec& storms = *ranch_.scenario.disasters.front().storms;
    plan_.archive = storms.tracks;
    Say(internal::ArchiveLine(request_.archive.files, storms));
  }

  void Write() {
    ranch_.yaml = internal::WriteRanch(request_, plan_, ranch_.decided);
    ranch_.scenario = ParseScenario(ranch_.yaml, request_.name);
  }

  // Returns whether neural networks get routes by water as features. They do if the ranch has too
  // many states for quick tabular learning, and is small enough for routes.
  bool IsForNetworks() {
    constexpr std::uint32_t kSoonLearnt = 1'000'000;
    const std::uint32_t states = Encoder(ranch_.scenario).state_count();
    if (states > 0 && states <= kSoonLearnt) return false;
    Scenario with_routes = ranch_.scenario;
    with_routes.view.routes = true;
    try {
      ValidateScenario(with_routes);
    } catch (const InputError&) {
      return false;
    }
    Say("states: " + (states == 0 ? "too many" : std::to_string(states)) +
        "; slow to learn in a table, so networks get routes by water");
    return true;
  }

  static void CheckSize(const char* what, std::int32_t side) {
    internal::Check(what, side, internal::Interval<std::int32_t>{2, kMaxSide});
  }
  std::int32_t width() const { return plan_.width; }
  std::int32_t height() const { return plan_.height; }
  void Say(const std::string& line) { ranch_.decided.push_back(OneLine(line)); }
  void Keep(const std::vector<std::string>& warnings) {
    ranch_.warnings.insert(ranch_.warnings.end(), warnings.begin(), warnings.end());
  }

  void KeepOne(const std::string& warning) {
    if (!warning.empty()) ranch_.warnings.push_back(warning);
  }
  internal::RanchArea Area() { return {Frame(), width(), height()}; }

  void Resize(Eigen::Index rows, Eigen::Index columns, double cell_size_m) {
    plan_.width = static_cast<std::int32_t>(columns);
    plan_.height = static_cast<std::int32_t>(rows);
    CheckSize("chart", width());
    CheckSize("chart", height());
    plan_.cell_size_m = cell_size_m;
  }

  // Sets plan_.origin, the centre of cell (0, 0). The requested place is the middle of the ranch.
  GeoFrame Frame() {
    if (!request_.center) {
      throw InputError("center: got none, expected the position of the ranch on the chart");
    }
    const GeoPoint corner = GeoFrame(*request_.center, plan_.cell_size_m)
                                .ToGeo(-(width() - 1) / 2.0, -(height() - 1) / 2.0);
    // Rounded to the digits in the scenario file, so that the frame here equals that of the file.
    plan_.origin =
        GeoPoint{std::stod(Short(corner.latitude, 6)), std::stod(Short(corner.longitude, 6))};
    return GeoFrame(*plan_.origin, plan_.cell_size_m);
  }

  // Calls `make` and prefixes the messages of its errors with the chart's path.
  template <typename Make>
  auto OfChart(Make make) {
    try {
      return make();
    } catch (const InputError& error) {
      throw InputError(request_.chart + ": " + error.what());
    }
  }

  LandShare ReadChart() {
    if (request_.chart.empty()) return LandShare::Zero(height(), width());
    const std::string text = internal::ReadTextFile(request_.chart);
    const internal::DetectedFile look = internal::DetectFileType(text);
    const bool unknown = look.kind == internal::FileKind::kUnknown;
    switch (unknown ? internal::KindByName(request_.chart) : look.kind) {
      case internal::FileKind::kMapYaml: {
        const MapFile map = LoadMap(request_.chart);
        Resize(map.occupancy.rows(), map.occupancy.cols(), map.cell_size_m);
        return OfChart([&map] { return ShareOfLand(map); });
      }
      case internal::FileKind::kAsciiGrid: {
        const AsciiGrid grid = ParseAsciiGrid(text, request_.chart);
        if (grid.IsGeographic()) {
          KeepOne(internal::NeedCover(grid, Area(), request_.chart));
          return ShareOfLand(grid, Frame(), width(), height(), request_.sea_level);
        }
        Resize(grid.value.rows(), grid.value.cols(), grid.cell_size);
        return ShareOfLand(grid, request_.sea_level);
      }
      case internal::FileKind::kGeoJson: {
        const Coast coast = ParseCoast(text, request_.chart);
        Keep(coast.warnings);
        internal::NeedCover(coast, Area(), request_.chart);
        return ShareOfLand(coast, Frame(), width(), height());
      }
      default:
        throw InputError(request_.chart + ":1: got " + look.words +
                         ", expected a chart: a coast as GeoJSON, a map of map_server (its YAML) "
                         "or an ASCII grid of heights");
    }
  }

  void PlaceTerrain() {
    const LandShare share = ReadChart();
    plan_.terrain = OfChart([&share] { return ToTerrain(share); });
    if (request_.center) Frame();
    Say(Text("ranch: %d x %d cells of %s m", width(), height(), Format(plan_.cell_size_m).c_str()) +
        (request_.center
             ? Text(", middle %.3f N %.3f E", request_.center->latitude, request_.center->longitude)
             : std::string()));
    if (request_.chart.empty()) return;
    Say(Text("chart: %s: %d island cells, %d rocks, %d of water", FileName(request_.chart).c_str(),
             static_cast<int>(plan_.terrain.land.cast<int>().sum()),
             static_cast<int>(plan_.terrain.rocks.size()), plan_.terrain.WaterCells()) +
        (plan_.terrain.filled > 0
             ? Text("; %d cells of enclosed water filled", plan_.terrain.filled)
             : std::string()));
  }

  void PlacePorts() {
    std::vector<Cell>& ports = plan_.ports;
    if (request_.port_places.empty()) {
      ports = SpreadPorts(plan_.terrain, request_.ports);
    } else {
      const GeoFrame frame = Frame();
      for (const GeoPoint& place : request_.port_places) {
        const std::array<double, 2> wanted = frame.ToGrid(place);
        const Cell cell{static_cast<std::int32_t>(std::lround(wanted[0])),
                        static_cast<std::int32_t>(std::lround(wanted[1]))};
        ports.push_back(NearestShore(plan_.terrain, cell, ports));
        KeepOne(internal::CheckPort(place, ports.back(), request_, Area(), plan_.terrain));
        Say(Text("port: given at (%d, %d), put on the shore at (%d, %d)", cell.x, cell.y,
                 ports.back().x, ports.back().y));
      }
    }
    if (ports.empty()) Say(Text("ports: no shore, so %d drawn at the edge", request_.ports));
  }

  // Throws an error about a fix, with its line in the track's file. Fixes of JSON have no line.
  [[noreturn]] void Fail(const StormFix& fix, const std::string& what) const {
    throw InputError(request_.track + ":" + (fix.line > 0 ? std::to_string(fix.line) + ":" : "") +
                     " " + FormatTime(fix.time) + ": " + what);
  }

  // Checks the fixes as the scenario reader does, but reports their line in the track's file.
  void CheckReach(const StormTrack& track) {
    const GeoFrame frame = Frame();
    const std::vector<StormFix>& all = track.fixes;
    for (std::size_t i = 0; i < all.size(); ++i) {  // also one fix beyond each end of the waypoints
      const bool past = i + 1 < all.size() && all[i + 1].time <= plan_.storm.waypoints[0].time;
      const bool later = i > 0 && all[i - 1].time >= plan_.storm.waypoints.back().time;
      if (past || later || frame.Faces(all[i].position)) continue;
      Fail(all[i], Text("got latitude %g, longitude %g, expected a place within 60 degrees of the "
                        "ranch",
                        all[i].position.latitude, all[i].position.longitude));
    }
  }

  // Returns the recorded track, continued by its newest forecast or, if it has none, by the newest
  // of --forecasts. Best tracks of CMA and JMA are complete: --forecasts does not continue them.
  StormTrack Continued(StormTrack recorded, TrackFormat format) {
    const bool complete = format == TrackFormat::kCma || format == TrackFormat::kJma;
    if (!request_.forecasts.empty()) {
      forecasts_ = LoadStormFile(request_.forecasts);
      Keep(forecasts_.warnings);
      if (NewestForecast(recorded) == nullptr && !complete) {
        recorded.forecasts = internal::SameStorm("forecasts", forecasts_, recorded).forecasts;
      }
    }
    StormTrack whole = WithForecast(recorded, NoForecast::kEnd);
    plan_.knowledge = KnowledgeOf(recorded, whole);
    return whole;
  }

  StormTrack ReadTrack() {
    const StormFile file = LoadStormFile(request_.track);
    Keep(file.warnings);
    StormTrack track = internal::StormOf(file, request_.storm);
    const auto recorded = static_cast<int>(track.fixes.size());
    std::string radii;
    if (!request_.radii.empty()) {
      const StormFile other = LoadStormFile(request_.radii);
      Keep(other.warnings);
      radii = Text("; radii of %d fixes from %s",
                   BorrowRings(internal::SameStorm("radii", other, track), track),
                   FileName(request_.radii).c_str());
    }
    track = Continued(track, file.format);
    if (track.fixes.size() == 1) {
      Fail(track.fixes[0], "got only one point of " + (track.name.empty() ? track.id : track.name) +
                               ", expected at least two, which define its motion");
    }
    const FineRings fine = ToFineRings(track, request_.reduction, track.fixes[0].time);
    plan_.storm = fine.storm;
    KeepOne(internal::CheckWinds(fine.held));
    const bool blank = file.format == TrackFormat::kIbtracs && plan_.storm.estimated > 0;
    plan_.storm_text = (track.name.empty() ? track.id : track.name + " (" + track.id + ")") + ", " +
                       std::string(ToString(file.format)) + " " + FileName(request_.track);
    Say("storm: " + plan_.storm_text +
        Text(", %d fixes, %d-minute winds", recorded, track.fixes[0].averaging_min) + radii +
        Text("; radii of %d fixes estimated%s; radii of %d fixes unknown", plan_.storm.estimated,
             blank ? ", where quadrants are blank" : "", plan_.storm.silent));
    return track;
  }

  // Sets step duration, start and duration of the episode, from the storm's track if there is one.
  void SetTime() {
    plan_.step_s = request_.step_s.value_or(
        std::max(1.0, std::round(plan_.cell_size_m / (request_.speed_kn * kMpsPerKnot))));
    internal::Check("step", plan_.step_s, internal::Interval<double>{0.001, 1.0e6});
    plan_.start = request_.start.value_or(0);
    if (!request_.archive.files.empty()) {
      constexpr double kWatched_s = 48 * 3600.0;
      plan_.archive_steps = duration_ = StepsToCover(kWatched_s, plan_.step_s);
      return Say(Text(
          "time: %g s per step; a storm is nearest 18 to 30 h after the start and lasts %d steps",
          plan_.step_s, duration_));
    }
    if (request_.track.empty()) return Say(Text("time: %g s per step; no track", plan_.step_s));
    const StormTrack track = ReadTrack();
    const double half_diagonal_km =
        std::hypot(width(), height()) / 2.0 * plan_.cell_size_m / 1000.0;
    const Passage passage = ClosestApproach(plan_.storm, *request_.center, half_diagonal_km);
    const internal::PassageReport report = internal::Report(plan_.storm, passage, plan_.knowledge);
    for (const std::string& line : report.lines) Say(line);
    Keep(report.warnings);
    const bool reaches = passage.worst_wind_kt > 0;
    constexpr std::int64_t kHour_s = 3600;
    const std::int64_t half_day_s = 12 * kHour_s;
    const auto lead_s = static_cast<std::int64_t>(request_.lead_h * kHour_s);
    const std::int64_t first = reaches ? passage.first - lead_s : passage.nearest_time - half_day_s;
    const std::int64_t last = reaches ? passage.last : passage.nearest_time + half_day_s;
    const auto hour_before = [](std::int64_t time) { return time - ((time % 3600) + 3600) % 3600; };
    plan_.start =
        request_.start.value_or(std::max(hour_before(first), plan_.storm.waypoints.front().time));
    const std::int64_t end =
        std::min(hour_before(last) + 2 * kHour_s, plan_.storm.waypoints.back().time);
    KeepOne(internal::CheckStart(plan_.start, end, plan_.storm, passage));
    duration_ = StepsToCover(static_cast<double>(end - plan_.start), plan_.step_s);
    plan_.storm_steps = duration_;
    ends_unknown_ =
        end == plan_.storm.waypoints.back().time && (passage.over_at_end || passage.nearest_at_end);
    Say(Text("time: %g s per step, from %s; the storm is ", plan_.step_s,
             FormatTime(plan_.start).c_str()) +
        Text(ends_unknown_ ? "known for %d steps only" : "over after %d steps", duration_));
    Trim(end);
    CheckReach(track);
    ReadForecasts(track, end);
  }

  void ReadForecasts(const StormTrack& track, std::int64_t end) {
    if (request_.forecasts.empty()) return;
    std::vector<StormForecast>& kept = plan_.forecasts;
    kept = internal::ForecastsDuring(internal::SameStorm("forecasts", forecasts_, track).forecasts,
                                     plan_.start, end, ranch_.warnings);
    if (kept.empty()) {
      throw InputError("forecasts: got no forecast points of the storm between " +
                       FormatTime(plan_.start) + " and " + FormatTime(end) + " in " +
                       FileName(request_.forecasts) + ", expected bulletins with forecast points");
    }
    Say(Text("forecasts: %d from %s, the first of ", static_cast<int>(kept.size()),
             FileName(request_.forecasts).c_str()) +
        FormatTime(kept.front().issued));
  }

  // Keeps the waypoints from the last one at or before the start to the first one not before `end`.
  void Trim(std::int64_t end) {
    std::vector<StormWaypoint>& all = plan_.storm.waypoints;
    std::size_t from = 0;
    while (from + 1 < all.size() && all[from + 1].time <= plan_.start) ++from;
    std::size_t to = all.size();
    while (to > from + 1 && all[to - 2].time >= end) --to;
    all = {all.begin() + static_cast<std::ptrdiff_t>(from),
           all.begin() + static_cast<std::ptrdiff_t>(to)};
  }

  // Returns the max number of steps. All disasters must already be in the plan.
  std::int32_t StepLimit() const {
    if (ends_unknown_ && duration_ == plan_.storm_steps) return duration_;
    return duration_ > 0 ? duration_ + 100 : 5000;
  }

  // Lists the notices in force during the episode, or all notices if the episode has no date.
  void SayNotices() {
    if (request_.notices.empty()) return;
    const NoticeFile file = LoadNotices(request_.notices);
    Keep(file.warnings);
    const bool timed = request_.start || !plan_.storm.waypoints.empty();
    const std::int64_t end = plan_.start + static_cast<std::int64_t>(StepLimit() * plan_.step_s);
    int others = 0;
    for (const Notice& notice : file.notices) {
      const bool in_force = !timed || (notice.start < end && notice.end > plan_.start);
      others += in_force ? 0 : 1;
      if (in_force) Say("notice: " + Describe(notice));
    }
    if (others > 0) Say(Text("notices: %d more, not in force during the episode", others));
  }

  NamedLayer ReadLayer(const SeaLayerRequest& sea) {
    const GeoFrame frame = Frame();
    const std::optional<std::int64_t> time =
        request_.track.empty() ? request_.start : std::optional<std::int64_t>(plan_.start);
    SeaField field = LoadSeaField(sea.file, {sea.variable, time, request_.sea_depth_m}, frame,
                                  width(), height());
    NamedLayer layer{sea.name, ToLayer(field, frame, width(), height())};
    // Rounded to the digits in the scenario file, so that expressions give the same results there.
    layer.layer = layer.layer.unaryExpr([](float value) {
      return std::isnan(value)
                 ? value
                 : std::strtof(Text("%.6g", static_cast<double>(value)).c_str(), nullptr);
    });
    const Layer known = layer.layer.isNaN().select(Layer::Zero(height(), width()), layer.layer);
    const auto cells = static_cast<float>((!layer.layer.isNaN()).count());
    internal::NeedValues(field, layer.layer, Area(), sea.file);
    KeepOne(internal::CheckTime(field, time, sea.file));
    Say(sea.name + ": " + field.name + " of " + FileName(sea.file) +
        (field.time ? " at " + FormatTime(*field.time) : "") +
        Text(", mean %.4g %s, on %.0f of %d cells", static_cast<double>(known.sum() / cells),
             field.units.c_str(), static_cast<double>(cells), width() * height()));
    plan_.sea_units.push_back(std::move(field.units));
    return layer;
  }

  void AddPresets() {
    const bool south = request_.center && request_.center->latitude < 0.0;
    for (const std::string& text : request_.disasters) {
      const DisasterSpec disaster =
          ParseDisasterPreset(text, {plan_.cell_size_m, plan_.step_s, south});
      plan_.presets.push_back(disaster);
      Say(Text("disaster: %s: grade %d, radius %.1f cells, %.3g cells per step, %d steps",
               text.c_str(), disaster.grade, static_cast<double>(disaster.radii.back()),
               static_cast<double>(disaster.speed), disaster.duration));
      duration_ = std::max(duration_, disaster.duration);
    }
  }

  void ReadSea() {
    for (const SeaLayerRequest& sea : request_.sea) plan_.layers.push_back(ReadLayer(sea));
    if (!request_.sea_risk.empty()) {
      OfSea("sea_risk", request_.sea_risk);
      Say("risk of the sea: " + request_.sea_risk);
    }
    if (request_.value.empty()) return;
    value_ = OfSea("value", request_.value);
    Say("values: " + request_.value);
  }

  // Evaluates an option's expression at every cell.
  Layer OfSea(const char* option, const std::string& expression) const {
    try {
      return Evaluate(expression, plan_.layers);
    } catch (const InputError& error) {
      throw InputError(std::string(option) + ": " + error.what());
    }
  }

  // Fixes the drawn positions of the devices and gives each device the value of its cell.
  void ValueDevices() {
    Layout layout;
    LayoutGenerator(ranch_.scenario).Generate(request_.seed, 0, layout);
    for (const PlacedDevice& device : layout.devices) {
      const float value = value_(device.cell.y, device.cell.x);
      if (!(value >= 0.0F && value <= 10000.0F)) {
        throw InputError("value: got " + Format(value) + " at the device at " +
                         YamlWriter::Value(device.cell) + ", expected a number in [0, 10000]");
      }
      plan_.sites.push_back({device.cell, device.kind, value, false});
    }
  }

  const RanchRequest& request_;
  BuiltRanch ranch_;
  internal::RanchPlan plan_;
  Layer value_;              // value of a device, by cell
  StormFile forecasts_;      // content of --forecasts
  std::int32_t duration_{};  // max duration of all disasters [steps]
  bool ends_unknown_{};  // the disaster ends at the storm's last known position, where the storm is
                         // still over the ranch or coming nearer
};

}  // namespace

BuiltRanch BuildRanch(const RanchRequest& request) {
  BuiltRanch ranch = Builder(request).Build();
  LayoutGenerator generator(ranch.scenario);
  Layout layout;
  generator.Generate(0, 0, layout);  // rejects a layout that does not fit on the water
  return ranch;
}

std::string RenderAscii(const Scenario& scenario) {
  LayoutGenerator generator(scenario);
  Layout layout;
  generator.Generate(scenario.layout_seed, 0, layout);
  std::string text;
  for (std::int32_t y = scenario.height; y-- > 0;) {
    for (std::int32_t x = 0; x < scenario.width; ++x) text += ChartMark(layout.bits({x, y}), 'd');
    text += '\n';
  }
  return text;
}

}  // namespace aquafarm
