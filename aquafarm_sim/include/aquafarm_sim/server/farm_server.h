// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The protocol of docs/ros_api.md for a FarmBatch, independent of the transport: retries that are
/// not executed again (RequestLog), the lockstep barrier (CommandBarrier), claims of ships
/// (ClaimTable), pace (PaceClock), joint steps, save and load. All public functions are
/// thread-safe, but calls of Step must not overlap. Requests do not throw: an invalid request
/// returns a code and does not change the farms.
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

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/base/mutex.h"
#include "aquafarm/observation/farm_batch.h"
#include "aquafarm/scenario/limits.h"
#include "aquafarm_sim/convert/conversions.h"
#include "aquafarm_sim/server/claim_table.h"
#include "aquafarm_sim/server/command.h"
#include "aquafarm_sim/server/command_barrier.h"
#include "aquafarm_sim/server/pace_clock.h"
#include "aquafarm_sim/server/request_log.h"

namespace aquafarm_sim {

// Limits of the values of requests.
using aquafarm::kMaxFarms;
inline constexpr double kMinRate_hz = 0.001;
inline constexpr double kMaxRate_hz = 1000.0;
/// Reason of a STALE answer to a client that waited for other ships.
inline constexpr const char* kSteppedByAnother = "another client has stepped the farm";
/// Max number of cells and routes of all farms together if every episode has a new layout.
inline constexpr std::int64_t kMaxDrawnCells = 64'000'000;
/// Max size of the features and planes in one response [bytes].
inline constexpr std::size_t kMaxAnswerBytes = std::size_t{256} << 20U;

struct ServerOptions {
  std::int32_t farms{1};
  std::int32_t threads{1};  ///< number of threads that step the farms
  std::uint64_t seed{};
  bool paced{};
  double rate_hz{10.0};
  double barrier_timeout_s{10.0};
  bool late_ships_hold{};  ///< lockstep: after the timeout the farm steps without the late ships
  /// A claim expires if its holder sends neither a command nor a claim of the ship for this time.
  double claim_timeout_s{10.0};
  std::string map_frame{"map"};
};

/// Counters for diagnostics.
struct ServerCounters {
  std::uint64_t farm_steps{};  ///< number of steps, summed over all farms
  /// Number of times that a ship held because it had no command (paced), or that lockstep stopped
  /// waiting for a ship.
  std::uint64_t late_ships{};
  std::uint64_t barrier_timeouts{};  ///< lockstep: number of commands that returned TIMEOUT
  std::uint64_t superseded{};        ///< number of commands that returned SUPERSEDED
  std::uint64_t dropped_clients{};   ///< number of expired claims
  std::uint64_t refused{};           ///< number of refused requests, for any reason
  std::uint64_t saves{};             ///< number of successful save_state calls
  /// Ids of the ships that lockstep does not wait for. A ship leaves the list with its next
  /// command.
  std::vector<std::int32_t> absent;
  std::vector<std::uint64_t> absences;  ///< by ship: how often lockstep stopped waiting for it
  double joint_step_age_s{1e9};         ///< time since the last joint step; 1e9 before the first
  std::string fault;  ///< last error that paused the paced farm; cleared when the farm resumes
  std::uint64_t dropped_notifications{};  ///< number of failed notifications of the listener
  std::string dropped_reason;             ///< reason of the last failure; empty if there is none
};

/// The current state of the farms. It is valid only during the callback that receives it; no farm
/// steps in that time.
struct ServerView {
  const aquafarm::FarmBatch& batch;
  const std::string& yaml;  ///< canonical YAML of the scenario
  MessageContext context;
  std::uint64_t episode_count{};  ///< number of episodes that farm 0 has started or loaded
  std::uint64_t version{};        ///< increases when farm 0, its pace or its pause changes
  /// True if a joint step made the last change. Ship drivers then do not need every observation.
  bool joint{};
};

/// Receives changes while no farm steps. Callbacks must return quickly and must not call the
/// FarmServer, whose mutex is locked. Their exceptions are counted in ServerCounters.
class FarmListener {
 public:
  virtual ~FarmListener() = default;
  /// Called after a change of farm 0 (a step, a new or loaded episode, set_disaster), of the pace
  /// or of the pause. SetListener also calls it.
  virtual void OnChange(const ServerView& view) = 0;
  /// Called after the last step of an episode of any farm.
  virtual void OnEpisodeEnd(const aquafarm_msgs::EpisodeSummary& summary) = 0;
  /// Called with is_present = false when lockstep stops waiting for some ships, and with true when
  /// one of them sends a command again.
  virtual void OnPresence(const std::vector<std::int32_t>& /*ships*/, bool /*is_present*/) {}
};

/// Receives everything that determines the farms' episodes, in order, while no farm steps.
/// Callbacks must not call the FarmServer, whose mutex is locked. An exception of a callback makes
/// the request or the paced step fail.
class FarmRecorder {
 public:
  virtual ~FarmRecorder() = default;
  /// Called after farm `number` has started or loaded an episode. SetRecorder also calls it.
  /// @param context pace and rate of the farms at this time
  virtual void OnStart(const aquafarm::Farm& farm, std::int32_t number,
                       const MessageContext& context) = 0;
  /// Called after farm `number` has taken a step. @param actions [agents]
  virtual void OnStep(const aquafarm::Farm& farm, std::int32_t number,
                      const std::uint8_t* actions) = 0;
  /// Called after an external change of farm `number` between two steps: a disaster, a forecast or
  /// a loaded state.
  virtual void OnIntervention(const aquafarm::Farm& farm, std::int32_t number) = 0;
};

/// Serves the requests to a batch of farms. Commands of single ships and paced running act on farm
/// 0 only.
class FarmServer {
 public:
  /// @throws InputError if the scenario is a family of ranches, its layout cannot be generated, or
  ///   every episode has a new layout and the layouts of all farms exceed kMaxDrawnCells
  FarmServer(std::shared_ptr<const aquafarm::Scenario> scenario, const ServerOptions& options);

