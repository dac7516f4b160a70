// SPDX-License-Identifier: BSD-3-Clause
#include "ranch/ranch_text.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "aquafarm/scenario/damage_defaults.h"
#include "base/text.h"
#include "base/time.h"
#include "scenario/yaml_writer.h"

namespace aquafarm::internal {
namespace {

// Formats a value as ToYaml does.
template <typename T>
std::string Value(const T& value) {
  return YamlWriter::Value(value);
}

std::string InQuotes(const std::string& text) { return Value(OneLine(text)); }

class Writer {
 public:
  Writer(const RanchRequest& request, const RanchPlan& plan,
         const std::vector<std::string>& decided)
      : request_(request), plan_(plan), decided_(decided) {}

  std::string Write() {
    Line("# SPDX-License-Identifier: BSD-3-Clause");
    Line("# Made by `aquafarm scenario`:");
    for (const std::string& line : decided_) Line("#   " + line);
    Line("name: " + InQuotes(request_.name));
    Line("description: " +
         InQuotes("A ranch" +
                  (request_.chart.empty() ? "" : " on the chart " + FileName(request_.chart)) +
                  (plan_.archive_steps > 0 ? " with another recorded storm in every episode."
                   : request_.track.empty() && !plan_.presets.empty()
                       ? " with disasters that are not recorded."
                   : request_.track.empty()
                       ? " in calm weather."
                       : " while " + plan_.storm_text + " passes." + ForecastNote())));
    Line("grid:");
    Line(Text("  width: %d\n  height: %d", plan_.width, plan_.height));
    Line("  cell_size_m: " + Format(plan_.cell_size_m));
    if (plan_.origin) {
      Line("  origin: {latitude: " + Format(plan_.origin->latitude) +
           ", longitude: " + Format(plan_.origin->longitude) + "}");
    }
    Line("time: {step_duration_s: " + Format(plan_.step_s) +
         (plan_.storm.waypoints.empty() && !request_.start
              ? std::string()
              : ", start: " + FormatTime(plan_.start)) +
         Text(", step_limit: %d}", plan_.step_limit));
    WriteLayout();
    Line(Text("ships: {count: %d, capacity: 1}", request_.ships));
    const bool archive = plan_.archive_steps > 0;
    if (archive || !plan_.storm.waypoints.empty() || !plan_.presets.empty()) Line("disasters:");
    if (archive) WriteArchive();
    if (!plan_.storm.waypoints.empty()) WriteStorm();
    for (const DisasterSpec& disaster : plan_.presets) WritePreset(disaster);
    WriteDamage();
    WriteEnergy();
    Line(plan_.routes ? "view: {mode: full, routes: true}" : "view: {mode: full}");
    if (!plan_.layers.empty()) WriteSeas();
    return std::move(yaml_);
  }

 private:
  // Returns a sentence on where the track changes from recorded to forecast; "" without a forecast.
  std::string ForecastNote() const {
    const auto& all = plan_.storm.waypoints;
    const bool forecast =
        std::any_of(all.begin(), all.end(), [](const StormWaypoint& one) { return one.forecast; });
    return forecast ? " The storm is " + Describe(plan_.knowledge) + "." : "";
  }

  // Writes the energy figures of a small workboat at about 4 kn (docs/data.md).
  void WriteEnergy() {
    constexpr double kOnBoard_kW = 2.0;
    const double idle_kwh = kOnBoard_kW * plan_.step_s / 3600.0;
    Line("# Units: docs/scenario.md. The reward does not contain the energy.");
    Line("energy: {per_km: 1.2, per_device: 0.5, rough_sea: 0.5, idle_per_step: " +
         Short(idle_kwh, 4) + "}");
  }

  void Line(const std::string& line) { yaml_ += line + "\n"; }

