// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>

#include "aquafarm_viz/draw/image.h"
#include "aquafarm_viz/markers/markers.h"
#include "aquafarm_viz/scene/values.h"
#include "fixture.h"

namespace aquafarm_viz {
namespace {

// Draws frames of an episode at 640 x 640. The disaster, the ship and the text change in each
// frame.
void BM_Frame(benchmark::State& bench) {
  cv::setNumThreads(1);
  const int side = static_cast<int>(bench.range(0));
  const auto spec = test::MakeSpec(side);
  auto state = test::MakeState(side);
  Trail trail;
  FarmPainter painter({640, 640});
  aquafarm_msgs::TrainingStatus training;
  training.algorithm = "q_learning";
  for (auto _ : bench) {
    ++state.step;
    auto& disaster = state.disasters.front();
    disaster.x = static_cast<float>(state.step % 100) * 0.01F * static_cast<float>(side);
    state.ships.front().x = static_cast<int>(state.step) % side;
    trail.Update(state);
    benchmark::DoNotOptimize(painter.Draw(spec, state, {&trail, &training}).data);
  }
  bench.SetItemsProcessed(bench.iterations());
}
BENCHMARK(BM_Frame)->Arg(10)->Arg(25)->Arg(100)->Arg(500)->Unit(benchmark::kMicrosecond);

void BM_FrameUnderATyphoonThatCoversAll(benchmark::State& bench) {
  cv::setNumThreads(1);
  const auto spec = test::MakeSpec(25);
  auto state = test::MakeState(25);
  state.disasters.front().radii = {15.0F, 30.0F, 60.0F};
  FarmPainter painter({640, 640});
  for (auto _ : bench) benchmark::DoNotOptimize(painter.Draw(spec, state).data);
  bench.SetItemsProcessed(bench.iterations());
}
BENCHMARK(BM_FrameUnderATyphoonThatCoversAll)->Unit(benchmark::kMicrosecond);

// Draws frames with the given layers, the choice of a policy and a route of up to 500 steps.
// @param names layers @param learns true: the map of values changes in each frame
void BM_FrameWith(benchmark::State& bench, const char* names, bool learns = false) {
  cv::setNumThreads(1);
  const int side = static_cast<int>(bench.range(0));
  const auto spec = test::MakeSpec(side);
  auto state = test::MakeState(side);
  Values values = ReadValues(test::MakeCloud(side), spec);
  const auto choice = test::MakeChoice();
  Trail trail;
  Trail route(Trail::kWhole);
  FarmPainter painter({640, 640});
  const Layers layers = ParseLayers(names);
  for (auto _ : bench) {
    state.step = (state.step + 1) % 500;  // restarts the route after 500 steps
    state.ships.front().x = static_cast<int>(state.step) % side;
    if (learns) values.values.front() = static_cast<float>(state.step % 2);
    trail.Update(state);
    route.Update(state);
    benchmark::DoNotOptimize(
        painter.Draw(spec, state, {&trail, nullptr, &route, layers, &values, &choice}).data);
  }
  bench.SetItemsProcessed(bench.iterations());
}
#define SIDES Arg(10)->Arg(25)->Arg(100)->Arg(500)->Unit(benchmark::kMicrosecond)
BENCHMARK_CAPTURE(BM_FrameWith, values_and_moves, "trail,risk,values,moves")->SIDES;
BENCHMARK_CAPTURE(BM_FrameWith, values_and_moves_new_each_time, "trail,risk,values,moves", true)
    ->SIDES;
BENCHMARK_CAPTURE(BM_FrameWith, route, "trail,risk,route")->SIDES;
BENCHMARK_CAPTURE(BM_FrameWith, all, "trail,risk,route,values,moves")->SIDES;

void BM_Jpeg(benchmark::State& bench) {
  cv::setNumThreads(1);
  const cv::Mat image = DrawFarm(test::MakeSpec(), test::MakeState(), {640, 640});
  std::vector<std::uint8_t> bytes;
  for (auto _ : bench) cv::imencode(".jpg", image, bytes);
  bench.counters["bytes"] = double(bytes.size());
  bench.SetItemsProcessed(bench.iterations());
}
BENCHMARK(BM_Jpeg)->Unit(benchmark::kMicrosecond);

void BM_Markers(benchmark::State& bench) {
  const auto spec = test::MakeSpec();
  const auto state = test::MakeState();
  for (auto _ : bench) benchmark::DoNotOptimize(StateMarkers(spec, state).markers.data());
  bench.SetItemsProcessed(bench.iterations());
}
BENCHMARK(BM_Markers)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace aquafarm_viz

BENCHMARK_MAIN();
