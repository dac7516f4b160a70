// SPDX-License-Identifier: BSD-3-Clause
// Compares rescue plans with simulated and recorded storms: how often the promised chances come
// true, and which value the plans save. docs/results/rescue_plans.md has the results. Works without
// ROS.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app.h"
#include "aquafarm/agents/base/exit_code.h"
#include "aquafarm/agents/base/storage.h"
#include "aquafarm/tracks/reader.h"
#include "aquafarm/tracks/track.h"
#include "rescue/plan_trials.h"

namespace aquafarm::agents {
namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
  std::string ranch{"zhoushan_storms"};
  std::string archive;
  std::string scenarios{ScenarioFolder()};
  std::string output;
  std::int32_t storms{2000};
  std::int32_t bulletins{20};
  std::int32_t scoring{2000};
  std::int32_t first_year{2010};
  double within_km{300.0};
  double lead_h{24.0};
  bool reacts{true};
  double error_scale{1.0};
  double position_errors{1.0};
  double wind_errors{1.0};
  double size_errors{1.0};
  TrialOptions trial;
  RescueRequest request;
};

Json Of(const Estimate& estimate) {
  return {{"mean", estimate.mean},
          {"low", estimate.mean - estimate.half},
          {"high", estimate.mean + estimate.half}};
}

Json Of(const PromiseBin& bin) {
  return {{"low", bin.low},
          {"high", bin.high},
          {"count", bin.count},
          {"promised", bin.promised},
          {"kept", Of(bin.kept)}};
}

void Print(const char* name, const PromiseBin& bin) {
  std::printf("  %-6s promised %5.1f %%  kept %5.1f %% +- %4.1f  (%lld devices)\n", name,
              100.0 * bin.promised, 100.0 * bin.kept.mean, 100.0 * bin.kept.half,
              static_cast<long long>(bin.count));
}

// Prints how often promises of 5 to 55 %, and of about 20, 50, 80 and 95 %, were kept. Returns
// these numbers and a reliability diagram with 20 bins.
Json Calibration(const char* title, const std::vector<std::vector<Promise>>& promises,
                 const Groups& tracks) {
  std::printf("%s\n", title);
  const PromiseBin lower = BinOf(promises, 0.05, 0.55, tracks);
  Print("5-55 %", lower);
  constexpr std::array<std::array<double, 3>, 4> kBars{
      {{0.2, 0.15, 0.25}, {0.5, 0.45, 0.55}, {0.8, 0.75, 0.85}, {0.95, 0.925, 0.975}}};
  Json bars = Json::array();
  for (const auto& [wanted, low, high] : kBars) {
    const PromiseBin bin = BinOf(promises, low, high, tracks);
    Print((std::to_string(static_cast<int>(100.0 * wanted + 0.5)) + " %").c_str(), bin);
    bars.push_back(Of(bin));
  }
  Json diagram = Json::array();
  for (int i = 0; i < 20; ++i) {
    diagram.push_back(Of(BinOf(promises, i / 20.0, i == 19 ? 1.01 : (i + 1) / 20.0, tracks)));
  }
  return {{"bars", bars}, {"from_5_to_55", Of(lower)}, {"diagram", diagram}};
}

