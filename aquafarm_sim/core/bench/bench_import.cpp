// SPDX-License-Identifier: BSD-3-Clause
// Reading what authorities publish: a year of CMA best tracks.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <string>

#include "aquafarm/hazard_file.h"
#include "metric_reporter.h"

namespace aquafarm {
namespace {

// As many storms and points as the busiest years have: 40 of 35.
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
  for (auto _ : state) benchmark::DoNotOptimize(ParseHazardFile(text, "year"));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(CmaYear);

}  // namespace
}  // namespace aquafarm

int main(int argc, char** argv) {
  aquafarm::bench::MetricReporter reporter;
  if (!aquafarm::bench::RunMedians(argc, argv, reporter)) return 2;
  aquafarm::bench::PrintMetric("cma_year", 1000.0 / reporter.median("CmaYear"), "ms");
  return 0;
}