  /// Sets the listener and calls its OnChange; exceptions of this call are not caught.
  /// @param listener must stay valid until it is replaced or the server is destroyed; null: no
  ///        listener
  void SetListener(FarmListener* listener);
  /// Sets the recorder and calls its OnStart for the current episode of each farm.
  /// @param recorder must stay valid until it is replaced or the server is destroyed; null: no
  ///        recorder
  void SetRecorder(FarmRecorder* recorder);

  /// Executes a command. In lockstep the call returns after the step, or when the command is
  /// refused or times out. In paced running the call returns at once.
  aquafarm_msgs::CommandResult Command(const ShipCommand& command);
  /// Claims a ship for the calling node, or releases the claim.
  /// @param ship in [0, agents() - 1]; not checked
  void Claim(std::int32_t ship, const std::string& caller, bool release,
             aquafarm_msgs::Claim::Response& response);
  /// Does the same as Command, but refuses an action that is not a move.
  aquafarm_msgs::CommandResult MoveShip(const ShipCommand& command);
  /// Executes a joint step. The response stays valid until the next call of Step. Calls of Step
  /// must not overlap.
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

  /// Calls Tick whenever a paced step is due. Returns after Shutdown.
  void RunPaced();
  /// Takes one paced step of farm 0, or starts its next episode if the current one has ended. Does
  /// nothing while the farms are paused, or after Shutdown. An error pauses the farms.
  void Tick();
  /// Makes waiting commands return SHUTTING_DOWN, refuses later commands and joint steps, and ends
  /// RunPaced. Retries still return their stored responses.
  void Shutdown();