Json Value(const std::vector<TrialResult>& trials, const Groups& tracks) {
  const auto of = [&](std::size_t policy) {
    std::vector<double> saved;
    saved.reserve(trials.size());
    for (const TrialResult& trial : trials) saved.push_back(trial.saved[policy]);
    return saved;
  };
  const std::vector<double> plan = of(0);
  const std::vector<double> best = of(static_cast<std::size_t>(TrialPolicy::kClairvoyant));
  std::vector<double> promised;
  promised.reserve(trials.size());
  for (const TrialResult& trial : trials) promised.push_back(trial.promised);
  Json rows = Json::array();
  std::printf("value saved; share of the clairvoyant; plan minus this one (95 %% intervals)\n");
  for (std::size_t policy = 0; policy < kTrialPolicyCount; ++policy) {
    const std::vector<double> saved = of(policy);
    if (std::any_of(saved.begin(), saved.end(), [](double one) { return std::isnan(one); })) {
      continue;  // the policy does not support these ships and devices
    }
    std::vector<double> ahead;
    for (std::size_t i = 0; i < plan.size(); ++i) ahead.push_back(plan[i] - saved[i]);
    const Estimate mean = MeanOf(saved, tracks);
    const Estimate share = RatioOf(saved, best, tracks);
    const Estimate by = MeanOf(ahead, tracks);
    const std::string name(ToString(static_cast<TrialPolicy>(policy)));
    std::printf("  %-15s %8.3f +- %.3f   %.4f +- %.4f   %+8.4f +- %.4f\n", name.c_str(), mean.mean,
                mean.half, share.mean, share.half, by.mean, by.half);
    rows.push_back(
        {{"policy", name}, {"saved", Of(mean)}, {"share", Of(share)}, {"plan_ahead", Of(by)}});
  }
  const Estimate claim = MeanOf(promised, tracks);
  const Estimate kept = RatioOf(plan, promised, tracks);
  std::printf("  %-15s %8.3f +- %.3f; saved by promised %.4f +- %.4f\n", "plan promised",
              claim.mean, claim.half, kept.mean, kept.half);
  return {{"policies", rows}, {"promised", Of(claim)}, {"saved_by_promised", Of(kept)}};
}

std::shared_ptr<const Scenario> Load(const Arguments& arguments) {
  return std::make_shared<const Scenario>(FindScenario(arguments.ranch, arguments.scenarios));
}

constexpr std::size_t kMinFixes = 4;  // shorter tracks are not used

std::vector<StormTrack> Tracks(const Arguments& arguments) {
  std::vector<StormTrack> tracks;
  for (const StormTrack& track : LoadStormFile(arguments.archive).tracks) {
    if (track.fixes.size() >= kMinFixes) tracks.push_back(track);
  }
  if (tracks.empty()) {
    throw InputError("archive: got no track with " + std::to_string(kMinFixes) +
                     " or more fixes in " + arguments.archive + "; use another file");
  }
  return tracks;
}

PlanTrials MakeTrials(Arguments& arguments, const std::vector<StormTrack>& tracks) {
  RescueRequest& request = arguments.request;
  request.storm = arguments.archive;
  request.storm_name = tracks.front().id;
  request.at = tracks.front().fixes.front().time;
  ForecastErrors& errors = request.errors;
  errors.scale = arguments.error_scale;
  for (double& one : errors.position_km) one *= arguments.position_errors;
  for (double& one : errors.wind_mps) one *= arguments.wind_errors;
  errors.size_factor *= arguments.size_errors;
  errors.size_report_error *= arguments.size_errors;
  arguments.trial.errors = errors;
  return {Load(arguments), request, BulletinPeriod(arguments.trial)};
}

Json RunStorms(Arguments& arguments) {
  const std::vector<StormTrack> tracks = Tracks(arguments);
  const PlanTrials trials = MakeTrials(arguments, tracks);
  std::vector<TrialResult> results;
  std::vector<std::vector<Promise>> home;
  std::vector<std::vector<Promise>> gales;
  std::vector<std::vector<Promise>> weak;  // as `gales`, but empty if the bulletin has a gale
  Groups groups;
  for (std::int32_t i = 0; i < arguments.storms; ++i) {
    const TrialStorm storm =
        DrawTrial(tracks, trials.place(), arguments.trial, static_cast<std::uint64_t>(i));
    results.push_back(trials.Run(storm, arguments.reacts));
    home.push_back(results.back().home);
    gales.push_back(results.back().gales);
    const bool is_weak = results.back().bulletin_mps < LowestWindOf(StormGrade::kTropicalStorm);
    weak.push_back(is_weak ? results.back().gales : std::vector<Promise>{});
    groups.push_back(results.back().track);
  }
  std::printf("%d storms, errors x %g, %d members\n", arguments.storms, arguments.error_scale,
              arguments.request.members);
  Json data{{"storms", arguments.storms},
            {"error_scale", arguments.error_scale},
            {"members", arguments.request.members},
            {"seed", arguments.trial.seed},
            {"tracks", tracks.size()},
            {"intervals", "95 %, between tracks"}};
  data["home"] = Calibration("the device comes home", home, groups);
  data["gales"] = Calibration("gales reach the device", gales, groups);
  const PromiseBin of_weak = BinOf(weak, 0.05, 0.55, groups);
  std::printf("gales reach the device, bulletin below a gale\n");
  Print("5-55 %", of_weak);
  data["gales_of_weak_bulletins"] = Of(of_weak);
  data["winds_about_bulletin"] = arguments.trial.winds_about_bulletin;
  data["value"] = Value(results, groups);
  return data;
}

