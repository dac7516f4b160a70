// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The protocol of docs/ros_api.md for a FarmBatch, independent of the transport: pace, commands
/// that are executed exactly once, the lockstep barrier, joint steps, save and load. Every public
/// function may be called from any thread. No function throws after construction: invalid requests
/// return a code and change nothing.
///
///   lockstep:  ship 0 --Command--> waits ----------+--> result of step k+1
///              ship 1 -----------------Command-----+--> result of step k+1   (or TIMEOUT)
///   paced:     ship 0 --Command--> ACCEPTED for step k+1, which the clock triggers

#include <aquafarm_msgs/Claim.h>
#include <aquafarm_msgs/CommandResult.h>
#include <aquafarm_msgs/GetState.h>
#include <aquafarm_msgs/LoadState.h>
#include <aquafarm_msgs/Pause.h>
#include <aquafarm_msgs/Reset.h>
#include <aquafarm_msgs/SaveState.h>
#include <aquafarm_msgs/SetDisaster.h>
#include <aquafarm_msgs/SetPace.h>
#include <aquafarm_msgs/Step.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/observation/farm_batch.h"
#include "aquafarm/scenario/limits.h"
#include "aquafarm_sim/convert/conversions.h"

namespace aquafarm_sim {

/// Limits of the values of requests.
using aquafarm::kMaxFarms;
inline constexpr double kMinRate_hz = 0.001;
inline constexpr double kMaxRate_hz = 1000.0;
/// Max number of cells of all farms together if every episode has a new layout.
inline constexpr std::int64_t kMaxDrawnCells = 64'000'000;
inline constexpr std::size_t kMaxAnswerBytes = std::size_t{256} << 20U;

struct RanchOptions {
  std::int32_t farms{1};
  std::int32_t threads{1};  ///< number of threads that step the farms
  std::uint64_t seed{};
  bool paced{};
  double rate_hz{10.0};
  double barrier_timeout_s{10.0};
  bool late_ships_hold{};  ///< lockstep: after the timeout the farm steps without the late ships
  double claim_timeout_s{10.0};  ///< time without a command of its holder until a claim expires
  std::string map_frame{"map"};
};

/// The command of one ship: an action and its target step.
struct ShipCommand {
  std::int32_t ship{};
  std::uint8_t action{};
  std::uint64_t episode{};
  std::uint64_t step{};
  std::uint64_t token{};
  std::string caller{};  ///< name of the calling node; empty if unknown
  friend bool operator==(const ShipCommand& a, const ShipCommand& b) {
    return a.ship == b.ship && a.action == b.action && a.episode == b.episode && a.step == b.step &&
           a.token == b.token;
  }
  /// True if the command names neither a step nor a token: a retry looks like a new command.
  bool anonymous() const { return episode == 0 && step == 0 && token == 0; }
};

/// Counters for diagnostics.
struct RanchCounters {
  std::uint64_t farm_steps{};  ///< steps, summed over all farms
  std::uint64_t late_ships{};  ///< paced: holds without a command; lockstep: ships gone absent
  std::uint64_t barrier_timeouts{};  ///< lockstep: commands that returned TIMEOUT
  std::uint64_t superseded{};        ///< commands replaced by another one of the same ship
  std::uint64_t dropped_clients{};   ///< expired claims
  std::uint64_t refused{};           ///< requests refused with any other code
  std::uint64_t saves{};             ///< successful save_state calls
  std::vector<std::int32_t> absent;  ///< ships that lockstep does not wait for
  double joint_step_age_s{1e9};      ///< time since the last joint step
  std::string fault;                 ///< error that paused the paced farm; empty if there is none
  std::uint64_t untold{};            ///< number of failed notifications of the listener
  std::string untold_why;            ///< reason of the last failure; empty if there is none
};

/// The current state of the farms. It is valid during the callback, while no farm steps.
struct RanchView {
  const aquafarm::FarmBatch& batch;
  const std::string& yaml;  ///< canonical YAML of the scenario
  MessageContext context;
  std::uint64_t episode_count{};  ///< number of episodes that farm 0 has started
  std::uint64_t version{};        ///< changes whenever farm 0 changes
  bool joint{};  ///< true if a joint step made the last change: no driver needs each observation
};

/// Receives changes while no farm steps. Callbacks must be quick and must not call the ranch.
class RanchListener {
 public:
  virtual ~RanchListener() = default;
  /// Called after farm 0 has stepped or started an episode.
  virtual void OnChange(const RanchView& view) = 0;
  virtual void OnEpisodeEnd(const aquafarm_msgs::EpisodeSummary& summary) = 0;
};

/// Receives everything that determines the farms' episodes, in order, while no farm steps.
/// Callbacks must not call the ranch.
class RanchRecorder {
 public:
  virtual ~RanchRecorder() = default;
  /// Called after farm `number` has started an episode or loaded one.
  /// @param context pace and rate of the ranch at this time
  virtual void OnStart(const aquafarm::Farm& farm, std::int32_t number,
                       const MessageContext& context) = 0;
  /// Called after farm `number` has taken a step. @param actions [agents]
  virtual void OnStep(const aquafarm::Farm& farm, std::int32_t number,
                      const std::uint8_t* actions) = 0;
  /// Called after an external change of farm `number` between two steps.
  virtual void OnIntervention(const aquafarm::Farm& farm, std::int32_t number) = 0;
};

class FarmServer {
 public:
  /// @throws InputError if no layout of the scenario can be generated
  FarmServer(std::shared_ptr<const aquafarm::Scenario> scenario, const RanchOptions& options);

