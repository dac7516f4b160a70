// SPDX-License-Identifier: BSD-3-Clause
// Measures the time to read published data: one year of CMA best tracks, and a field of the sea
// that is interpolated to the cells of a farm.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "aquafarm/sea/sea_field.h"
#include "aquafarm/tracks/reader.h"
#include "metric_reporter.h"
#include "write_sea.h"

namespace aquafarm {
namespace {

// Returns a CMA file with 40 storms of 35 points each, as in the busiest years.
std::string YearOfCma() {
  constexpr int kStorms = 40;
  constexpr int kPoints = 35;
  std::string text;
  char line[100];
  for (int storm = 1; storm <= kStorms; ++storm) {
    std::snprintf(line, sizeof(line), "66666 21%02d   %2d %04d 21%02d 0 6 Storm%-20d 20220410\n",
                  storm, kPoints, storm, storm, storm);
    text += line;
    for (int i = 0; i < kPoints; ++i) {
      std::snprintf(line, sizeof(line), "202107%02d%02d 4 %3d %4d %4d      35\n", 1 + i / 4,
                    i % 4 * 6, 150 + 2 * i, 1500 - 5 * i, 960 + i);
      text += line;
    }
  }
  return text;
}

void CmaYear(benchmark::State& state) {
  const std::string text = YearOfCma();
  for (auto _ : state) benchmark::DoNotOptimize(ParseStormFile(text, "year"));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(CmaYear);

void SeaLayer(benchmark::State& state) {
  namespace fs = std::filesystem;
  const fs::path path = fs::temp_directory_path() / ("bench." + std::to_string(getpid()) + ".nc");
  WriteSeaOfTenMegabytes(path.string());
  const GeoFrame frame({30.1, 122.1}, 200.0);
  for (auto _ : state) {
    const SeaField field = LoadSeaField(path.string(), {"t", {}, 0.0}, frame, 500, 500);
    benchmark::DoNotOptimize(ToLayer(field, frame, 500, 500));
  }
  state.SetItemsProcessed(state.iterations());
  fs::remove(path);
}
BENCHMARK(SeaLayer);

}  // namespace
}  // namespace aquafarm

int main(int argc, char** argv) {
  aquafarm::bench::MetricReporter reporter;
  if (!aquafarm::bench::RunMedians(argc, argv, reporter)) return 2;
  aquafarm::bench::PrintMetric("cma_year", 1000.0 / reporter.median("CmaYear"), "ms");
  aquafarm::bench::PrintMetric("sea_layer", 1000.0 / reporter.median("SeaLayer"), "ms");
  return 0;
}
