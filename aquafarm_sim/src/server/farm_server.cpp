// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/server/farm_server.h"

#include <aquafarm_msgs/Outcome.h>

#include <algorithm>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace aquafarm_sim {
namespace {

using aquafarm_msgs::CommandResult;
using aquafarm_msgs::Outcome;

std::string Numbers(std::uint64_t episode, std::uint64_t step) {
  return "episode " + std::to_string(episode) + " step " + std::to_string(step);
}

}  // namespace

FarmServer::FarmServer(std::shared_ptr<const aquafarm::Scenario> scenario,
                       const RanchOptions& options)
    : scenario_(std::move(scenario)),
      yaml_(aquafarm::ToYaml(*scenario_)),
      options_(options),
      agents_(scenario_->AgentCount()),
      batch_(std::make_unique<aquafarm::FarmBatch>(scenario_, options.farms, options.threads)),
      turn_(static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch() /
                                       std::chrono::nanoseconds(1))),
      actions_(static_cast<std::size_t>(agents_)) {
  context_.map_frame = options.map_frame;
  context_.paced = options.paced;
  context_.rate_hz = options.rate_hz;
  for (std::int32_t ship = 0; ship < agents_; ++ship) slots_.push_back(std::make_unique<Slot>());
  batch_->Reset(options.seed, 0, {});
  EpisodeBegan();
}

void FarmServer::SetListener(RanchListener* listener) {
  const Lock lock(mutex_);
  listener_ = listener;
  if (listener_ != nullptr) listener_->OnChange(View());
}

void FarmServer::SetRecorder(RanchRecorder* recorder) {
  const Lock lock(mutex_);
  recorder_ = recorder;
  RecordStarts();
}

void FarmServer::RecordStarts() {
  if (recorder_ == nullptr) return;
  for (std::int32_t i = 0; i < batch_->farms(); ++i)
    recorder_->OnStart(batch_->farm(i), i, context_);
}

// --- commands of single ships -------------------------------------------------------------------

aquafarm_msgs::CommandResult FarmServer::Command(const ShipCommand& command) {
  Lock lock(mutex_);
  try {
    if (command.ship >= 0 && command.ship < agents_ && !command.anonymous()) {
      const Slot& slot = *slots_[static_cast<std::size_t>(command.ship)];
      if (slot.last && *slot.last == command) return slot.answer;
    }
    if (const auto refusal = MarkPresent(command))
      return Refuse(command.ship, refusal->code, refusal->message);
    if (const auto refusal = Check(command))
      return Refuse(command.ship, refusal->code, refusal->message);
    if (context_.paced) return AcceptPaced(command);
    if (agents_ > 1) return WaitForOthers(command, lock);
    slots_[0]->pending = command;
    StepPublishedFarm();
    return AnswerOf(0);
  } catch (const std::exception& error) {
    ++turn_;  // the farm may have stepped
    DropCommands();
    return Refuse(command.ship, Outcome::INTERNAL_ERROR, error.what());
  }
}

aquafarm_msgs::CommandResult FarmServer::MoveShip(const ShipCommand& command) {
  if (command.action < aquafarm::kMoveCount) return Command(command);
  const Lock lock(mutex_);
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
  if (farm.over() && !context_.paced) {
    return Refusal{Outcome::EPISODE_OVER, "episode " + std::to_string(farm.episode()) +
                                              " has ended; call reset to start the next one"};
  }
  if (context_.paused) return Refusal{Outcome::PAUSED, "the farm is paused"};
  return std::nullopt;
}

aquafarm_msgs::CommandResult FarmServer::Refuse(std::int32_t ship, std::uint8_t code,
                                                const std::string& message) {
  ++counters_.refused;
  CommandResult result;
  Describe(ship >= 0 && ship < agents_ ? ship : aquafarm::kNone, result);
  result.reward = 0.0F;
  result.terms = aquafarm_msgs::RewardTerms();
  result.energy = result.distance = 0.0;
  result.code = code;
  result.message = message;
  return result;
}