  /// @param listener must stay valid until it is replaced or the ranch ends; null: no listener
  void SetListener(RanchListener* listener);
  /// As SetListener. OnStart is called immediately for the current episode of each farm.
  void SetRecorder(RanchRecorder* recorder);

  /// Executes a command. Lockstep: returns when the step was taken, refused or timed out. Paced:
  /// returns immediately.
  aquafarm_msgs::CommandResult Command(const ShipCommand& command);
  /// Claims a ship for the calling node, or releases the claim.
  void Claim(std::int32_t ship, const std::string& caller, bool release,
             aquafarm_msgs::Claim::Response& response);
  /// As Command, but refuses an action that is not a move.
  aquafarm_msgs::CommandResult MoveShip(const ShipCommand& command);
  /// The response stays valid until the next call of Step. Calls of Step must not overlap.
  /// @param caller name of the calling node; empty if unknown
  const aquafarm_msgs::Step::Response& Step(const aquafarm_msgs::Step::Request& request,
                                            const std::string& caller = {});
  void Reset(const aquafarm_msgs::Reset::Request& request, aquafarm_msgs::Reset::Response& response,
             const std::string& caller = {});
  void GetState(const aquafarm_msgs::GetState::Request& request,
                aquafarm_msgs::GetState::Response& response);
  void SaveState(aquafarm_msgs::SaveState::Response& response);
  void LoadState(const aquafarm_msgs::LoadState::Request& request,
                 aquafarm_msgs::LoadState::Response& response);
  void Pause(const aquafarm_msgs::Pause::Request& request,
             aquafarm_msgs::Pause::Response& response);
  void SetPace(const aquafarm_msgs::SetPace::Request& request,
               aquafarm_msgs::SetPace::Response& response);
  void SetDisaster(const aquafarm_msgs::SetDisaster::Request& request,
                   aquafarm_msgs::SetDisaster::Response& response);

  /// Takes the steps of paced running at their times. Returns after Shutdown.
  void RunPaced();
  /// Takes one paced step of farm 0, or starts its next episode if the current one has ended.
  void Tick();
  /// Makes all waiting and all later commands return SHUTTING_DOWN.
  void Shutdown();

  /// Calls `look` while no farm steps.
  void Inspect(const std::function<void(const RanchView&)>& look);
  RanchCounters counters();
  std::int32_t agents() const { return agents_; }
  const aquafarm::Scenario& scenario() const { return *scenario_; }
  const std::shared_ptr<const aquafarm::Scenario>& shared_scenario() const { return scenario_; }

 private:
  using Clock = std::chrono::steady_clock;
  using Lock = std::unique_lock<std::mutex>;

