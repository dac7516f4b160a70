// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <aquafarm_msgs/CommandResult.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "aquafarm/base/mutex.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm_sim/server/command.h"
#include "aquafarm_sim/server/request_log.h"

namespace aquafarm_sim {

/// Collects the ships' commands for the next step of a farm: at most one per ship, the newest. In
/// lockstep each call waits until all ships have a command. The owner holds one mutex during every
/// call. Wait releases it while it waits.
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

  /// Returns the answer of the ship's last executed or accepted command if `command` repeats it;
  /// null otherwise.
  const aquafarm_msgs::CommandResult* FindAnswer(const ShipCommand& command) const;
  /// Stores a command for the next step. It supersedes an earlier command of the ship.
  /// @param call receives the answer and must stay valid until it is answered, superseded or
  /// withdrawn; null: no call waits
  void Add(const ShipCommand& command, Call* call);
  /// Waits until the call is answered, superseded or dropped, until `deadline`, or until `ending`
  /// is true (kTimedOut).
  WaitEnd Wait(aquafarm::MutexLock& lock, const Call& call, Clock::time_point deadline,
               const bool& ending);
  /// Removes the command of a call that waits no longer.
  void Withdraw(const Call& call);
  /// Removes all commands. Their calls end with kDropped.
  void Drop();
  /// Also forgets the last answers, because step numbers may repeat.
  void ForgetAnswers();
  /// Makes all waiting calls look whether they are over.
  void Wake();

  bool HasCommand(std::int32_t ship) const { return slots_[Index(ship)]->pending.has_value(); }
  /// Writes the action of each ship; a ship without a command holds. @param actions [ships]
  void WriteActions(std::uint8_t* actions) const;
  /// Stores the answer of the ship's command, which is over. Call Wake when all ships are answered.
  void Answer(std::int32_t ship, const aquafarm_msgs::CommandResult& answer);
  /// Stores the answer with which the ship's command was accepted; the command stays.
  void Accept(const ShipCommand& command, const aquafarm_msgs::CommandResult& answer);

  /// Returns true if the farm waits for a command of the ship.
  bool IsMissing(const aquafarm::Farm& farm, std::int32_t ship) const;
  bool IsComplete(const aquafarm::Farm& farm) const;
  std::vector<std::int32_t> MissingShips(const aquafarm::Farm& farm) const;
  /// The farm does not wait for an absent ship. @returns whether this changes anything
  bool SetAbsent(std::int32_t ship, bool is_absent) {
    return std::exchange(slots_[Index(ship)]->is_absent, is_absent) != is_absent;
  }
  std::vector<std::int32_t> AbsentShips() const;

 private:
  struct Slot {
    std::optional<ShipCommand> pending;  // command for the next step
    std::uint64_t number{};              // of the newest command
    Call* call{};                        // that waits for the answer; null if none
    RequestLog<ShipCommand, aquafarm_msgs::CommandResult> log;
    std::condition_variable changed;
    bool is_absent{};
  };
  static std::size_t Index(std::int32_t ship) { return static_cast<std::size_t>(ship); }

  std::vector<std::unique_ptr<Slot>> slots_;  // by ship
};

}  // namespace aquafarm_sim
