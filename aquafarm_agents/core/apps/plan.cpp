// SPDX-License-Identifier: BSD-3-Clause
// Plans which ship fetches which device before a storm, and computes the probability that each
// device is saved. Works without ROS.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "app.h"
#include "aquafarm/agents/base/exit_code.h"
#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/base/text.h"
#include "aquafarm/agents/rescue/plan_report.h"
#include "aquafarm/ranch/ranch_builder.h"
#include "rescue/case_parts.h"

namespace aquafarm::agents {
namespace {

struct Arguments {
  std::string ranch;
  std::string coast;
  std::string place;
  std::vector<std::string> ports;
  std::int32_t size{40};
  double cell_m{500.0};
  std::string at;
  std::string depart{"+0h"};
  double utc_offset_h{};
  std::string json;
  std::string command;
  std::string scenarios{ScenarioFolder()};
  RescueRequest request;
  std::vector<RescueWarning> warnings;  // about the chart of the ranch
};

GeoPoint Place(const std::string& option, const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) {
    throw InputError(option + ": got '" + text + "', expected LATITUDE,LONGITUDE in degrees");
  }
  const GeoPoint place{ParseNumber(text.substr(0, comma), option),
                       ParseNumber(text.substr(comma + 1), option)};
  if (std::abs(place.latitude) <= 90.0 && std::abs(place.longitude) <= 360.0) return place;
  throw InputError(option + ": got '" + text +
                   "', expected a latitude in [-90, 90] and a longitude in [-360, 360]");
}

// Returns the seconds of "+6h", "6h" or "90min". Throws InputError for other texts.
double Seconds(const std::string& option, const std::string& text) {
  const std::size_t from = !text.empty() && text[0] == '+' ? 1 : 0;
  const std::size_t unit = text.find_first_not_of("0123456789.", from);
  const std::string word = unit == std::string::npos ? "" : text.substr(unit);
  if (word != "h" && word != "min") {
    throw InputError(option + ": got '" + text + "', expected a time such as +6h or +90min");
  }
  return ParseNumber(text.substr(from, unit - from), option) * (word == "h" ? 3600.0 : 60.0);
}

std::shared_ptr<const Scenario> LoadRanch(Arguments& arguments) {
  if (!arguments.ranch.empty()) {
    if (!arguments.coast.empty() || !arguments.place.empty() || !arguments.ports.empty()) {
      throw InputError("ranch: got " + arguments.ranch +
                       " with --coast, --place or --ports, expected either a ranch or a chart: the "
                       "ranch has its own coast and ports; leave out one of them");
    }
    return std::make_shared<const Scenario>(FindScenario(arguments.ranch, arguments.scenarios));
  }
  if (arguments.coast.empty() || arguments.place.empty() || arguments.request.devices.empty()) {
    throw InputError("ranch: got none, expected RANCH.yaml, or --coast, --place and --devices");
  }
  RanchRequest ranch;
  ranch.name = "ranch";
  ranch.chart = arguments.coast;
  ranch.center = Place("place", arguments.place);
  ranch.width = ranch.height = arguments.size;
  ranch.cell_size_m = arguments.cell_m;
  ranch.devices = 1;
  ranch.exact_ports = true;
  for (const std::string& port : arguments.ports) ranch.port_places.push_back(Place("port", port));
  const BuiltRanch built = BuildRanch(ranch);
  for (const std::string& warning : built.warnings) {
    arguments.warnings.push_back({"ranch_changed", "warning", warning,
                                  "Check the positions given for the ranch and its ports."});
  }
  return std::make_shared<const Scenario>(built.scenario);
}

// With --coast, adds a note with the chosen ports if no ports were given.
void NoteChosenPorts(const Arguments& arguments, RescueCase& rescue) {
  if (arguments.coast.empty() || !arguments.ports.empty()) return;
  std::string places;
  for (const RescuePort& port : rescue.problem.ports) {
    const GeoPoint place = rescue.frame.ToGeo(port.cell.x, port.cell.y);
    places += (places.empty() ? "" : "; ") + port.name + " at " + Short(place.latitude, 4) + "," +
              Short(place.longitude, 4);
  }
  rescue.warnings.push_back(
      {"ports_chosen", "note",
       "No port was given: the ports are chosen on the shore, " + places + ".",
       "Give your own, each as --ports LATITUDE,LONGITUDE."});
}

std::vector<std::pair<std::string, std::string>> Inputs(const Arguments& arguments) {
  std::vector<std::pair<std::string, std::string>> inputs;
  const auto add = [&](const char* role, const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path, ignored)) inputs.emplace_back(role, path);
  };
  add("ranch", arguments.ranch);
  add("coast", arguments.coast);
  add("bulletin", arguments.request.bulletin);
  add("storm", arguments.request.storm);
  add("devices", arguments.request.devices);
  add("ships", arguments.request.ships_file);
  return inputs;
}

