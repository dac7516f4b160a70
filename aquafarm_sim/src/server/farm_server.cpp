// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/server/farm_server.h"

#include <aquafarm_msgs/Outcome.h>

#include <algorithm>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace aquafarm_sim {
namespace {

using aquafarm::MutexLock;
using aquafarm_msgs::CommandResult;
using aquafarm_msgs::Outcome;

std::string Numbers(std::uint64_t episode, std::uint64_t step) {
  return "episode " + std::to_string(episode) + " step " + std::to_string(step);
}

// Clears the values of a step, for a command that has not stepped the farm.
void ClearReward(CommandResult& result) {
  result.reward = 0.0F;
  result.terms = aquafarm_msgs::RewardTerms();
  result.energy = result.distance = 0.0;
}

MessageContext StartOf(const ServerOptions& options) {
  MessageContext context;
  context.map_frame = options.map_frame;
  context.paced = options.paced;
  context.rate_hz = options.rate_hz;
  return context;
}

}  // namespace

FarmServer::FarmServer(std::shared_ptr<const aquafarm::Scenario> scenario,
                       const ServerOptions& options)
    : scenario_(std::move(scenario)),
      yaml_(aquafarm::ToYaml(*scenario_)),
      options_(options),
      agents_(scenario_->AgentCount()),
      batch_(MakeBatch(scenario_, options)),
      barrier_(agents_),
      claims_(agents_, options.claim_timeout_s),
      clock_(StartOf(options)),
      state_id_(static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch() /
                                           std::chrono::nanoseconds(1))),
      actions_(static_cast<std::size_t>(agents_)) {
  const MutexLock lock(mutex_);
  counters_.absences.resize(static_cast<std::size_t>(agents_));
  batch_->Reset(options.seed, 0, {});
  EpisodeBegan();
}

void FarmServer::SetListener(FarmListener* listener) {
  const MutexLock lock(mutex_);
  listener_ = listener;
  if (listener_ != nullptr) listener_->OnChange(View());
}

void FarmServer::SetRecorder(FarmRecorder* recorder) {
  const MutexLock lock(mutex_);
  recorder_ = recorder;
  RecordStarts();
}

void FarmServer::RecordStarts() {
  if (recorder_ == nullptr) return;
  for (std::int32_t i = 0; i < batch_->farms(); ++i)
    recorder_->OnStart(batch_->farm(i), i, clock_.context());
}

// --- commands of single ships -------------------------------------------------------------------

aquafarm_msgs::CommandResult FarmServer::Command(const ShipCommand& command) {
  MutexLock lock(mutex_);
  try {
    const bool is_known = command.ship >= 0 && command.ship < agents_;
    if (const CommandResult* answer = is_known ? barrier_.FindAnswer(command) : nullptr)
      return *answer;
    if (const auto refusal = MarkPresent(command))
      return Refuse(command.ship, refusal->code, refusal->message);
    if (const auto refusal = Check(command))
      return Refuse(command.ship, refusal->code, refusal->message);
    return clock_.context().paced ? AcceptPaced(command) : StepTogether(command, lock);
  } catch (const std::exception& error) {
    ++state_id_;  // the farm may have stepped
    DropCommands(std::string("the step failed: ") + error.what());
    Changed();
    return Refuse(command.ship, Outcome::INTERNAL_ERROR, error.what());
  }
}

aquafarm_msgs::CommandResult FarmServer::MoveShip(const ShipCommand& command) {
  if (command.action < aquafarm::kMoveCount) return Command(command);
  const MutexLock lock(mutex_);
  return Refuse(command.ship, Outcome::BAD_DIRECTION,
                "direction: got " + std::to_string(command.action) + ", expected [0, 7]");
}

