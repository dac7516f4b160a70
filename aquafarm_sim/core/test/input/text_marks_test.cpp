// SPDX-License-Identifier: BSD-3-Clause
// Readers of text files ignore a byte order mark and accept DOS line ends.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <functional>

#include "aquafarm/charts/ascii_grid.h"
#include "aquafarm/charts/coast.h"
#include "aquafarm/charts/map_file.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/storms/notices.h"
#include "storm_samples.h"

namespace aquafarm {
namespace {

std::string Tracks(const std::string& text) {
  const StormFile file = ParseStormFile(text, "x");
  std::string said(ToString(file.format));
  for (const std::string& warning : file.warnings) said += "\n" + warning;
  for (const StormTrack& track : file.tracks) {
    said += "\n" + track.id + " " + track.name + " " + std::to_string(track.line);
    for (const StormFix& fix : track.fixes) {
      said += "\n" + std::to_string(fix.time) + " " + std::to_string(fix.position.longitude) + " " +
              std::to_string(fix.rings.size()) + " " + std::to_string(fix.landfall);
    }
  }
  return said;
}

std::string Notices(const std::string& text) {
  std::string said;
  for (const Notice& notice : ParseNotices(text, "x").notices) said += Describe(notice) + "\n";
  return said;
}

std::string Polygons(const std::string& text) {
  const GeoFrame frame({29.9966, 121.9957}, 964.6);
  return std::to_string(ShareOfLand(ParseCoast(text, "x"), frame, 12, 8).sum());
}

std::string Heights(const std::string& text) {
  return std::to_string(ParseAsciiGrid(text, "x").value(1, 2));
}

// Reads a map from the text of its YAML file or of its image.
std::string Map(const std::string& text) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("marks." + std::to_string(getpid()));
  fs::create_directories(folder);
  const bool picture = text.compare(0, 1, "P") == 0;
  std::ofstream(folder / "m.pgm", std::ios::binary) << (picture ? text : Sample("chart.pgm"));
  std::ofstream(folder / "m.yaml", std::ios::binary)
      << (picture ? "image: m.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\n"
                    "occupied_thresh: 0.65\nfree_thresh: 0.2\n"
                  : text);
  const MapFile map = LoadMap((folder / "m.yaml").string());
  fs::remove_all(folder);
  std::string said = std::to_string(map.cell_size_m);
  for (Eigen::Index i = 0; i < map.occupancy.size(); ++i) {
    said += " " + std::to_string(map.occupancy.data()[i]);
  }
  return said;
}

std::string Hash(const std::string& text) { return std::to_string(ParseScenario(text, "x").hash); }

struct Reader {
  const char* name;
  const char* sample;  ///< file in test/data
  std::function<std::string(const std::string& text)> read;
  bool may_be_marked{true};
};
void PrintTo(const Reader& reader, std::ostream* out) { *out << reader.name; }

class TextFiles : public testing::TestWithParam<Reader> {};

TEST_P(TextFiles, MayHaveAByteOrderMarkAndLinesOfDos) {
  const std::string mark = "\xEF\xBB\xBF";
  std::string plain = Sample(GetParam().sample);
  if (plain.compare(0, 3, mark) == 0) plain.erase(0, 3);
  plain.erase(std::remove(plain.begin(), plain.end(), '\r'), plain.end());
  std::string dos;
  for (const char c : plain) dos += c == '\n' ? std::string("\r\n") : std::string{c};
  const std::string said = GetParam().read(plain);
  EXPECT_EQ(GetParam().read(dos), said);
  if (!GetParam().may_be_marked) return;  // the first bytes identify an image
  EXPECT_EQ(GetParam().read(mark + plain), said);
  EXPECT_EQ(GetParam().read(mark + dos), said);
}

INSTANTIATE_TEST_SUITE_P(All, TextFiles,
                         testing::Values(Reader{"Cma", "cma.txt", Tracks},
                                         Reader{"Jma", "jma.txt", Tracks},
                                         Reader{"Atcf", "atcf.dat", Tracks},
                                         Reader{"Ibtracs", "ibtracs.csv", Tracks},
                                         Reader{"Bulletin", "bulletin.json", Tracks},
                                         Reader{"Zhejiang", "zhejiang.js", Tracks},
                                         Reader{"WeatherService", "weather_service.json", Tracks},
                                         Reader{"Warnings", "warning.json", Notices},
                                         Reader{"Anchorages", "anchorage.json", Notices},
                                         Reader{"GeoJson", "coast.json", Polygons},
                                         Reader{"AsciiGrid", "heights.asc", Heights},
                                         Reader{"ValueBeforeName", "heights.tt2", Heights},
                                         Reader{"MapYaml", "../fuzz_map_yaml/trinary.yaml", Map},
                                         Reader{"PlainPgm", "chart.pgm", Map, false},
                                         Reader{"Scenario", "../../../scenarios/paper.yaml", Hash}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace aquafarm