Json RunAverse(Arguments& arguments) {
  const std::vector<StormTrack> tracks = Tracks(arguments);
  const PlanTrials trials = MakeTrials(arguments, tracks);
  std::vector<double> gain;
  std::vector<double> mean;
  Groups groups;
  std::int32_t changed = 0;
  for (std::int32_t i = 0; i < arguments.storms; ++i) {
    const TrialStorm storm =
        DrawTrial(tracks, trials.place(), arguments.trial, static_cast<std::uint64_t>(i));
    const AverseResult result = trials.CompareAverse(storm, arguments.scoring);
    groups.push_back(result.track);
    mean.push_back(result.mean);
    gain.push_back(result.mean - result.averse);
    changed += result.mean != result.averse ? 1 : 0;
  }
  const Estimate by = MeanOf(gain, groups);
  std::printf(
      "mean of the worst 5 %% of the losses, %d storms, %d judging members\n"
      "  without --risk-averse %.3f; with it less by %.4f +- %.4f; other plan in %d storms\n",
      arguments.storms, arguments.scoring, MeanOf(mean).mean, by.mean, by.half, changed);
  return {{"storms", arguments.storms},
          {"judges", arguments.scoring},
          {"members", arguments.request.members},
          {"seed", arguments.trial.seed},
          {"tracks", tracks.size()},
          {"intervals", "95 %, between tracks"},
          {"changed", changed},
          {"without", Of(MeanOf(mean, groups))},
          {"gain", Of(by)}};
}

Json BackTest(const Arguments& arguments, const PlanTrials& trials, const StormTrack& track) {
  std::vector<double> promised;
  std::vector<double> saved;
  TrialResult last;
  for (std::int32_t i = 0; i < arguments.bulletins; ++i) {
    const TrialStorm storm = RecordedTrial(track, trials.place(), arguments.trial, arguments.lead_h,
                                           static_cast<std::uint64_t>(i));
    last = trials.Run(storm, false);
    promised.push_back(last.promised);
    saved.push_back(last.saved[0]);
  }
  const double best = last.saved[static_cast<std::size_t>(TrialPolicy::kClairvoyant)];
  std::sort(saved.begin(), saved.end());
  const std::string date = FormatUtc(NearestTime(track, trials.place()).first).substr(0, 10);
  std::printf("| %s | %s | %s | %.0f | %.1f | %.2f | %.2f | %.2f (%.2f to %.2f) | %.2f |\n",
              track.id.c_str(), track.name.c_str(), date.c_str(), last.nearest_km, last.lead_h,
              last.at_risk, MeanOf(promised).mean, MeanOf(saved).mean, saved.front(), saved.back(),
              best);
  return {{"id", track.id},
          {"name", track.name},
          {"nearest", date},
          {"nearest_km", last.nearest_km},
          {"lead_h", last.lead_h},
          {"at_risk", last.at_risk},
          {"promised", MeanOf(promised).mean},
          {"saved", MeanOf(saved).mean},
          {"saved_low", saved.front()},
          {"saved_high", saved.back()},
          {"clairvoyant", best}};
}