std::optional<FarmServer::Refusal> FarmServer::Check(const ShipCommand& command) const {
  if (ending_) return Refusal{Outcome::SHUTTING_DOWN, "the sim node is shutting down"};
  if (command.ship < 0 || command.ship >= agents_) {
    return Refusal{Outcome::UNKNOWN_SHIP, "ship: got " + std::to_string(command.ship) +
                                              ", expected [0, " + std::to_string(agents_ - 1) +
                                              "]"};
  }
  if (command.action > static_cast<std::uint8_t>(aquafarm::Action::kHold)) {
    return Refusal{Outcome::BAD_ACTION,
                   "action: got " + std::to_string(command.action) + ", expected [0, 10]"};
  }
  const aquafarm::Farm& farm = batch_->farm(0);
  const auto step = static_cast<std::uint64_t>(farm.step());
  const bool now = command.episode == 0 && command.step == 0;
  if (!now && (command.episode != farm.episode() || command.step != step)) {
    return Refusal{Outcome::STALE, "meant for " + Numbers(command.episode, command.step) +
                                       ", the farm is at " + Numbers(farm.episode(), step)};
  }
  if (farm.over() && !clock_.context().paced) {
    return Refusal{Outcome::EPISODE_OVER, "episode " + std::to_string(farm.episode()) +
                                              " has ended; call reset to start the next one"};
  }
  if (clock_.context().paused) return Refusal{Outcome::PAUSED, "the farm is paused"};
  return std::nullopt;
}

aquafarm_msgs::CommandResult FarmServer::Refuse(std::int32_t ship, std::uint8_t code,
                                                const std::string& message) {
  ++counters_.refused;
  CommandResult result;
  Describe(ship >= 0 && ship < agents_ ? ship : aquafarm::kNone, result);
  ClearReward(result);
  result.code = code;
  result.message = message;
  return result;
}

// A paced farm whose episode has ended starts the next episode at its next tick. Until then a
// command has no step in which it could be executed.
aquafarm_msgs::CommandResult FarmServer::AcceptPaced(const ShipCommand& command) {
  if (batch_->farm(0).over()) {
    return Refuse(command.ship, Outcome::EPISODE_OVER,
                  "the episode has ended; the next one starts automatically");
  }
  barrier_.Add(command, nullptr);
  CommandResult result;
  Describe(command.ship, result);
  ClearReward(result);
  result.ok = true;
  result.code = Outcome::ACCEPTED;
  ++result.step;
  barrier_.Accept(command, result);
  return result;
}

aquafarm_msgs::CommandResult FarmServer::StepTogether(const ShipCommand& command, MutexLock& lock) {
  CommandBarrier::Call call;
  barrier_.Add(command, &call);
  if (barrier_.IsComplete(batch_->farm(0))) {
    StepPublishedFarm();
    return *call.answer;
  }
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(options_.barrier_timeout_s));
  const std::uint64_t episodes = episode_count_;
  const CommandBarrier::WaitEnd end = barrier_.Wait(lock, call, deadline, ending_);
  if (end == CommandBarrier::WaitEnd::kAnswered) return *call.answer;
  const MessageContext& context = clock_.context();
  if (end == CommandBarrier::WaitEnd::kTimedOut && !ending_ && options_.late_ships_hold &&
      !context.paused && !context.paced) {
    claims_.MarkPresent(command.ship);  // the client was connected while it waited
    MarkMissingAbsent();
    StepPublishedFarm();
    return *call.answer;
  }
  return RefuseAfter(end, call, episodes);
}

// @param episodes value of episode_count_ when the call began
aquafarm_msgs::CommandResult FarmServer::RefuseAfter(CommandBarrier::WaitEnd end,
                                                     const CommandBarrier::Call& call,
                                                     std::uint64_t episodes) {
  if (end == CommandBarrier::WaitEnd::kSuperseded) {
    ++counters_.superseded;
    return Refuse(call.ship, Outcome::SUPERSEDED,
                  "ship " + std::to_string(call.ship) + " sent a newer command for the same step");
  }
  claims_.MarkPresent(call.ship);  // the client was connected while it waited
  std::string missing;
  for (const std::int32_t ship : barrier_.MissingShips(batch_->farm(0)))
    missing += (missing.empty() ? "" : ", ") + std::to_string(ship);
  barrier_.Withdraw(call);
  if (ending_) return Refuse(call.ship, Outcome::SHUTTING_DOWN, "the sim node is shutting down");
  if (end == CommandBarrier::WaitEnd::kDropped) {
    return Refuse(
        call.ship, Outcome::STALE,
        episodes == episode_count_ ? barrier_.drop_reason() : "a new episode has started");
  }
  ++counters_.barrier_timeouts;
  return Refuse(call.ship, Outcome::TIMEOUT,
                "barrier timed out: no command from other ships within " +
                    std::to_string(options_.barrier_timeout_s) + " s: " + missing);
}