// A paced farm whose episode has ended starts the next episode at its next tick. Until then there
// is not a step that a command could address.
aquafarm_msgs::CommandResult FarmServer::AcceptPaced(const ShipCommand& command) {
  if (batch_->farm(0).over()) {
    return Refuse(command.ship, Outcome::EPISODE_OVER,
                  "the episode has ended; the next one starts automatically");
  }
  Slot& slot = *slots_[static_cast<std::size_t>(command.ship)];
  slot.pending = command;
  slot.reply = nullptr;  // supersedes a command that waited when the pace changed
  ++slot.ticket;
  slot.changed.notify_all();
  slot.last = command;
  slot.answer = CommandResult();
  Describe(command.ship, slot.answer);
  slot.answer.ok = true;
  slot.answer.code = Outcome::ACCEPTED;
  slot.answer.reward = 0.0F;
  slot.answer.terms = aquafarm_msgs::RewardTerms();
  slot.answer.energy = slot.answer.distance = 0.0;
  ++slot.answer.step;
  return slot.answer;
}

aquafarm_msgs::CommandResult FarmServer::WaitForOthers(const ShipCommand& command, Lock& lock) {
  Slot& slot = *slots_[static_cast<std::size_t>(command.ship)];
  std::optional<CommandResult> reply;
  slot.pending = command;
  slot.reply = &reply;
  const std::uint64_t ticket = ++slot.ticket;
  slot.changed.notify_all();  // supersedes an earlier command of this ship that still waits
  if (EveryShipHasACommand()) {
    StepPublishedFarm();
    return *reply;
  }
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(options_.barrier_timeout_s));
  const std::uint64_t episodes = episode_count_;
  const bool woken = slot.changed.wait_until(
      lock, deadline, [&] { return reply || slot.ticket != ticket || !slot.pending || ending_; });
  if (reply) return *reply;  // even if the ship has newer commands
  if (slot.ticket != ticket) {
    ++counters_.superseded;
    return Refuse(
        command.ship, Outcome::SUPERSEDED,
        "ship " + std::to_string(command.ship) + " sent a newer command for the same step");
  }
  slot.heard_at = Clock::now();  // the client was connected while it waited
  if (!woken && !ending_ && options_.late_ships_hold && !context_.paused && !context_.paced) {
    StepWithoutAbsent();
    return *reply;
  }
  const std::string missing = MissingShips();
  slot.pending.reset();
  slot.reply = nullptr;
  if (ending_) return Refuse(command.ship, Outcome::SHUTTING_DOWN, "the sim node is shutting down");
  if (woken) {
    return Refuse(command.ship, Outcome::STALE,
                  episodes == episode_count_ ? "another client has stepped the farm"
                                             : "a new episode has started");
  }
  ++counters_.barrier_timeouts;
  return Refuse(command.ship, Outcome::TIMEOUT,
                "barrier timed out: no command from other ships within " +
                    std::to_string(options_.barrier_timeout_s) + " s: " + missing);
}

// Returns true if the farm waits for a command of the ship.
bool FarmServer::IsMissing(std::int32_t ship) const {
  const auto i = static_cast<std::size_t>(ship);
  return batch_->farm(0).ships()[i].in_play && !slots_[i]->is_absent && !slots_[i]->pending;
}

bool FarmServer::EveryShipHasACommand() const {
  for (std::int32_t ship = 0; ship < agents_; ++ship) {
    if (IsMissing(ship)) return false;
  }
  return true;
}

std::string FarmServer::MissingShips() const {
  std::string names;
  for (std::int32_t ship = 0; ship < agents_; ++ship) {
    if (IsMissing(ship)) names += (names.empty() ? "" : ", ") + std::to_string(ship);
  }
  return names;
}

// A ship whose node has died or is late holds. The farm ignores it until its next command.
void FarmServer::StepWithoutAbsent() {
  for (std::int32_t ship = 0; ship < agents_; ++ship) {
    if (!IsMissing(ship)) continue;
    slots_[static_cast<std::size_t>(ship)]->is_absent = true;
    ++counters_.late_ships;
  }
  StepPublishedFarm();
}

