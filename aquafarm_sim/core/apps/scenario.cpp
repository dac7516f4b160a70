// SPDX-License-Identifier: BSD-3-Clause
// Makes a scenario file from a chart, a position and a storm. Shows the layout of a ranch that is
// at most 200 cells wide. Lists the choices of BuildRanch.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "aquafarm/base/check.h"
#include "aquafarm/charts/map_file.h"
#include "aquafarm/farm/farm_text.h"
#include "aquafarm/observation/encoder.h"
#include "aquafarm/ranch/ranch_builder.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/storms/presets.h"
#include "base/files.h"
#include "base/text.h"

namespace aquafarm {
namespace {

using internal::ParseNumber;

struct Arguments {
  RanchRequest ranch;
  std::string center;
  std::vector<std::string> ports;
  std::string size{"25x25"};
  std::string cell{"200m"};
  std::string layout{"random"};
  std::string rings{"equal_area"};
  std::string start;
  std::vector<std::string> sea;
  std::string years;
  std::string evaluation_years;
  std::string output;
  std::string map;
  bool own_size{};  // --size was given
  bool own_cell{};
};

// Parses "30.2,122.7" or "25x25" as two numbers.
std::pair<double, double> Pair(const std::string& name, const std::string& text, char between,
                               const char* expected) {
  const std::size_t at = text.find(between);
  if (at != std::string::npos) {
    const std::optional<double> first = ParseNumber(text.substr(0, at));
    const std::optional<double> second = ParseNumber(text.substr(at + 1));
    if (first && second) return {*first, *second};
  }
  throw InputError(name + ": got '" + text + "', expected " + expected);
}

GeoPoint Place(const std::string& name, const std::string& text) {
  const auto [latitude, longitude] = Pair(name, text, ',', "LATITUDE,LONGITUDE in degrees");
  if (latitude >= -90.0 && latitude <= 90.0 && longitude >= -180.0 && longitude <= 360.0) {
    return {latitude, longitude > 180.0 ? longitude - 360.0 : longitude};
  }
  throw InputError(name + ": got '" + text +
                   "', expected a latitude in [-90, 90] and a longitude in [-180, 360]");
}

// Parses "200m" or "0.2km".
double Metres(const std::string& text) {
  const bool km = text.size() > 2 && text.compare(text.size() - 2, 2, "km") == 0;
  const std::size_t unit = km ? 2 : !text.empty() && text.back() == 'm' ? 1 : 0;
  const std::optional<double> value = ParseNumber(text.substr(0, text.size() - unit));
  if (!value) throw InputError("cell: got '" + text + "', expected a length such as 200m or 0.2km");
  return km ? *value * 1000.0 : *value;
}

// Parses "salinity=sea.nc:so"; the file name may contain a colon, the variable may not.
SeaLayerRequest SeaLayer(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t colon = text.rfind(':');
  if (equals == std::string::npos || colon == std::string::npos || colon < equals) {
    throw InputError("sea: got '" + text + "', expected NAME=FILE:VARIABLE");
  }
  return {text.substr(0, equals), text.substr(equals + 1, colon - equals - 1),
          text.substr(colon + 1)};
}

template <typename Enum>
Enum Named(const char* name, const std::string& text, int count) {
  std::string names;
  for (int i = 0; i < count; ++i) {
    const auto value = static_cast<Enum>(i);
    if (ToString(value) == text) return value;
    names += (i > 0 ? ", " : "") + std::string(ToString(value));
  }
  throw InputError(std::string(name) + ": got '" + text + "', expected one of " + names);
}

// Parses "1979:2009".
Range<std::int32_t> Years(const char* name, const std::string& text) {
  const auto [first, last] = Pair(name, text, ':', "FIRST:LAST such as 1979:2009");
  const auto whole = [](double year) { return year == std::floor(year) && std::abs(year) < 1.0e4; };
  if (whole(first) && whole(last)) {
    return {static_cast<std::int32_t>(first), static_cast<std::int32_t>(last)};
  }
  throw InputError(std::string(name) + ": got '" + text +
                   "', expected FIRST:LAST such as 1979:2009");
}

RanchRequest Finished(const Arguments& arguments) {
  RanchRequest ranch = arguments.ranch;
  if (!arguments.center.empty()) ranch.center = Place("center", arguments.center);
  for (const std::string& port : arguments.ports) ranch.port_places.push_back(Place("port", port));
  for (const std::string& sea : arguments.sea) ranch.sea.push_back(SeaLayer(sea));
  if (!arguments.years.empty()) ranch.archive.years = Years("years", arguments.years);
  if (!arguments.evaluation_years.empty()) {
    ranch.archive.evaluation_years = Years("evaluation-years", arguments.evaluation_years);
  }
  const auto [width, height] = Pair("size", arguments.size, 'x', "WIDTHxHEIGHT in cells");
  const auto whole = [&](double side) {
    if (side >= 2.0 && side <= kMaxSide && side == std::floor(side)) {
      return static_cast<std::int32_t>(side);
    }
    throw InputError("size: got '" + arguments.size + "', expected whole numbers in [2, " +
                     std::to_string(kMaxSide) + "]");
  };
  ranch.width = whole(width);
  ranch.height = whole(height);
  ranch.cell_size_m = Metres(arguments.cell);
  // The placement kExplicit needs sites, which only a scenario file contains.
  constexpr int kDrawnPlacements = 3;
  ranch.placement = Named<DevicePlacement>("layout", arguments.layout, kDrawnPlacements);
  ranch.reduction = Named<RingReduction>("rings", arguments.rings, kRingReductionCount);
  if (!arguments.start.empty()) ranch.start = ParseUtc("start", arguments.start);
  if (!arguments.output.empty()) {
    ranch.name = std::filesystem::path(arguments.output).stem().string();
  }
  return ranch;
}

// Rejects --size and --cell if the chart defines other values. A chart in metres has its own size
// and cells.
void RefuseUnused(const Arguments& arguments, const Scenario& made) {
  const RanchRequest asked = Finished(arguments);
  if (arguments.own_size && (made.width != asked.width || made.height != asked.height)) {
    throw InputError("size: got '" + arguments.size +
                     "', expected the chart's own size; omit --size");
  }
  if (arguments.own_cell && made.cell_size_m != asked.cell_size_m) {
    throw InputError("cell: got '" + arguments.cell +
                     "', expected the chart's own value; omit --cell");
  }
}

// Suggests launch arguments: algorithm:=auto for several agents. For one agent, suggests a network
// if a table would be too large, else no arguments, because a table is the default.
std::string Learner(const Scenario& made) {
  if (made.AgentCount() > 1) return " algorithm:=auto";
  const std::uint64_t states = Encoder(made).state_count();
  constexpr std::uint64_t kMax = 100'000'000;
  if (states == 0 || states > kMax) {  // ten floats per state: more than 4 GB
    return " algorithm:=dqn options:=train_interval=4 steps:=1200000";
  }
  return "";
}

// Suggests the command for a training. For a ranch with a position, also suggests the command for a
// rescue plan, which takes only seconds.
std::string NextSteps(const std::string& path, const Scenario& made) {
  const std::string train = "./aquafarm train scenario:=" + path + Learner(made) + "\n";
  if (!made.origin) return "next step: " + train;
  return "next step: ./aquafarm plan " + path +
         " --bulletin FILE   (which ship fetches which device before a storm)\n" + "or: " + train;
}

void Run(const Arguments& arguments) {
  const BuiltRanch ranch = BuildRanch(Finished(arguments));
  for (const std::string& warning : ranch.warnings) {
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  }
  RefuseUnused(arguments, ranch.scenario);
  if (ranch.scenario.width <= 200) {
    std::printf("%s%s\n\n", RenderAscii(ranch.scenario).c_str(), kMapKey);
  }
  for (const std::string& line : ranch.decided) std::printf("%s\n", line.c_str());
  if (!arguments.map.empty()) SaveMap(ToMap(ranch.scenario), arguments.map);
  if (arguments.output.empty()) return;
  internal::WriteFile(arguments.output, ranch.yaml);
  std::printf("written: %s\n%s", arguments.output.c_str(),
              NextSteps(arguments.output, ranch.scenario).c_str());
}

void AddPlaceOptions(CLI::App& app, Arguments& arguments) {
  RanchRequest& ranch = arguments.ranch;
  app.add_option("--chart", ranch.chart,
                 "GeoJSON coast, map_server YAML or ASCII grid of heights; empty: open sea");
  app.add_option("--center", arguments.center, "LATITUDE,LONGITUDE of the ranch's middle");
  app.add_option("--size", arguments.size, "WIDTHxHEIGHT in cells");
  app.add_option("--cell", arguments.cell, "side of a cell, such as 200m or 0.2km");
  app.add_option("--sea-level", ranch.sea_level,
                 "height of the sea surface in an ASCII grid; higher cells are land");
}

void AddStormOptions(CLI::App& app, Arguments& arguments) {
  RanchRequest& ranch = arguments.ranch;
  CLI::Option* track = app.add_option("--track", ranch.track,
                                      "file with the storm's track; empty: no storm from a file");
  app.add_option("--storm", ranch.storm, "name or number of the storm in --track")->needs(track);
  CLI::Option* years = app.add_option("--years", arguments.years,
                                      "FIRST:LAST, years of the storms that training draws");
  CLI::Option* archive =
      app.add_option("--archive", ranch.archive.files,
                     "files of tracks (CMA, JMA, ATCF, IBTrACS or a storm archive): every episode "
                     "draws one of their storms")
          ->needs(years)
          ->excludes(track);
  years->needs(archive);
  app.add_option(
         "--evaluation-years", arguments.evaluation_years,
         "FIRST:LAST, years of the storms that only evaluation draws; empty: all after --years")
      ->needs(archive);
  app.add_option("--within", ranch.archive.within_km,
                 "max distance in km at which an archived storm passes the ranch's middle")
      ->check(CLI::Range(1.0, 2000.0))
      ->needs(archive);
  app.add_option("--radii", ranch.radii, "file with wind radii, for fixes without radii")
      ->needs(track);
  app.add_option("--forecasts", ranch.forecasts,
                 "bulletins of the storm with forecast points: agents receive these forecasts; the "
                 "storm itself follows --track")
      ->needs(track);
  app.add_option("--rings", arguments.rings,
                 "shape of the wind rings: equal_area (each ring is a circle with the area of its "
                 "four quadrants), largest (a circle with the largest of the four radii) or "
                 "quadrants (unchanged)")
      ->needs(track);
}

void AddRanchOptions(CLI::App& app, Arguments& arguments) {
  RanchRequest& ranch = arguments.ranch;
  std::string kinds;
  for (const std::string& kind : DisasterPresetNames()) kinds += (kinds.empty() ? "" : ", ") + kind;
  app.add_option(
      "--disaster", ranch.disasters,
      "another disaster as KIND:KEY=NUMBER,… such as wave:height_m=4,radius_km=5; kinds: " + kinds);
  app.add_option("--ports", ranch.ports,
                 "number of ports, spread along the shore; without a shore, at the edge")
      ->check(CLI::Range(1, 256));
  app.add_option(
      "--port", arguments.ports,
      "LATITUDE,LONGITUDE of a port, which is put on the nearest shore; may be repeated");
  app.add_option("--devices", ranch.devices, "number of devices")->check(CLI::Range(1, 1000));
  app.add_option("--layout", arguments.layout, "layout of the devices: uniform, linear or random");
  app.add_option("--ships", ranch.ships, "number of rescue squads")->check(CLI::Range(1, 64));
  app.add_option("--speed", ranch.speed_kn, "speed in knots of a ship with a device in tow")
      ->check(CLI::Range(0.1, 60.0));
  app.add_option("--step", ranch.step_s, "seconds per step, instead of --speed");
  app.add_option("--lead", ranch.lead_h,
                 "hours from the start until the widest ring reaches the ranch")
      ->check(CLI::Range(0.0, 240.0))
      ->needs(app.get_option("--track"));
  app.add_option("--start", arguments.start,
                 "UTC of the start, such as 2021-07-24T12:00Z, instead of --lead");
  app.add_option("--seed", ranch.seed, "seed of the layout");
}

void AddSeaOptions(CLI::App& app, Arguments& arguments) {
  RanchRequest& ranch = arguments.ranch;
  CLI::Option* sea = app.add_option("--sea", arguments.sea,
                                    "NAME=FILE:VARIABLE of a netCDF field; may be repeated");
  app.add_option("--sea-depth", ranch.sea_depth_m,
                 "depth of the fields of --sea, in metres below the surface");
  app.add_option("--value", ranch.value,
                 "value of each device, as an expression of the fields of --sea, such as "
                 "'100 - 2 * warmth'");
  app.add_option("--sea-risk", ranch.sea_risk,
                 "risk of each cell, as an expression of the fields of --sea, such as "
                 "'warmth > 28 ? -8 : 0'")
      ->needs(sea);
  app.add_option("--notices", ranch.notices,
                 "JSON file of warnings or anchorage forecasts; the output lists those in force "
                 "during the episode, or all if the episode has no date");
  app.add_option("--write-map", arguments.map, "write the chart for map_server to this .yaml");
  app.add_option("-o,--output", arguments.output,
                 "scenario file to write; empty: no scenario file is written");
}

int Main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app(
      "Makes a ranch from a chart, a position and a storm. Shows the ranch if it is at most 200 "
      "cells wide, and lists the chosen defaults.",
      "aquafarm scenario");
  app.footer("exit codes: 0 made, 2 bad argument or file, 3 not written");
  app.option_defaults()->always_capture_default();
  AddPlaceOptions(app, arguments);
  AddStormOptions(app, arguments);
  AddRanchOptions(app, arguments);
  AddSeaOptions(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    arguments.own_size = app.count("--size") > 0;
    arguments.own_cell = app.count("--cell") > 0;
    Run(arguments);
    return 0;
  } catch (const internal::WriteError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}

}  // namespace
}  // namespace aquafarm

int main(int argc, char** argv) { return aquafarm::Main(argc, argv); }
