// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <aquafarm_msgs/CommandResult.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/base/mutex.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm_sim/server/command.h"
#include "aquafarm_sim/server/request_log.h"

namespace aquafarm_sim {

/// Collects the commands of the ships for the next step of a farm. It keeps only the newest command
/// of each ship. In lockstep the caller of each command waits until no ship is missing (IsMissing).
/// The owner must hold the same mutex during every call. Wait releases the mutex while it waits.
class CommandBarrier {
 public:
  using Clock = std::chrono::steady_clock;

  /// A call that waits for the answer to its command.
  struct Call {
    std::int32_t ship{};
    std::uint64_t number{};  ///< number of its command
    std::optional<aquafarm_msgs::CommandResult> answer;
  };
  enum class WaitEnd { kAnswered, kSuperseded, kDropped, kTimedOut };

  explicit CommandBarrier(std::int32_t ships);

  /// Returns the answer to the ship's last executed or accepted command if `command` is a retry of
  /// it; null if it is not.
  const aquafarm_msgs::CommandResult* FindAnswer(const ShipCommand& command) const;
  /// Stores a command for the next step. It replaces a pending command of the ship, whose call ends
  /// with kSuperseded.
  /// @param call receives the answer. It must stay valid until Wait returns, and after kTimedOut
  ///        until it is answered or Withdraw is called. null: no call waits
  void Add(const ShipCommand& command, Call* call);
  /// Waits until the call is answered, superseded or dropped. Returns kTimedOut at `deadline`, or
  /// if `ending` is true. After kTimedOut the command is still pending.
  /// @param lock lock of the owner's mutex
  WaitEnd Wait(aquafarm::MutexLock& lock, const Call& call, Clock::time_point deadline,
               const bool& ending);
  /// Removes the command of a call whose Wait has returned kTimedOut or kDropped. A newer command
  /// of the ship stays.
  void Withdraw(const Call& call);
  /// Removes all commands. Their calls end with kDropped.
  /// @param reason why, for the clients
  void Drop(const std::string& reason);
  /// Returns the reason of the last Drop.
  const std::string& drop_reason() const { return drop_reason_; }
  /// Forgets the last answers of all ships. Must be called if step numbers may repeat.
  void ForgetAnswers();
  /// Wakes the waiting calls, which then check whether they have ended.
  void Wake();

  bool HasCommand(std::int32_t ship) const { return slots_[Index(ship)]->pending.has_value(); }
  /// Writes the action of each ship; a ship without a command holds. @param actions [ships]
  void WriteActions(std::uint8_t* actions) const;
  /// Stores the answer to the ship's command and removes the command. The ship must have a command.
  /// The caller must call Wake after the last answer.
  void Answer(std::int32_t ship, const aquafarm_msgs::CommandResult& answer);
  /// Stores the answer that accepts a command. The command stays until it is executed.
  void Accept(const ShipCommand& command, const aquafarm_msgs::CommandResult& answer);

  /// Returns true if the farm waits for a command of the ship: the ship is active, is not absent
  /// and has no command.
  bool IsMissing(const aquafarm::Farm& farm, std::int32_t ship) const;
  /// Returns true if no ship is missing.
  bool IsComplete(const aquafarm::Farm& farm) const;
  std::vector<std::int32_t> MissingShips(const aquafarm::Farm& farm) const;
  /// Sets whether a ship is absent: the farm does not wait for an absent ship.
  /// @returns whether the value changed
  bool SetAbsent(std::int32_t ship, bool is_absent) {
    return std::exchange(slots_[Index(ship)]->is_absent, is_absent) != is_absent;
  }
  std::vector<std::int32_t> AbsentShips() const;

 private:
  struct Slot {
    std::optional<ShipCommand> pending;  // command for the next step
    std::uint64_t number{};              // number of the newest command
    std::uint64_t dropped{};             // number of the newest command that Drop removed
    Call* call{};                        // call that waits for the answer; null: no call waits
    RequestLog<ShipCommand, aquafarm_msgs::CommandResult> log;
    std::condition_variable changed;
    bool is_absent{};
  };
  static std::size_t Index(std::int32_t ship) { return static_cast<std::size_t>(ship); }

  std::vector<std::unique_ptr<Slot>> slots_;  // by ship
  std::string drop_reason_;
};

}  // namespace aquafarm_sim