int Run(Arguments& arguments) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point began = Clock::now();
  RescueRequest& request = arguments.request;
  request.depart_s = Seconds("depart", arguments.depart);
  if (!arguments.at.empty()) request.at = ParseUtc("at", arguments.at);
  request.now = std::time(nullptr);
  RescueCase rescue = MakeRescueCase(LoadRanch(arguments), request);
  rescue.warnings.insert(rescue.warnings.end(), arguments.warnings.begin(),
                         arguments.warnings.end());
  NoteChosenPorts(arguments, rescue);
  const Ensemble ensemble(rescue.forecast, rescue.ensemble, rescue.Sites());
  const PlanReport report = MakeReport(rescue, ensemble);
  std::fputs(ToText(rescue, report).c_str(), stdout);
  if (!arguments.json.empty()) {
    PlanProvenance provenance;
    provenance.command = arguments.command;
    provenance.computed_at = *request.now;
    provenance.compute_s = std::chrono::duration<double>(Clock::now() - began).count();
    provenance.inputs = Inputs(arguments);
    WriteFileAtomically(arguments.json, ToJson(rescue, ensemble, report, provenance));
    std::printf("written: %s\n", arguments.json.c_str());
  }
  return static_cast<int>(report.ExitCode());
}

void AddOptions(CLI::App& app, Arguments& arguments) {
  RescueRequest& request = arguments.request;
  app.option_defaults()->always_capture_default();
  app.add_option("ranch", arguments.ranch, "scenario file or name of a shipped scenario");
  app.add_option("--coast", arguments.coast, "coast (GeoJSON) or chart, instead of a scenario");
  app.add_option("--place", arguments.place, "LATITUDE,LONGITUDE of the ranch, with --coast");
  app.add_option("--ports", arguments.ports, "LATITUDE,LONGITUDE of ports, with --coast");
  app.add_option("--size", arguments.size, "cells per side, with --coast")
      ->check(CLI::Range(2, 400));
  app.add_option("--cell", arguments.cell_m, "metres per cell, with --coast")
      ->check(CLI::Range(10.0, 10000.0));
  app.add_option("--bulletin", request.bulletin, "bulletins of the storm with its forecast");
  app.add_option("--storm", request.storm,
                 "file of a recorded track; the plan starts at --at (a hindcast)");
  app.add_option("--storm-name", request.storm_name,
                 "id or name of the storm in the file of --storm, if it has several");
  app.add_option("--at", arguments.at,
                 "start of the plan, UTC such as 2021-07-24T12:00Z; default: now, or the newest "
                 "report of an old bulletin");
  app.add_option("--devices", request.devices,
                 "CSV: name,latitude,longitude,kind,value[,damaged]; default: those of the ranch");
  app.add_option("--ships-file", request.ships_file,
                 "CSV: name,latitude,longitude[,speed_kn,capacity,ready]");
  app.add_option("--ships", request.ships, "number of ships, spread over the ports")
      ->check(CLI::Range(0, 64));
  app.add_option("--speed", request.speed_kn, "speed of the ships in knots")
      ->check(CLI::Range(0.1, 60.0));
  app.add_option("--capacity", request.capacity, "max devices aboard a ship")
      ->check(CLI::Range(1, 100));
  app.add_option("--depart", arguments.depart, "earliest departure after the start, such as +6h");
  app.add_option("--abort-wind", request.abort_wind_kt, "knots of wind at which ships stop")
      ->check(CLI::Range(10.0, 100.0));
  app.add_option("--members", request.members, "number of possible storms")
      ->check(CLI::Range(10, 20000));
  app.add_option("--seed", request.seed, "seed of the possible storms");
  app.add_option(
         "--risk-averse", request.risk_averse,
         "share of the worst cases whose mean loss is minimized, such as 0.05; 0: the mean of all")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--currency", request.currency, "currency of the devices' values, such as CNY");
  app.add_option("--utc-offset", arguments.utc_offset_h,
                 "hours of the local time ahead of UTC; default: by longitude")
      ->check(CLI::Range(-14.0, 14.0));
  app.add_option("--json", arguments.json, "write the plan to this JSON file");
  app.add_option("--scenarios", arguments.scenarios, "folder of the shipped scenarios");
}

int Main(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) arguments.command += std::string(" ") + argv[i];
  arguments.command = "aquafarm_plan" + arguments.command;
  CLI::App app("Plans which ship fetches which device before a storm comes.", "aquafarm_plan");
  app.footer(
      "exit codes: 0 ships leave, 2 bad argument or file, 3 cannot write, 10 nothing can be "
      "saved or no trip saves more than it costs,\n"
      "11 the storm reaches no device and no route of a ship in the known time, 12 unknown "
      "whether it does,\n"
      "13 the bulletin is 12 hours old or older");
  AddOptions(app, arguments);
  return RunWithExitCodes(app, [&] {
    app.parse(argc, argv);
    if (app.get_option("--utc-offset")->count() > 0) {
      arguments.request.utc_offset_h = arguments.utc_offset_h;
    }
    return Run(arguments);
  });
}

}  // namespace
}  // namespace aquafarm::agents

int main(int argc, char** argv) { return aquafarm::agents::Main(argc, argv); }
