// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/scenario/scenario_yaml.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "aquafarm/base/hash.h"
#include "aquafarm/scenario/validate.h"
#include "base/time.h"
#include "scenario/yaml_reader.h"
#include "scenario/yaml_writer.h"

namespace aquafarm {
namespace internal {

void YamlWriter::Line(const char* key, const std::string& value) {
  text_.append(dash_ ? depth_ - 2 : depth_, ' ');
  if (dash_) text_ += "- ";
  dash_ = false;
  text_ += key;
  text_ += value.empty() ? ":" : ": " + value;
  text_ += '\n';
}

void YamlWriter::Block(const char* key, const std::string& lines) {
  Line(key, "|");
  std::istringstream text(lines);
  for (std::string line; std::getline(text, line);) {
    text_.append(depth_, ' ');
    text_ += "  " + line + "\n";
  }
}

std::string YamlWriter::Value(const std::string& value) {
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') text += '\\';
    if (c == '\n') {
      text += "\\n";
    } else {
      text += c;
    }
  }
  return text + '"';
}

float ToStep(std::int64_t time, const WorldFrame* frame, const std::string& path) {
  if (frame == nullptr || !frame->start_time) {
    throw FieldError(Join(path, "time"), "needs time.start, which is missing");
  }
  return static_cast<float>(static_cast<double>(time - *frame->start_time) /
                            frame->step_duration_s);
}

void Resolve(const GeoFix& fix, const WorldFrame* frame, const std::string& path,
             Waypoint& waypoint) {
  if (frame == nullptr || !frame->grid) {
    throw FieldError(Join(path, "latitude"), "needs grid.origin, which is missing");
  }
  waypoint.step = ToStep(fix.time, frame, path);
  if (!frame->grid->Faces(fix.point)) {
    throw FieldError(path,
                     "got a position more than 60 degrees from grid.origin, expected one within 60 "
                     "degrees");
  }
  const std::array<double, 2> place = frame->grid->ToGrid(fix.point);
  waypoint.x = static_cast<float>(place[0]);
  waypoint.y = static_cast<float>(place[1]);
  const auto cells = [frame](float km) {
    return static_cast<float>(km * 1000.0 / frame->cell_size_m);
  };
  waypoint.radii.clear();
  for (const float radius : fix.radii_km) waypoint.radii.push_back(cells(radius));
  for (const QuadrantRadii& ring : fix.quadrants_km) {
    waypoint.quadrants.push_back({cells(ring[0]), cells(ring[1]), cells(ring[2]), cells(ring[3])});
  }
  if (!waypoint.quadrants.empty()) waypoint.radii = Largest(waypoint.quadrants);
}

}  // namespace internal

namespace {

constexpr std::size_t kMaxFileBytes = 4U << 20U;  // a sea of kMaxSeaValues has about 2 MiB

// @param notices receives a line for each key that is given by its old name
Scenario Parse(const std::string& text, const std::string& origin_name,
               std::vector<std::string>& notices) {
  if (text.size() > kMaxFileBytes) {
    throw InputError(origin_name + ": got more than " + std::to_string(kMaxFileBytes) +
                     " bytes, expected a scenario file");
  }
  Scenario scenario;
  notices = internal::ReadYaml(
      text, origin_name, "a scenario",
      [&](internal::YamlReader& reader) {
        internal::WorldFrame frame;
        frame.folder = std::filesystem::path(origin_name).parent_path().string();
        internal::VisitScenario(reader, scenario, frame);
      },
      [&scenario] { ValidateScenario(scenario); });
  scenario.hash = HashScenario(scenario);
  return scenario;
}

}  // namespace

Scenario LoadScenario(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text(kMaxFileBytes + 1, '\0');
  if (file) file.read(&text[0], static_cast<std::streamsize>(text.size()));
  if (!file.eof() && file.fail()) {
    throw InputError(path +
                     ": cannot read: " + (errno != 0 ? std::strerror(errno) : "not a plain file"));
  }
  text.resize(static_cast<std::size_t>(file.gcount()));
  std::vector<std::string> notices;
  Scenario scenario = Parse(text, path, notices);
  for (const std::string& line : notices) std::cerr << line << '\n';
  return scenario;
}

Scenario ParseScenario(const std::string& text, const std::string& origin_name) {
  std::vector<std::string> unused;
  return Parse(text, origin_name, unused);
}

std::string ToYaml(const Scenario& scenario, bool old_names) {
  internal::YamlWriter writer(old_names);
  internal::WorldFrame unused;
  internal::VisitScenario(writer, scenario, unused);
  return writer.text();
}

std::uint64_t HashScenario(const Scenario& scenario) {
  Scenario rules = scenario;
  rules.name.clear();
  rules.description.clear();
  for (DisasterSpec& disaster : rules.disasters) {
    disaster.ring_winds_kt.clear();
    disaster.name.clear();
    for (Waypoint& point : disaster.track) point.wind_mps.reset();
    for (IssuedForecast& forecast : disaster.forecasts) {
      for (Waypoint& point : forecast.points) point.wind_mps.reset();
    }
  }
  // Uses the key names of version 0.1.0, so that hashes in bags and checkpoints of that version
  // remain valid.
  return HashBytes(ToYaml(rules, /*old_names=*/true));
}

std::int64_t ParseUtc(const std::string& name, const std::string& text) {
  const auto utc = internal::ParseDateTime(text, 0);
  // Parses with two default zones. The results differ if the text contains no zone.
  if (utc && utc == internal::ParseDateTime(text, 3600)) return *utc;
  throw InputError(name + ": got '" + text +
                   "', expected a UTC time such as 2021-07-24T12:00Z, or a local one with its "
                   "zone, such as 2021-07-24T20:00+08:00");
}

}  // namespace aquafarm
