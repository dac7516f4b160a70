// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/server/command_barrier.h"

#include "aquafarm/grid/action.h"

namespace aquafarm_sim {

using aquafarm_msgs::CommandResult;

CommandBarrier::CommandBarrier(std::int32_t ships) {
  for (std::int32_t ship = 0; ship < ships; ++ship) slots_.push_back(std::make_unique<Slot>());
}

const CommandResult* CommandBarrier::FindAnswer(const ShipCommand& command) const {
  return slots_[Index(command.ship)]->log.Find(command);
}

void CommandBarrier::Add(const ShipCommand& command, Call* call) {
  Slot& slot = *slots_[Index(command.ship)];
  slot.pending = command;
  ++slot.number;
  slot.call = call;
  if (call != nullptr) {
    call->ship = command.ship;
    call->number = slot.number;
  }
  slot.changed.notify_all();  // an earlier command of this ship that still waits is superseded
}

CommandBarrier::WaitEnd CommandBarrier::Wait(aquafarm::MutexLock& lock, const Call& call,
                                             Clock::time_point deadline, const bool& ending) {
  Slot& slot = *slots_[Index(call.ship)];
  bool in_time = true;
  while (true) {
    if (call.answer) return WaitEnd::kAnswered;  // even if the ship has newer commands
    if (call.number <= slot.dropped) return WaitEnd::kDropped;  // even if the ship has newer ones
    if (slot.number != call.number) return WaitEnd::kSuperseded;
    if (ending || !in_time) return WaitEnd::kTimedOut;
    in_time = lock.WaitUntil(slot.changed, deadline);
  }
}

void CommandBarrier::Withdraw(const Call& call) {
  Slot& slot = *slots_[Index(call.ship)];
  if (slot.number != call.number) return;
  slot.pending.reset();
  slot.call = nullptr;
}

void CommandBarrier::Drop(const std::string& reason) {
  drop_reason_ = reason;
  for (const auto& slot : slots_) {
    if (!slot->pending) continue;
    slot->dropped = slot->number;
    slot->pending.reset();
    slot->call = nullptr;
    slot->changed.notify_all();
  }
}

void CommandBarrier::ForgetAnswers() {
  for (const auto& slot : slots_) slot->log.Forget();
}

void CommandBarrier::Wake() {
  for (const auto& slot : slots_) slot->changed.notify_all();
}

void CommandBarrier::WriteActions(std::uint8_t* actions) const {
  for (std::size_t ship = 0; ship < slots_.size(); ++ship) {
    const auto& pending = slots_[ship]->pending;
    actions[ship] = pending ? pending->action : static_cast<std::uint8_t>(aquafarm::Action::kHold);
  }
}

void CommandBarrier::Answer(std::int32_t ship, const CommandResult& answer) {
  Slot& slot = *slots_[Index(ship)];
  slot.log.Begin() = answer;
  slot.log.Complete(*slot.pending);
  slot.pending.reset();
  if (slot.call != nullptr) slot.call->answer = answer;
  slot.call = nullptr;
}

void CommandBarrier::Accept(const ShipCommand& command, const CommandResult& answer) {
  Slot& slot = *slots_[Index(command.ship)];
  slot.log.Begin() = answer;
  slot.log.Complete(command);
}

bool CommandBarrier::IsMissing(const aquafarm::Farm& farm, std::int32_t ship) const {
  const Slot& slot = *slots_[Index(ship)];
  return farm.ships()[Index(ship)].active && !slot.is_absent && !slot.pending;
}

bool CommandBarrier::IsComplete(const aquafarm::Farm& farm) const {
  for (std::int32_t ship = 0; Index(ship) < slots_.size(); ++ship) {
    if (IsMissing(farm, ship)) return false;
  }
  return true;
}

std::vector<std::int32_t> CommandBarrier::MissingShips(const aquafarm::Farm& farm) const {
  std::vector<std::int32_t> missing;
  for (std::int32_t ship = 0; Index(ship) < slots_.size(); ++ship) {
    if (IsMissing(farm, ship)) missing.push_back(ship);
  }
  return missing;
}

std::vector<std::int32_t> CommandBarrier::AbsentShips() const {
  std::vector<std::int32_t> absent;
  for (std::int32_t ship = 0; Index(ship) < slots_.size(); ++ship) {
    if (slots_[Index(ship)]->is_absent) absent.push_back(ship);
  }
  return absent;
}

}  // namespace aquafarm_sim