bool FarmServer::IsHeldByAnother(Slot& slot, const std::string& caller) {
  if (slot.holder.empty() || slot.holder == caller) return false;
  const std::chrono::duration<double> silence = Clock::now() - slot.heard_at;
  // A holder whose command waits for the other ships is present.
  if (slot.pending || silence.count() < options_.claim_timeout_s) return true;
  slot.holder.clear();
  ++counters_.dropped_clients;
  return false;
}

std::optional<FarmServer::Refusal> FarmServer::CheckHolder(std::int32_t ship,
                                                           const std::string& caller) {
  Slot& slot = *slots_[static_cast<std::size_t>(ship)];
  if (!IsHeldByAnother(slot, caller)) return std::nullopt;
  return Refusal{Outcome::CLAIMED, "ship " + std::to_string(ship) + " is held by " + slot.holder};
}

// A client that may command a ship is present if it sends a command, even a late one.
std::optional<FarmServer::Refusal> FarmServer::MarkPresent(const ShipCommand& command) {
  if (command.ship < 0 || command.ship >= agents_) return std::nullopt;
  if (auto refusal = CheckHolder(command.ship, command.caller)) return refusal;
  Slot& slot = *slots_[static_cast<std::size_t>(command.ship)];
  slot.heard_at = Clock::now();
  slot.is_absent = false;
  return std::nullopt;
}

void FarmServer::Claim(std::int32_t ship, const std::string& caller, bool release,
                       aquafarm_msgs::Claim::Response& response) {
  const Lock lock(mutex_);
  Slot& slot = *slots_[static_cast<std::size_t>(ship)];
  const auto refusal = CheckHolder(ship, caller);
  response.ok = !refusal;
  response.code = refusal ? refusal->code : std::uint8_t{Outcome::OK};
  if (refusal) {
    ++counters_.refused;
    response.message = refusal->message;
  } else {
    slot.holder = release ? std::string() : caller;
    slot.heard_at = Clock::now();
  }
  response.holder = slot.holder;
}

void FarmServer::StepPublishedFarm() {
  aquafarm::Farm& farm = batch_->farm(0);
  for (std::size_t ship = 0; ship < slots_.size(); ++ship) {
    const auto& pending = slots_[ship]->pending;
    actions_[ship] = pending ? pending->action : static_cast<std::uint8_t>(aquafarm::Action::kHold);
  }
  farm.Step(actions_.data());
  if (recorder_ != nullptr) recorder_->OnStep(farm, 0, actions_.data());
  ++counters_.farm_steps;
  Advance();
  for (std::size_t ship = 0; ship < slots_.size(); ++ship) {
    Slot& slot = *slots_[ship];
    if (!slot.pending) continue;
    slot.answer = AnswerOf(static_cast<std::int32_t>(ship));
    slot.last = slot.pending;
    slot.pending.reset();
    if (slot.reply != nullptr) *slot.reply = slot.answer;
    slot.reply = nullptr;
  }
  Changed();
  if (farm.over()) {
    Notify(
        [&](RanchListener& listener) { listener.OnEpisodeEnd(ToMsg(farm.record(), 0, context_)); });
  }
  for (const auto& slot : slots_)
    slot->changed.notify_all();  // last: a woken thread needs the lock
}

// Waiting commands return STALE.
void FarmServer::DropPending() {
  for (const auto& slot : slots_) {
    if (!slot->pending) continue;
    slot->pending.reset();
    slot->reply = nullptr;
    slot->changed.notify_all();
  }
}

