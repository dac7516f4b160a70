// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Prints the table of Google Benchmark, and one line `metric value unit` per metric, so that runs
/// can be compared.

#include <benchmark/benchmark.h>

#include <cstdio>
#include <map>
#include <string>
#include <vector>

namespace aquafarm::bench {

/// Prints the default table and collects the items per second of each benchmark: the median over
/// its repetitions.
class MetricReporter : public benchmark::ConsoleReporter {
 public:
  MetricReporter() : ConsoleReporter(OO_None) {}
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      const auto rate = run.counters.find("items_per_second");
      if (run.aggregate_name == "median" && rate != run.counters.end()) {
        median_[run.run_name.function_name + Argument(run.run_name.args)] = rate->second;
      }
    }
  }
  /// Returns the items per second of the benchmark `NAME` or `NAME/ARGUMENT`; 0 if it had fewer
  /// than two repetitions.
  double median(const std::string& name) const {
    const auto found = median_.find(name);
    return found == median_.end() ? 0.0 : found->second;
  }

 private:
  static std::string Argument(const std::string& args) { return args.empty() ? "" : "/" + args; }
  std::map<std::string, double> median_;
};

/// Runs the benchmarks, by default with five repetitions. Options in `argv` override the defaults
/// that this function sets.
/// @returns false if an argument is not recognized
inline bool RunMedians(int argc, char** argv, MetricReporter& reporter) {
  std::vector<char*> arguments(argv, argv + argc);
  std::string repetitions = "--benchmark_repetitions=5";
  std::string aggregates = "--benchmark_report_aggregates_only=true";
  std::string interleave = "--benchmark_enable_random_interleaving=true";
  std::string time = "--benchmark_min_time=0.2";
  arguments.insert(arguments.begin() + 1,  // the last occurrence of a flag takes precedence
                   {repetitions.data(), aggregates.data(), interleave.data(), time.data()});
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return false;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return true;
}

inline void PrintMetric(const std::string& name, double value, const char* unit) {
  std::printf("%s %.6g %s\n", name.c_str(), value, unit);
}

}  // namespace aquafarm::bench
