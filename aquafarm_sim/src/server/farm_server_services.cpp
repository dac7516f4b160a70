// SPDX-License-Identifier: BSD-3-Clause
// The requests that affect all ships or all farms.
#include <aquafarm_msgs/Outcome.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/forecast.h"
#include "aquafarm/grid/step_buffers.h"
#include "aquafarm/scenario/validate.h"
#include "aquafarm/storms/to_disaster.h"
#include "aquafarm_sim/server/farm_server.h"

namespace aquafarm_sim {
namespace {

using aquafarm_msgs::Outcome;
using aquafarm_msgs::StepResult;

constexpr std::uint8_t kAllObservationTypes = StepResult::INDEX | StepResult::FEATURES |
                                              StepResult::PLANES | StepResult::HASHES |
                                              StepResult::TERMS;

std::string OutOfRange(const std::string& name, std::int64_t got, std::int64_t min,
                       std::int64_t max) {
  return name + ": got " + std::to_string(got) + ", expected [" + std::to_string(min) + ", " +
         std::to_string(max) + "]";
}

/// Returns true if any field of the storm is set. An incomplete storm is refused, not ignored.
bool IsSaid(const aquafarm_msgs::Storm& storm) {
  return !storm.fixes.empty() || !storm.forecast.empty() || !storm.name.empty();
}

}  // namespace

template <typename Response>
void FarmServer::Answer(std::uint8_t code, const std::string& message, Response& response) {
  response.ok = code == Outcome::OK;
  response.code = code;
  response.message = message;
  if (!response.ok) ++counters_.refused;
}

/// Runs a request and converts exceptions to codes. @param bad_input code of an InputError
template <typename Response, typename Request>
void FarmServer::Guarded(std::uint8_t bad_input, Response& response, Request&& request) {
  try {
    request();
  } catch (const aquafarm::InputError& error) {
    Answer(bad_input, error.what(), response);
  } catch (const std::exception& error) {
    Answer(Outcome::INTERNAL_ERROR, error.what(), response);
  }
}

// --- joint steps --------------------------------------------------------------------------------

const aquafarm_msgs::Step::Response& FarmServer::Step(const aquafarm_msgs::Step::Request& request,
                                                      const std::string& caller) {
  const aquafarm::MutexLock lock(mutex_);
  const RequestKey key{request.sequence, caller};
  if (const auto* answer = steps_.Find(key)) return *answer;
  try {
    if (const auto refusal = Check(request, caller)) {
      Answer(refusal->code, refusal->message, step_refusal_);
      return step_refusal_;
    }
    joint_step_at_ = Clock::now();
    aquafarm_msgs::Step::Response& answer = steps_.Begin();
    Answer(Outcome::OK, "", answer);
    batch_->Step(request.actions.data(), Prepare(request.observation_types, answer.result));
    barrier_.Drop(kSteppedByAnother);
    Complete(request.actions.data(), answer.result);
    steps_.Complete(key);
    return answer;
  } catch (const std::exception& error) {
    ++state_id_;  // some farms may have stepped
    DropCommands(std::string("the step failed: ") + error.what());
    Changed();
    Answer(Outcome::INTERNAL_ERROR, error.what(), step_refusal_);
    return step_refusal_;
  }
}

std::optional<FarmServer::Refusal> FarmServer::Check(const aquafarm_msgs::Step::Request& request,
                                                     const std::string& caller) {
  if (ending_) return Refusal{Outcome::SHUTTING_DOWN, "the sim node is shutting down"};
  if (clock_.context().paced) {
    return Refusal{Outcome::WRONG_PACE, "joint steps need pace lockstep; call set_pace"};
  }
  if (clock_.context().paused) return Refusal{Outcome::PAUSED, "the farm is paused"};
  for (std::int32_t ship = 0; ship < agents_; ++ship) {
    if (auto refusal = CheckHolder(ship, caller)) return refusal;
  }
  // Checked after pauses and claims: a client that retries while the farms are paused or claimed
  // receives PAUSED or CLAIMED, and STALE only after that.
  if (request.state_id != 0 && request.state_id != state_id_) {
    return Refusal{Outcome::STALE,
                   "state_id: got " + std::to_string(request.state_id) + ", the farms are at " +
                       std::to_string(state_id_) +
                       ": another client has stepped or reset them, or the node has restarted"};
  }
  const auto expected =
      static_cast<std::size_t>(batch_->farms()) * static_cast<std::size_t>(agents_);
  if (request.actions.size() != expected) {
    return Refusal{Outcome::BAD_LENGTH, "actions: got " + std::to_string(request.actions.size()) +
                                            " entries, expected " + std::to_string(expected) +
                                            " (" + std::to_string(batch_->farms()) + " farms x " +
                                            std::to_string(agents_) + " agents)"};
  }
  constexpr auto kLast = static_cast<std::uint8_t>(aquafarm::Action::kHold);
  const std::uint8_t highest = *std::max_element(request.actions.begin(), request.actions.end());
  if (highest > kLast) {
    return Refusal{Outcome::BAD_ACTION, OutOfRange("actions", highest, 0, kLast)};
  }
  return CheckAnswerSize(batch_->farms(), request.observation_types);
}

std::optional<FarmServer::Refusal> FarmServer::CheckAnswerSize(
    std::int32_t farms, std::uint8_t observation_types) const {
  if (observation_types > kAllObservationTypes) {
    return Refusal{Outcome::BAD_VALUE,
                   OutOfRange("observation_types", observation_types, 0, kAllObservationTypes)};
  }
  const aquafarm::Encoder& encoder = batch_->encoder();
  if ((observation_types & StepResult::INDEX) != 0 && encoder.state_count() == 0) {
    return Refusal{
        Outcome::BAD_VALUE,
        "observation_types: this farm has too many states for INDEX; request FEATURES or PLANES"};
  }
  const std::size_t entries = static_cast<std::size_t>(farms) * static_cast<std::size_t>(agents_);
  std::size_t bytes = 0;
  if ((observation_types & StepResult::FEATURES) != 0) {
    bytes += entries * sizeof(float) * static_cast<std::size_t>(encoder.feature_count());
  }
  if ((observation_types & StepResult::PLANES) != 0) bytes += entries * encoder.planes_size();
  if (bytes <= kMaxAnswerBytes) return std::nullopt;
  return Refusal{Outcome::BAD_VALUE, "observation_types: the answer would have " +
                                         std::to_string(bytes) + " bytes, expected at most " +
                                         std::to_string(kMaxAnswerBytes) + "; use fewer farms"};
}

aquafarm::BatchOutput FarmServer::Prepare(std::uint8_t observation_types,
                                          StepResult& result) const {
  const aquafarm::StepShape shape = batch_->shape();
  result.farms = batch_->farms();
  result.agents = agents_;
  result.terminated.resize(shape.farms);
  result.truncated.resize(shape.farms);
  result.finished.clear();
  aquafarm::BatchOutput output;
  aquafarm::SizeStepFields(shape, observation_types, result, output);
  return output;
}

void FarmServer::Describe(StepResult& result) const {
  result.state_id = state_id_;
  for (std::size_t i = 0; i < result.end_reasons.size(); ++i) {
    const auto reason = static_cast<aquafarm::EndReason>(result.end_reasons[i]);
    result.terminated[i] = aquafarm::IsTerminated(reason) ? 1 : 0;
    result.truncated[i] = aquafarm::IsTruncated(reason) ? 1 : 0;
  }
}

void FarmServer::Complete(const std::uint8_t* actions, StepResult& result) {
  constexpr bool kByJointStep = true;
  for (std::int32_t i = 0; recorder_ != nullptr && i < batch_->farms(); ++i) {
    if (result.is_first[static_cast<std::size_t>(i)] != 0) {
      recorder_->OnStart(batch_->farm(i), i, clock_.context());
    } else {
      recorder_->OnStep(batch_->farm(i), i, actions + std::ptrdiff_t{i} * agents_);
    }
  }
  if (result.is_first[0] != 0) {
    EpisodeBegan(kByJointStep);
  } else {
    Advance();
    Changed(kByJointStep);
  }
  Describe(result);
  for (std::size_t i = 0; i < result.end_reasons.size(); ++i) {
    counters_.farm_steps += result.is_first[i] == 0 ? 1 : 0;
    if (result.end_reasons[i] == 0) continue;
    const auto number = static_cast<std::int32_t>(i);
    const aquafarm::Farm& farm = batch_->farm(number);
    result.finished.push_back(
        ToMsg(farm.record(), farm.SettleAccounts(), number, clock_.context()));
    Notify([&](FarmListener& listener) { listener.OnEpisodeEnd(result.finished.back()); });
  }
}

// --- episodes -----------------------------------------------------------------------------------

std::uint64_t FarmServer::NextEpisode() const {
  std::uint64_t latest = 0;
  for (std::int32_t i = 0; i < batch_->farms(); ++i) {
    latest = std::max(latest, static_cast<const aquafarm::FarmBatch&>(*batch_).farm(i).episode());
  }
  return latest + 1;
}

void FarmServer::Reset(const aquafarm_msgs::Reset::Request& request,
                       aquafarm_msgs::Reset::Response& response, const std::string& caller) {
  const aquafarm::MutexLock lock(mutex_);
  const RequestKey key{request.sequence, caller};
  if (const auto* answer = resets_.Find(key)) {
    response = *answer;
    return;
  }
  Guarded(Outcome::BAD_VALUE, response, [&]() AQUAFARM_REQUIRES(mutex_) {
    const bool goes_on = request.only_if_over && !batch_->farm(0).over();
    const std::int32_t farms = request.farms == 0 || goes_on ? batch_->farms() : request.farms;
    if (farms < 1 || farms > kMaxFarms) {
      return Answer(Outcome::BAD_VALUE, OutOfRange("farms", farms, 1, kMaxFarms), response);
    }
    if (request.stride != 0 && request.stride < static_cast<std::uint32_t>(farms)) {
      return Answer(Outcome::BAD_VALUE,
                    "stride: got " + std::to_string(request.stride) + ", expected 0 or at least " +
                        std::to_string(farms) + ", the number of farms",
                    response);
    }
    if (const auto refusal = CheckAnswerSize(farms, request.observation_types)) {
      return Answer(refusal->code, refusal->message, response);
    }
    const std::string too_many = DescribeTooManyLayouts(farms, batch_->farm(0));
    if (!too_many.empty()) return Answer(Outcome::BAD_VALUE, too_many, response);
    const std::uint64_t seed = request.has_seed ? request.seed : batch_->farm(0).seed();
    const std::uint64_t first = request.has_episode ? request.episode
                                : request.has_seed  ? 0
                                                    : NextEpisode();
    if (!goes_on) StartEpisodes(farms, seed, first, request.stride);
    batch_->Write(Prepare(request.observation_types, response.result));
    Describe(response.result);
    response.seed = batch_->farm(0).seed();
    response.episode = batch_->farm(0).episode();
    if (request.with_spec) FillSpec(0, response.spec);
    Answer(Outcome::OK, "", response);
  });
  if (!response.ok) return;
  if (!key.IsIdentified()) return resets_.Forget();
  resets_.Begin() = response;
  resets_.Complete(key);
}

// Makes the farms. If every episode has a new layout, first makes one farm to compute the size of
// all.
std::unique_ptr<aquafarm::FarmBatch> FarmServer::MakeBatch(
    const std::shared_ptr<const aquafarm::Scenario>& scenario, const ServerOptions& options) {
  if (scenario->layout == aquafarm::LayoutMode::kPerEpisode) {
    const aquafarm::FarmBatch one(scenario, 1);
    const std::string too_many = DescribeTooManyLayouts(options.farms, one.farm(0));
    if (!too_many.empty()) throw aquafarm::InputError(too_many);
  }
  return std::make_unique<aquafarm::FarmBatch>(scenario, options.farms, options.threads);
}

// Returns an error if new layouts of `farms` farms like `farm` would need too much memory. Returns
// an empty text if they would not, or if all farms share one layout.
std::string FarmServer::DescribeTooManyLayouts(std::int32_t farms, const aquafarm::Farm& farm) {
  const aquafarm::Layout& layout = farm.layout();
  const std::int64_t cells =
      farms * (layout.cells.size() + static_cast<std::int64_t>(layout.routes.size()));
  if (farm.scenario().layout != aquafarm::LayoutMode::kPerEpisode || cells <= kMaxDrawnCells) {
    return "";
  }
  return "farms: " + std::to_string(farms) + " layouts would have " + std::to_string(cells) +
         " cells and routes, expected at most " + std::to_string(kMaxDrawnCells) +
         "; use fewer farms";
}

// Generates new layouts in a new batch: if one cannot be generated, the current episodes stay
// unchanged.
void FarmServer::StartEpisodes(std::int32_t farms, std::uint64_t seed, std::uint64_t first,
                               std::uint32_t stride) {
  if (farms != batch_->farms() || scenario_->layout == aquafarm::LayoutMode::kPerEpisode) {
    auto fresh = std::make_unique<aquafarm::FarmBatch>(scenario_, farms, options_.threads);
    fresh->Reset(seed, first, {}, stride);
    batch_ = std::move(fresh);
  } else {
    batch_->Reset(seed, first, {}, stride);
  }
  RecordStarts();
  ForgetAnswers();
  EpisodeBegan();
}

void FarmServer::ForgetAnswers() {
  steps_.Forget();
  resets_.Forget();
  DropCommands();
}

void FarmServer::FillSpec(std::int32_t farm, aquafarm_msgs::FarmSpec& spec) const {
  ToMsg(batch_->farm(farm), batch_->encoder(), batch_->farms(), yaml_, clock_.context(), spec);
}

void FarmServer::GetState(const aquafarm_msgs::GetState::Request& request,
                          aquafarm_msgs::GetState::Response& response) {
  const aquafarm::MutexLock lock(mutex_);
  Guarded(Outcome::BAD_VALUE, response, [&]() AQUAFARM_REQUIRES(mutex_) {
    if (request.farm < 0 || request.farm >= batch_->farms()) {
      return Answer(Outcome::UNKNOWN_FARM, OutOfRange("farm", request.farm, 0, batch_->farms() - 1),
                    response);
    }
    const aquafarm::Farm& farm = batch_->farm(request.farm);
    if (request.observation) {
      if (request.ship < 0 || request.ship >= agents_) {
        return Answer(Outcome::UNKNOWN_SHIP, OutOfRange("ship", request.ship, 0, agents_ - 1),
                      response);
      }
      aquafarm::Observe(farm, request.ship, view_);
      ToMsg(farm, view_, clock_.context(), response.state);
    } else {
      ToMsg(farm, clock_.context(), response.state);
    }
    response.barrier_timeout_s = options_.barrier_timeout_s;
    if (request.with_spec) FillSpec(request.farm, response.spec);
    Answer(Outcome::OK, "", response);
  });
}

void FarmServer::SaveState(aquafarm_msgs::SaveState::Response& response) {
  const aquafarm::MutexLock lock(mutex_);
  Guarded(Outcome::BAD_VALUE, response, [&]() AQUAFARM_REQUIRES(mutex_) {
    const std::string bytes = batch_->Save();
    response.data.assign(bytes.begin(), bytes.end());
    ++counters_.saves;
    response.hash = batch_->farm(0).Hash();
    Answer(Outcome::OK, "", response);
  });
}

void FarmServer::LoadState(const aquafarm_msgs::LoadState::Request& request,
                           aquafarm_msgs::LoadState::Response& response) {
  const aquafarm::MutexLock lock(mutex_);
  Guarded(Outcome::BAD_DATA, response, [&]() AQUAFARM_REQUIRES(mutex_) {
    if (const auto refusal = CheckAnswerSize(batch_->farms(), request.observation_types)) {
      return Answer(refusal->code, refusal->message, response);
    }
    batch_->Load(std::string(request.data.begin(), request.data.end()));
    RecordStarts();
    for (std::int32_t i = 0; recorder_ != nullptr && i < batch_->farms(); ++i) {
      recorder_->OnIntervention(batch_->farm(i), i);  // the loaded state may differ even at step 0
    }
    ForgetAnswers();
    EpisodeBegan();
    batch_->Write(Prepare(request.observation_types, response.result));
    Describe(response.result);
    response.hash = batch_->farm(0).Hash();
    if (request.with_spec) FillSpec(0, response.spec);
    Answer(Outcome::OK, "", response);
  });
}

// --- operating ----------------------------------------------------------------------------------

void FarmServer::Pause(const aquafarm_msgs::Pause::Request& request,
                       aquafarm_msgs::Pause::Response& response) {
  const aquafarm::MutexLock lock(mutex_);
  clock_.SetPaused(request.paused != 0, request.steps);
  if (request.paused == 0) counters_.fault.clear();
  response.paused = clock_.context().paused;
  Changed();
  Answer(Outcome::OK, "", response);
}

void FarmServer::SetPace(const aquafarm_msgs::SetPace::Request& request,
                         aquafarm_msgs::SetPace::Response& response) {
  const aquafarm::MutexLock lock(mutex_);
  const bool known = request.pace.empty() || request.pace == "lockstep" || request.pace == "paced";
  const bool rate_fits = std::isfinite(request.rate_hz) && request.rate_hz >= 0.0 &&
                         request.rate_hz <= kMaxRate_hz &&
                         (request.rate_hz == 0.0 || request.rate_hz >= kMinRate_hz);
  if (!known) {
    Answer(Outcome::BAD_VALUE,
           "pace: got '" + request.pace.substr(0, 40) + "', expected lockstep or paced", response);
  } else if (!rate_fits) {
    Answer(Outcome::BAD_VALUE,
           "rate_hz: got " + std::to_string(request.rate_hz) + ", expected 0 or [" +
               std::to_string(kMinRate_hz) + ", " + std::to_string(kMaxRate_hz) + "]",
           response);
  } else {
    const MessageContext& now = clock_.context();
    clock_.SetPace(request.pace.empty() ? now.paced : request.pace == "paced",
                   request.rate_hz > 0.0 ? request.rate_hz : now.rate_hz);
    Changed();
    Answer(Outcome::OK, "", response);
  }
  response.pace = clock_.context().paced ? "paced" : "lockstep";
  response.rate_hz = clock_.context().rate_hz;
}

// Issues a forecast to all addressed farms, or to none.
void FarmServer::IssueForecast(const aquafarm_msgs::SetDisaster::Request& request,
                               std::int32_t first, std::int32_t end,
                               aquafarm_msgs::SetDisaster::Response& response) {
  std::vector<aquafarm::IssuedForecast> issued;
  for (std::int32_t i = first; i < end; ++i) {
    const aquafarm::Farm& farm = batch_->farm(i);
    if (IsSaid(request.storm)) {
      aquafarm::DisasterSpec storm =
          aquafarm::ToDisaster(FromMsg(request.storm), *scenario_, request.id, farm.step());
      if (storm.forecasts.empty()) {
        throw aquafarm::InputError(
            "storm.forecast: got no positions after the last fix, expected at least "
            "one: forecast_only is set");
      }
      issued.push_back(aquafarm::FitForecast(farm, request.id, storm));
    } else if (request.forecasts.size() == 1) {
      issued.push_back(FromMsg(request.forecasts)[0]);
    } else {
      throw aquafarm::InputError("forecasts: got " + std::to_string(request.forecasts.size()) +
                                 ", expected exactly one: forecast_only is set");
    }
    aquafarm::CheckForecast(farm, request.id, issued.back());
  }
  for (std::int32_t i = first; i < end; ++i) {
    batch_->farm(i).IssueForecast(request.id, issued[static_cast<std::size_t>(i - first)]);
    if (recorder_ != nullptr) recorder_->OnIntervention(batch_->farm(i), i);
  }
  if (first == 0) Changed();
  Answer(Outcome::OK, "", response);
}

void FarmServer::SetDisaster(const aquafarm_msgs::SetDisaster::Request& request,
                             aquafarm_msgs::SetDisaster::Response& response) {
  const aquafarm::MutexLock lock(mutex_);
  Guarded(Outcome::BAD_VALUE, response, [&]() AQUAFARM_REQUIRES(mutex_) {
    if (request.farm < -1 || request.farm >= batch_->farms()) {
      return Answer(Outcome::UNKNOWN_FARM,
                    OutOfRange("farm", request.farm, -1, batch_->farms() - 1), response);
    }
    const std::int32_t first = std::max(request.farm, 0);
    const std::int32_t end = request.farm < 0 ? batch_->farms() : first + 1;
    for (std::int32_t i = first; i < end; ++i) {
      const auto count = static_cast<std::int32_t>(batch_->farm(i).disasters().size());
      const std::int32_t max = std::min(count, aquafarm::kMaxDisasters - 1);
      if (request.id < 0 || request.id > max) {
        return Answer(Outcome::BAD_VALUE, OutOfRange("id", request.id, 0, max), response);
      }
    }
    if (request.forecast_only != 0) return IssueForecast(request, first, end, response);
    const bool on_globe = IsSaid(request.storm);
    const auto step_of = [&](std::int32_t i)
                             AQUAFARM_REQUIRES(mutex_) { return batch_->farm(i).step(); };
    std::int32_t earliest = step_of(first);
    for (std::int32_t i = first; i < end; ++i) earliest = std::min(earliest, step_of(i));
    // ToDisaster rejects a storm that has ended at the earliest step, because it has then ended for
    // all farms.
    aquafarm::DisasterSpec spec =
        on_globe ? aquafarm::ToDisaster(FromMsg(request.storm), *scenario_, request.id, earliest)
                 : FromMsg(request.info);
    if (!on_globe) spec.forecasts = FromMsg(request.forecasts);
    aquafarm::ValidateDisaster(spec);
    const std::int32_t longest = spec.duration;
    const auto left = [&](std::int32_t i) AQUAFARM_REQUIRES(mutex_) {
      return on_globe ? longest - (step_of(i) - earliest) : longest;
    };
    for (std::int32_t i = first; i < end; ++i) {
      const auto count = static_cast<std::int32_t>(batch_->farm(i).disasters().size());
      if (request.id == count && !spec.start && spec.track.empty()) {
        return Answer(Outcome::BAD_VALUE,
                      "info: disaster " + std::to_string(request.id) + " is new to farm " +
                          std::to_string(i) + ", expected a start or a track",
                      response);
      }
    }
    // The checks above cover all differences between farms: if one farm accepts the disaster, all
    // farms do.
    for (std::int32_t i = first; i < end; ++i) {
      if (left(i) <= 0) continue;  // the storm has ended for this farm
      aquafarm::DisasterSpec fitted = spec;
      fitted.duration = left(i);
      if (on_globe) aquafarm::FitArrival(batch_->farm(i), request.id, fitted);
      batch_->farm(i).SetDisaster(request.id, fitted);
      if (recorder_ != nullptr) recorder_->OnIntervention(batch_->farm(i), i);
    }
    if (first == 0) Changed();
    Answer(Outcome::OK, "", response);
  });
  response.hash =
      batch_->farm(request.farm > 0 && request.farm < batch_->farms() ? request.farm : 0).Hash();
}

}  // namespace aquafarm_sim