  // Writes the layers as numbers, so that the scenario needs no other file.
  void WriteSeas() {
    Line("seas:\n  layers:");
    for (std::size_t i = 0; i < plan_.layers.size(); ++i) {
      Line("    - name: " + plan_.layers[i].name);
      Line("      units: " + InQuotes(plan_.sea_units[i]));
      Line("      values: [");
      const Layer& layer = plan_.layers[i].layer;
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

  // Writes the damage factors that differ from 1, by kind of device and kind of disaster.
  void WriteDamage() {
    Line("damage:\n  kinds:  # factors of the damage, docs/data.md");
    for (int device = 0; device < kDeviceKindCount; ++device) {
      std::string factors;
      for (int disaster = 0; disaster < kDisasterKindCount; ++disaster) {
        const float factor =
            kRealDamage[static_cast<std::size_t>(device)][static_cast<std::size_t>(disaster)];
        if (factor == 1.0F) continue;
        factors += (factors.empty() ? "{" : ", ") + Value(static_cast<DisasterKind>(disaster)) +
                   ": " + Format(factor);
      }
      if (factors.empty()) continue;
      Line("    " + Value(static_cast<DeviceKind>(device)) + ": " + factors + "}");
    }
  }

  void WriteLayout() {
    Line("layout:\n  mode: fixed\n  seed: " + Format(request_.seed));
    const std::vector<IslandBlock> islands = ToIslands(plan_.terrain.land);
    if (!islands.empty()) Line("  islands:");
    for (const IslandBlock& block : islands) {
      Line(Text("    - {x: %d, y: %d, width: %d, height: %d}", block.south_west.x,
                block.south_west.y, block.width, block.height));
    }
    Line(plan_.terrain.rocks.empty() ? "  rocks: {count: [0, 0]}"
                                     : "  rocks: {cells: " + Value(plan_.terrain.rocks) + "}");
    Line(plan_.ports.empty() ? Text("  ports: {count: %d}", request_.ports)
                             : "  ports: {cells: " + Value(plan_.ports) + "}");
    WriteDevices();
  }

  void WriteDevices() {
    if (plan_.sites.empty()) {
      Line("  devices: {placement: " + Value(request_.placement) +
           Text(", count: %d}", request_.devices));
      return;
    }
    Line("  devices:\n    placement: explicit\n    sites:");
    for (const DeviceSite& site : plan_.sites) {
      Line("      - {cell: " + Value(site.cell) + ", kind: " + Value(site.kind) +
           (site.value ? ", value: " + Format(*site.value) : "") + "}");
    }
  }

  void WritePreset(const DisasterSpec& disaster) {
    Line("  - kind: " + Value(disaster.kind));
    Line(Text("    grade: %d\n    radii: ", disaster.grade) + Value(disaster.radii) +
         "\n    risks: " + Value(disaster.risks));
    Line("    speed: " + Format(disaster.speed) +
         Text("\n    heading_deg: %d", disaster.heading_deg.value_or(0)) +
         "\n    turn_probability: 0\n    radius_growth: " + Format(disaster.radius_growth));
    Line("    border: " + Value(disaster.border) + Text("\n    duration: %d", disaster.duration));
  }

  // Returns the default risks of the outermost `rings` rings, a row for each of the grades 1 to 4.
  static std::string RiskTable(std::size_t rings) {
    std::vector<std::vector<float>> rows;
    for (const std::vector<float>& row : DefaultGradeRisks()) {
      rows.emplace_back(row.end() - static_cast<std::ptrdiff_t>(rings), row.end());
    }
    return Value(rows);
  }

  // Writes the tracks of the storms in reach, so that the scenario needs no other file. Before the
  // storms are selected, writes the paths of the archive's files instead.
  void WriteArchive() {
    const ArchiveRequest& archive = request_.archive;
    Line("  - kind: typhoon");
    Line("    grade_risks: " + RiskTable(kMaxStormRings) + "  # grades 1 to 4");
    Line("    ring_winds_kt: [64, 50, 34]");
    Line(Text("    duration: %d\n    storms:", plan_.archive_steps));
    Line("      years: " + Value(archive.years));
    Line("      evaluation_years: " + Value(archive.evaluation_years.value_or(
                                          Range<std::int32_t>{archive.years.max + 1, kLastYear})));
    Line("      within_km: " + Format(archive.within_km));
    Line("      approach_h: 24");
    Line(
        "      perturbation: {along_km: 50, across_km: 50, start_h: 6, intensity: 0.1, size: "
        "0.35}");
    if (plan_.archive.empty()) {
      std::vector<std::string> files;
      for (const std::string& file : archive.files) {
        files.push_back(OneLine(std::filesystem::absolute(file).string()));
      }
      return Line("      archive: " + Value(files));
    }
    Line("      tracks: |");
    std::string_view rest = plan_.archive;
    while (!rest.empty()) {
      const std::size_t end = rest.find('\n');
      Line("        " + std::string(rest.substr(0, end)));
      rest.remove_prefix(std::min(rest.size(), end + 1));
    }
  }

  void WriteStorm() {
    Line("  - kind: typhoon");
    if (!plan_.storm.name.empty()) Line("    name: " + InQuotes(plan_.storm.name));
    Line("    grade_risks: " + RiskTable(plan_.storm.wind_kt.size()) + "  # grades 1 to 4");
    Line("    ring_winds_kt: " + Value(plan_.storm.wind_kt));
    Line(Text("    duration: %d\n    track:", plan_.storm_steps));
    for (const StormWaypoint& waypoint : plan_.storm.waypoints) {
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
           NoteOn(waypoint));
    }
    if (!plan_.forecasts.empty()) WriteForecasts();
  }

  static std::string NoteOn(const StormWaypoint& waypoint) {
    if (waypoint.forecast)
      return waypoint.estimated ? "  # forecast, radii estimated" : "  # forecast";
    return waypoint.estimated ? "  # radii estimated" : "";
  }

  void WriteForecasts() {
    Line("    forecasts:");
    for (const StormForecast& forecast : plan_.forecasts) {
      Line("      - time: " + FormatTime(forecast.issued) +
           (forecast.agency.empty() ? "" : "  # " + OneLine(forecast.agency)) +
           "\n        points:");
      for (const StormFix& fix : forecast.fixes) {
        Line("          - {time: " + FormatTime(fix.time) + ", latitude: " +
             Short(fix.position.latitude, 3) + ", longitude: " + Short(fix.position.longitude, 3) +
             (fix.wind_mps ? ", wind_mps: " + Short(*fix.wind_mps, 1) : "") + "}");
      }
    }
  }

  const RanchRequest& request_;
  const RanchPlan& plan_;
  const std::vector<std::string>& decided_;
  std::string yaml_;
};

}  // namespace

std::string WriteRanch(const RanchRequest& request, const RanchPlan& plan,
                       const std::vector<std::string>& decided) {
  return Writer(request, plan, decided).Write();
}

std::string FileName(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string OneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20U; }, '?');
  return text;
}

std::string Short(double value, int digits) {
  return Format(std::stod(Text("%.*f", digits, value)));
}

}  // namespace aquafarm::internal