Json RunBackTest(Arguments& arguments) {
  arguments.trial.report_share = 0.0;  // CMA best tracks have no radii
  arguments.trial.draws_size = false;
  const std::vector<StormTrack> tracks = LoadStormFile(arguments.archive).tracks;
  const PlanTrials trials = MakeTrials(arguments, tracks);
  std::printf(
      "| storm | name | nearest | km | lead [h] | at risk | promised | saved | "
      "clairvoyant |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  Json rows = Json::array();
  for (const StormTrack& track : tracks) {
    const auto [time, km] = NearestTime(track, trials.place());
    const bool is_late = std::stoi(FormatUtc(time).substr(0, 4)) >= arguments.first_year;
    if (is_late && km <= arguments.within_km) rows.push_back(BackTest(arguments, trials, track));
  }
  return {{"bulletins", arguments.bulletins}, {"lead_h", arguments.lead_h}, {"storms", rows}};
}

void AddOptions(CLI::App& app, Arguments& arguments) {
  app.option_defaults()->always_capture_default();
  app.add_option("--ranch", arguments.ranch, "scenario file or name of a shipped scenario");
  app.add_option("--archive", arguments.archive,
                 "file of tracks; default: the archive of the Zhoushan scenarios");
  app.add_option("--scenarios", arguments.scenarios, "folder of the shipped scenarios");
  app.add_option("--devices", arguments.request.devices,
                 "CSV file of the devices, as for aquafarm_plan");
  app.add_option("--ships", arguments.request.ships, "number of ships")->check(CLI::Range(1, 16));
  app.add_option("--speed", arguments.request.speed_kn, "speed of the ships in knots")
      ->check(CLI::Range(0.1, 60.0));
  app.add_option("--members", arguments.request.members, "number of members of the plan's ensemble")
      ->check(CLI::Range(10, 20000));
  app.add_option("--storms", arguments.storms, "number of simulated storms")
      ->check(CLI::Range(2, 1000000));
  app.add_option("--errors", arguments.error_scale, "factor of all errors of the forecast")
      ->check(CLI::Range(0.0, 5.0));
  app.add_option("--position-errors", arguments.position_errors,
                 "factor of the errors of positions")
      ->check(CLI::Range(0.0, 5.0));
  app.add_option("--wind-errors", arguments.wind_errors, "factor of the errors of winds")
      ->check(CLI::Range(0.0, 5.0));
  app.add_option("--size-errors", arguments.size_errors, "factor of the errors of radii")
      ->check(CLI::Range(0.0, 5.0));
  app.add_option("--seed", arguments.trial.seed, "seed of the simulated storms");
  app.add_option("--min-lead", arguments.trial.min_lead_h, "min hours before the closest approach");
  app.add_option("--max-lead", arguments.trial.max_lead_h, "max hours before the closest approach");
  app.add_option("--every", arguments.trial.bulletin_h, "hours between two bulletins of a storm")
      ->check(CLI::Range(0.5, 120.0));
  app.add_option("--lead", arguments.lead_h, "back_test: hours before the closest approach");
  app.add_option("--bulletins", arguments.bulletins,
                 "back_test: number of bulletins drawn for each storm")
      ->check(CLI::Range(1, 10000));
  app.add_option("--since", arguments.first_year, "back_test: first year");
  app.add_option("--within", arguments.within_km, "back_test: max distance of the storms [km]");
  app.add_flag("--winds-about-bulletin", arguments.trial.winds_about_bulletin,
               "storms: the true winds are the bulletin's with an error, instead of the reverse");
  app.add_flag("!--no-reacting", arguments.reacts,
               "storms: leave out the policies that plan again at each bulletin");
  app.add_option("--judges", arguments.scoring, "averse: members that compare the plans")
      ->check(CLI::Range(100, 20000));
  app.add_option("-o,--output", arguments.output, "write the results as JSON");
}

int Main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Compares rescue plans with simulated and recorded storms.",
               "aquafarm_measure_plan");
  AddOptions(app, arguments);
  app.require_subcommand(1);
  app.fallthrough();
  CLI::App* storms = app.add_subcommand("storms", "chances and value over simulated storms");
  CLI::App* averse = app.add_subcommand("averse", "the worst 5 % with and without --risk-averse");
  app.add_subcommand("back_test", "every recorded storm near the ranch");
  return RunWithExitCodes(app, [&] {
    app.parse(argc, argv);
    if (arguments.archive.empty()) {
      arguments.archive = arguments.scenarios + "/archives/zhoushan_cma.txt";
    }
    const Json data = storms->parsed()   ? RunStorms(arguments)
                      : averse->parsed() ? RunAverse(arguments)
                                         : RunBackTest(arguments);
    if (!arguments.output.empty()) WriteFileAtomically(arguments.output, data.dump(1) + "\n");
    return 0;
  });
}

}  // namespace
}  // namespace aquafarm::agents

int main(int argc, char** argv) { return aquafarm::agents::Main(argc, argv); }