  /// Calls `look` while no farm steps. `look` must not call the FarmServer.
  void Inspect(const std::function<void(const ServerView&)>& look);
  ServerCounters counters();
  std::int32_t agents() const { return agents_; }
  const aquafarm::Scenario& scenario() const { return *scenario_; }
  const std::shared_ptr<const aquafarm::Scenario>& shared_scenario() const { return scenario_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Refusal {
    std::uint8_t code{};
    std::string message;
  };
  using StepLog = RequestLog<RequestKey, aquafarm_msgs::Step::Response>;
  using ResetLog = RequestLog<RequestKey, aquafarm_msgs::Reset::Response>;

  // Commands of single ships.
  std::optional<Refusal> Check(const ShipCommand& command) const AQUAFARM_REQUIRES(mutex_);
  aquafarm_msgs::CommandResult Refuse(std::int32_t ship, std::uint8_t code,
                                      const std::string& message) AQUAFARM_REQUIRES(mutex_);
  aquafarm_msgs::CommandResult AcceptPaced(const ShipCommand& command) AQUAFARM_REQUIRES(mutex_);
  aquafarm_msgs::CommandResult StepTogether(const ShipCommand& command, aquafarm::MutexLock& lock)
      AQUAFARM_REQUIRES(mutex_);
  aquafarm_msgs::CommandResult RefuseAfter(CommandBarrier::WaitEnd end,
                                           const CommandBarrier::Call& call, std::uint64_t episodes)
      AQUAFARM_REQUIRES(mutex_);
  std::optional<Refusal> MarkPresent(const ShipCommand& command) AQUAFARM_REQUIRES(mutex_);
  std::optional<Refusal> CheckHolder(std::int32_t ship, const std::string& caller)
      AQUAFARM_REQUIRES(mutex_);
  void MarkMissingAbsent() AQUAFARM_REQUIRES(mutex_);
  void StepPublishedFarm() AQUAFARM_REQUIRES(mutex_);
  void DropCommands(const std::string& reason = kSteppedByAnother) AQUAFARM_REQUIRES(mutex_);
  void Describe(std::int32_t ship, aquafarm_msgs::CommandResult& result) const
      AQUAFARM_REQUIRES(mutex_);
  aquafarm_msgs::CommandResult ResultOf(std::int32_t ship) const AQUAFARM_REQUIRES(mutex_);

  // Requests that affect all ships or all farms.
  template <typename Response>
  void Answer(std::uint8_t code, const std::string& message, Response& response)
      AQUAFARM_REQUIRES(mutex_);
  template <typename Response, typename Request>
  void Guarded(std::uint8_t bad_input, Response& response, Request&& request)
      AQUAFARM_REQUIRES(mutex_);
  std::optional<Refusal> Check(const aquafarm_msgs::Step::Request& request,
                               const std::string& caller) AQUAFARM_REQUIRES(mutex_);
  std::optional<Refusal> CheckAnswerSize(std::int32_t farms, std::uint8_t observation_types) const
      AQUAFARM_REQUIRES(mutex_);
  aquafarm::BatchOutput Prepare(std::uint8_t observation_types,
                                aquafarm_msgs::StepResult& result) const AQUAFARM_REQUIRES(mutex_);
  void Describe(aquafarm_msgs::StepResult& result) const AQUAFARM_REQUIRES(mutex_);
  void Complete(const std::uint8_t* actions, aquafarm_msgs::StepResult& result)
      AQUAFARM_REQUIRES(mutex_);
  void RecordStarts() AQUAFARM_REQUIRES(mutex_);
  std::uint64_t NextEpisode() const AQUAFARM_REQUIRES(mutex_);
  void StartEpisodes(std::int32_t farms, std::uint64_t seed, std::uint64_t first,
                     std::uint32_t stride) AQUAFARM_REQUIRES(mutex_);
  void IssueForecast(const aquafarm_msgs::SetDisaster::Request& request, std::int32_t first,
                     std::int32_t end, aquafarm_msgs::SetDisaster::Response& response)
      AQUAFARM_REQUIRES(mutex_);
  static std::unique_ptr<aquafarm::FarmBatch> MakeBatch(
      const std::shared_ptr<const aquafarm::Scenario>& scenario, const ServerOptions& options);
  static std::string DescribeTooManyLayouts(std::int32_t farms, const aquafarm::Farm& farm);
  void FillSpec(std::int32_t farm, aquafarm_msgs::FarmSpec& spec) const AQUAFARM_REQUIRES(mutex_);
  void ForgetAnswers() AQUAFARM_REQUIRES(mutex_);

  void Advance() AQUAFARM_REQUIRES(mutex_);
  void Changed(bool by_joint_step = false) AQUAFARM_REQUIRES(mutex_);
  void Notify(const std::function<void(FarmListener&)>& notify) AQUAFARM_REQUIRES(mutex_);
  void EpisodeBegan(bool by_joint_step = false) AQUAFARM_REQUIRES(mutex_);
  ServerView View() const AQUAFARM_REQUIRES(mutex_);

  const std::shared_ptr<const aquafarm::Scenario> scenario_;
  const std::string yaml_;
  const ServerOptions options_;
  const std::int32_t agents_;

  mutable aquafarm::Mutex mutex_;
  std::unique_ptr<aquafarm::FarmBatch> batch_ AQUAFARM_GUARDED_BY(mutex_);
  CommandBarrier barrier_ AQUAFARM_GUARDED_BY(mutex_);
  ClaimTable claims_ AQUAFARM_GUARDED_BY(mutex_);
  PaceClock clock_ AQUAFARM_GUARDED_BY(mutex_);
  StepLog steps_ AQUAFARM_GUARDED_BY(mutex_);
  aquafarm_msgs::Step::Response step_refusal_ AQUAFARM_GUARDED_BY(mutex_);
  ResetLog resets_ AQUAFARM_GUARDED_BY(mutex_);
  std::uint64_t episode_count_ AQUAFARM_GUARDED_BY(mutex_){};
  std::uint64_t version_ AQUAFARM_GUARDED_BY(mutex_){};
  // StepResult.state_id. The start value differs after a restart of the node.
  std::uint64_t state_id_ AQUAFARM_GUARDED_BY(mutex_);
  bool ending_ AQUAFARM_GUARDED_BY(mutex_){};
  // True if a joint step made the last change.
  bool changed_jointly_ AQUAFARM_GUARDED_BY(mutex_){};
  std::vector<std::uint8_t> actions_ AQUAFARM_GUARDED_BY(mutex_);  // scratch, one per ship
  aquafarm::View view_ AQUAFARM_GUARDED_BY(mutex_);                // scratch
  FarmListener* listener_ AQUAFARM_GUARDED_BY(mutex_){};
  FarmRecorder* recorder_ AQUAFARM_GUARDED_BY(mutex_){};
  ServerCounters counters_ AQUAFARM_GUARDED_BY(mutex_);
  // Time of the last joint step; the clock's zero before the first one.
  Clock::time_point joint_step_at_ AQUAFARM_GUARDED_BY(mutex_){};
};

}  // namespace aquafarm_sim