// Missing ships hold in this step. Lockstep does not wait for them until their next command.
void FarmServer::MarkMissingAbsent() {
  const std::vector<std::int32_t> missing = barrier_.MissingShips(batch_->farm(0));
  for (const std::int32_t ship : missing) {
    barrier_.SetAbsent(ship, true);
    ++counters_.late_ships;
    ++counters_.absences[static_cast<std::size_t>(ship)];
  }
  Notify([&](FarmListener& listener) { listener.OnPresence(missing, false); });
}

std::optional<FarmServer::Refusal> FarmServer::CheckHolder(std::int32_t ship,
                                                           const std::string& caller) {
  if (!claims_.IsHeldByAnother(ship, caller, barrier_.HasCommand(ship))) return std::nullopt;
  return Refusal{Outcome::CLAIMED,
                 "ship " + std::to_string(ship) + " is held by " + claims_.holder(ship)};
}

// Marks the client that sent a command as present, even if the command is late. Returns a refusal
// if another node holds the ship.
std::optional<FarmServer::Refusal> FarmServer::MarkPresent(const ShipCommand& command) {
  if (command.ship < 0 || command.ship >= agents_) return std::nullopt;
  if (auto refusal = CheckHolder(command.ship, command.caller)) return refusal;
  claims_.MarkPresent(command.ship);
  if (barrier_.SetAbsent(command.ship, false)) {
    Notify([&](FarmListener& listener) { listener.OnPresence({command.ship}, true); });
  }
  return std::nullopt;
}

void FarmServer::Claim(std::int32_t ship, const std::string& caller, bool release,
                       aquafarm_msgs::Claim::Response& response) {
  const MutexLock lock(mutex_);
  const auto refusal = CheckHolder(ship, caller);
  response.ok = !refusal;
  response.code = refusal ? refusal->code : std::uint8_t{Outcome::OK};
  if (refusal) {
    ++counters_.refused;
    response.message = refusal->message;
  } else {
    claims_.SetHolder(ship, release ? std::string() : caller);
  }
  response.holder = claims_.holder(ship);
}

void FarmServer::StepPublishedFarm() {
  aquafarm::Farm& farm = batch_->farm(0);
  barrier_.WriteActions(actions_.data());
  farm.Step(actions_.data());
  if (recorder_ != nullptr) recorder_->OnStep(farm, 0, actions_.data());
  ++counters_.farm_steps;
  Advance();
  for (std::int32_t ship = 0; ship < agents_; ++ship) {
    if (barrier_.HasCommand(ship)) barrier_.Answer(ship, ResultOf(ship));
  }
  Changed();
  if (farm.over()) {
    const aquafarm_msgs::EpisodeSummary summary =
        ToMsg(farm.record(), farm.SettleAccounts(), 0, clock_.context());
    Notify([&](FarmListener& listener) { listener.OnEpisodeEnd(summary); });
  }
  barrier_.Wake();  // last: a woken thread needs the lock
}

// Drops the waiting commands, whose calls then return STALE. The last answers are forgotten,
// because step numbers may repeat.
void FarmServer::DropCommands(const std::string& reason) {
  barrier_.Drop(reason);
  barrier_.ForgetAnswers();
}