  /// The commands of one ship.
  struct Slot {
    std::optional<ShipCommand> pending;                    // command for the next step
    std::uint64_t ticket{};                                // number of the newest command
    std::optional<aquafarm_msgs::CommandResult>* reply{};  // of the waiting call; null if none
    std::optional<ShipCommand> last;  // last accepted command; `answer` is its result
    aquafarm_msgs::CommandResult answer;
    std::condition_variable changed;
    bool is_absent{};            // it was late; the farm does not wait for it
    std::string holder;          // node that has claimed it; empty if unclaimed
    Clock::time_point heard_at;  // time of the holder's last command or claim
  };
  struct Refusal {
    std::uint8_t code{};
    std::string message;
  };
  /// Identifies the last accepted request of a kind. Sequence numbers are per client.
  struct IdempotencyKey {
    std::uint64_t sequence{};  // 0: no request
    std::string caller;
    bool IsRepeated(std::uint64_t by_sequence, const std::string& by_caller) const {
      return sequence != 0 && sequence == by_sequence && caller == by_caller;
    }
  };

  std::optional<Refusal> Check(const ShipCommand& command) const;
  aquafarm_msgs::CommandResult Refuse(std::int32_t ship, std::uint8_t code,
                                      const std::string& message);
  aquafarm_msgs::CommandResult AcceptPaced(const ShipCommand& command);
  aquafarm_msgs::CommandResult WaitForOthers(const ShipCommand& command, Lock& lock);
  bool IsMissing(std::int32_t ship) const;
  bool EveryShipHasACommand() const;
  std::string MissingShips() const;
  std::optional<Refusal> MarkPresent(const ShipCommand& command);
  std::optional<Refusal> CheckHolder(std::int32_t ship, const std::string& caller);
  bool IsHeldByAnother(Slot& slot, const std::string& caller);
  void StepWithoutAbsent();
  void StepPublishedFarm();
  void DropPending();
  void DropCommands();
  void Describe(std::int32_t ship, aquafarm_msgs::CommandResult& result) const;
  aquafarm_msgs::CommandResult AnswerOf(std::int32_t ship) const;

  template <typename Response>
  void Answer(std::uint8_t code, const std::string& message, Response& response);
  template <typename Response, typename Request>
  void Guarded(std::uint8_t bad_input, Response& response, Request&& request);
  std::optional<Refusal> Check(const aquafarm_msgs::Step::Request& request,
                               const std::string& caller);
  std::optional<Refusal> CheckAnswerSize(std::int32_t farms, std::uint8_t encodings) const;
  aquafarm::BatchOutput Prepare(std::uint8_t encodings, aquafarm_msgs::StepResult& result) const;
  void Describe(aquafarm_msgs::StepResult& result) const;
  void Complete(const std::uint8_t* actions, aquafarm_msgs::StepResult& result);
  void RecordStarts();
  std::uint64_t NextEpisode() const;
  void StartEpisodes(std::int32_t farms, std::uint64_t seed, std::uint64_t first);
  void IssueForecast(const aquafarm_msgs::SetDisaster::Request& request, std::int32_t first,
                     std::int32_t end, aquafarm_msgs::SetDisaster::Response& response);
  void FillSpec(std::int32_t farm, aquafarm_msgs::FarmSpec& spec) const;
  void ForgetAnswers();

  void Advance();
  void Changed(bool by_joint_step = false);
  void Notify(const std::function<void(RanchListener&)>& telling);
  void EpisodeBegan(bool by_joint_step = false);
  RanchView View() const;

  const std::shared_ptr<const aquafarm::Scenario> scenario_;
  const std::string yaml_;
  const RanchOptions options_;
  const std::int32_t agents_;

  std::mutex mutex_;  // guards all below
  std::unique_ptr<aquafarm::FarmBatch> batch_;
  MessageContext context_;
  std::uint64_t clock_ns_{};
  std::uint32_t steps_to_pause_{};  // 0: no scheduled pause
  std::uint64_t episode_count_{};
  std::uint64_t version_{};
  std::uint64_t turn_;  // StepResult.turn; the start value differs after a restart of the node
  bool ending_{};
  bool changed_jointly_{};  // a joint step made the last change
  std::condition_variable pace_changed_;
  std::vector<std::unique_ptr<Slot>> slots_;
  std::vector<std::uint8_t> actions_;  // scratch, one per ship
  aquafarm::View view_;                // scratch
  RanchListener* listener_{};
  RanchRecorder* recorder_{};
  RanchCounters counters_;
  Clock::time_point joint_step_at_{};  // time of the last joint step; the clock's zero if none

  IdempotencyKey last_step_;
  aquafarm_msgs::Step::Response step_answer_;
  aquafarm_msgs::Step::Response step_refusal_;
  IdempotencyKey last_reset_;
  aquafarm_msgs::Reset::Response reset_answer_;
};

}  // namespace aquafarm_sim