// Also drops the last responses, because step numbers may repeat.
void FarmServer::DropCommands() {
  DropPending();
  for (const auto& slot : slots_) slot->last.reset();
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

aquafarm_msgs::CommandResult FarmServer::AnswerOf(std::int32_t ship) const {
  CommandResult result;
  Describe(ship, result);
  result.ok = true;
  result.code =
      static_cast<std::uint8_t>(batch_->farm(0).ships()[static_cast<std::size_t>(ship)].outcome);
  return result;
}

// --- time ---------------------------------------------------------------------------------------

void FarmServer::Tick() {
  const Lock lock(mutex_);
  try {
    if (ending_ || context_.paused) return;
    if (batch_->farm(0).over()) {
      batch_->StartNext(0);
      if (recorder_ != nullptr) recorder_->OnStart(batch_->farm(0), 0, context_);
      DropCommands();
      EpisodeBegan();
      return;
    }
    for (std::int32_t ship = 0; ship < agents_; ++ship) {
      const auto i = static_cast<std::size_t>(ship);
      if (!slots_[i]->pending && batch_->farm(0).ships()[i].in_play) ++counters_.late_ships;
    }
    StepPublishedFarm();
  } catch (const std::exception& error) {
    ++turn_;  // the farm may have stepped
    DropCommands();
    context_.paused = true;  // a farm that cannot continue must not fail at every tick
    counters_.fault = error.what();
  }
}

void FarmServer::RunPaced() {
  Lock lock(mutex_);
  Clock::time_point due = Clock::now();
  while (!ending_) {
    if (!context_.paced || context_.paused) {
      pace_changed_.wait(lock, [this] { return ending_ || (context_.paced && !context_.paused); });
      due = Clock::now();
      continue;
    }
    const std::chrono::duration<double> period(1.0 / context_.rate_hz);
    due = std::max(due + std::chrono::duration_cast<Clock::duration>(period), Clock::now());
    const double rate_hz = context_.rate_hz;
    const bool changed = pace_changed_.wait_until(lock, due, [this, rate_hz] {
      return ending_ || !context_.paced || context_.paused || context_.rate_hz != rate_hz;
    });
    if (changed) {
      due = Clock::now();
      continue;
    }
    lock.unlock();
    Tick();
    lock.lock();
  }
}

void FarmServer::Shutdown() {
  const Lock lock(mutex_);
  ending_ = true;
  pace_changed_.notify_all();
  for (const auto& slot : slots_) slot->changed.notify_all();
}

void FarmServer::Advance() {
  ++turn_;
  clock_ns_ += static_cast<std::uint64_t>(1e9 / context_.rate_hz);
  context_.stamp.fromNSec(clock_ns_);
  if (steps_to_pause_ > 0 && --steps_to_pause_ == 0) context_.paused = true;
}

// The start of an episode has a separate tick, so that its stamp differs from that of the last end.
void FarmServer::EpisodeBegan(bool by_joint_step) {
  ++episode_count_;
  Advance();
  Changed(by_joint_step);
}

void FarmServer::Changed(bool by_joint_step) {
  changed_jointly_ = by_joint_step;
  ++version_;
  Notify([this](RanchListener& listener) { listener.OnChange(View()); });
}

// The step is kept even if notifying the listener fails.
void FarmServer::Notify(const std::function<void(RanchListener&)>& telling) {
  if (listener_ == nullptr) return;
  try {
    telling(*listener_);
  } catch (const std::exception& error) {
    ++counters_.untold;
    counters_.untold_why = error.what();
  }
}

RanchView FarmServer::View() const {
  return {*batch_, yaml_, context_, episode_count_, version_, changed_jointly_};
}

void FarmServer::Inspect(const std::function<void(const RanchView&)>& look) {
  const Lock lock(mutex_);
  look(View());
}

RanchCounters FarmServer::counters() {
  const Lock lock(mutex_);
  RanchCounters counters = counters_;
  if (joint_step_at_ != Clock::time_point{}) {
    counters.joint_step_age_s =
        std::chrono::duration<double>(Clock::now() - joint_step_at_).count();
  }
  for (std::int32_t ship = 0; ship < agents_; ++ship) {
    if (slots_[static_cast<std::size_t>(ship)]->is_absent) counters.absent.push_back(ship);
  }
  return counters;
}

}  // namespace aquafarm_sim