void FarmServer::Describe(std::int32_t ship, aquafarm_msgs::CommandResult& result) const {
  const aquafarm::Farm& farm = batch_->farm(0);
  result.episode = farm.episode();
  result.step = static_cast<std::uint64_t>(farm.step());
  result.terminated = aquafarm::IsTerminated(farm.reason());
  result.truncated = aquafarm::IsTruncated(farm.reason());
  result.reason = static_cast<std::uint8_t>(farm.reason());
  result.hash = farm.Hash();
  if (ship == aquafarm::kNone) return;
  const aquafarm::Ship& of = farm.ships()[static_cast<std::size_t>(ship)];
  result.reward = of.reward;
  result.terms = ToMsg(of.terms);
  result.energy = of.energy;
  result.distance = of.distance;
  result.legal_actions = farm.LegalActions(ship);
}

aquafarm_msgs::CommandResult FarmServer::ResultOf(std::int32_t ship) const {
  CommandResult result;
  Describe(ship, result);
  result.ok = true;
  result.code =
      static_cast<std::uint8_t>(batch_->farm(0).ships()[static_cast<std::size_t>(ship)].outcome);
  return result;
}

// --- time ---------------------------------------------------------------------------------------

void FarmServer::Tick() {
  const MutexLock lock(mutex_);
  try {
    if (ending_ || clock_.context().paused) return;
    if (batch_->farm(0).over()) {
      batch_->StartNext(0);
      if (recorder_ != nullptr) recorder_->OnStart(batch_->farm(0), 0, clock_.context());
      DropCommands();
      EpisodeBegan();
      return;
    }
    for (std::int32_t ship = 0; ship < agents_; ++ship) {
      const bool is_active = batch_->farm(0).ships()[static_cast<std::size_t>(ship)].active;
      if (is_active && !barrier_.HasCommand(ship)) ++counters_.late_ships;
    }
    StepPublishedFarm();
  } catch (const std::exception& error) {
    ++state_id_;  // the farm may have stepped
    DropCommands(std::string("the step failed: ") + error.what());
    clock_.SetPaused(true);  // a farm that cannot continue must not fail at every tick
    counters_.fault = error.what();
    Changed();
  }
}

void FarmServer::RunPaced() {
  MutexLock lock(mutex_);
  while (clock_.WaitForTick(lock, ending_)) {
    lock.Unlock();
    Tick();
    lock.Lock();
  }
}

void FarmServer::Shutdown() {
  const MutexLock lock(mutex_);
  ending_ = true;
  clock_.Wake();
  barrier_.Wake();
}

void FarmServer::Advance() {
  ++state_id_;
  clock_.Advance();
}

// The start of an episode advances the clock, so that its stamp differs from that of the last step.
void FarmServer::EpisodeBegan(bool by_joint_step) {
  ++episode_count_;
  Advance();
  Changed(by_joint_step);
}

void FarmServer::Changed(bool by_joint_step) {
  changed_jointly_ = by_joint_step;
  ++version_;
  const ServerView view = View();
  Notify([&](FarmListener& listener) { listener.OnChange(view); });
}

// The step is kept even if notifying the listener fails.
void FarmServer::Notify(const std::function<void(FarmListener&)>& notify) {
  if (listener_ == nullptr) return;
  try {
    notify(*listener_);
  } catch (const std::exception& error) {
    ++counters_.dropped_notifications;
    counters_.dropped_reason = error.what();
  }
}

ServerView FarmServer::View() const {
  return {*batch_, yaml_, clock_.context(), episode_count_, version_, changed_jointly_};
}

void FarmServer::Inspect(const std::function<void(const ServerView&)>& look) {
  const MutexLock lock(mutex_);
  look(View());
}

ServerCounters FarmServer::counters() {
  const MutexLock lock(mutex_);
  ServerCounters counters = counters_;
  if (joint_step_at_ != Clock::time_point{}) {
    counters.joint_step_age_s =
        std::chrono::duration<double>(Clock::now() - joint_step_at_).count();
  }
  counters.dropped_clients = claims_.expired();
  counters.absent = barrier_.AbsentShips();
  return counters;
}

}  // namespace aquafarm_sim
