// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The protocol of ros_api over a FarmBatch, without any transport: who advances time, commands
/// that count exactly once, the lockstep barrier, joint steps, save and load. Every public function
/// may be called from any thread; none throws, wrong requests get a code and change nothing.
///
///   lockstep:  ship 0 --Command--> waits ----------+--> answer of step k+1
///              ship 1 -----------------Command-----+--> answer of step k+1   (or TIMEOUT)
///   paced:     ship 0 --Command--> ACCEPTED for step k+1, which the clock takes

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
#include "aquafarm_sim/convert/conversions.h"

namespace aquafarm_sim {

/// Limits of what a request may ask for.
inline constexpr std::int32_t kMaxFarms = 4096;
inline constexpr double kMinRate_hz = 0.001;
inline constexpr double kMaxRate_hz = 1000.0;
/// Cells of all farms together where each has a layout of its own.
inline constexpr std::int64_t kMaxDrawnCells = 64'000'000;
inline constexpr std::size_t kMaxAnswerBytes = std::size_t{256} << 20U;

struct RanchOptions {
  std::int32_t farms{1};
  std::int32_t threads{1};  ///< that step farms
  std::uint64_t seed{};
  bool paced{};
  double rate_hz{10.0};
  double barrier_timeout_s{10.0};
  bool late_ships_hold{};  ///< lockstep: after the timeout the farm goes on without who is late
  double claim_timeout_s{10.0};  ///< without a command of its holder a claim ends
  std::string map_frame{"map"};
};

/// One ship's command: what for, and for when.
struct ShipCommand {
  std::int32_t ship{};
  std::uint8_t action{};
  std::uint64_t episode{};
  std::uint64_t step{};
  std::uint64_t token{};
  std::string caller{};  ///< node that gave it; empty: not known
  friend bool operator==(const ShipCommand& a, const ShipCommand& b) {
    return a.ship == b.ship && a.action == b.action && a.episode == b.episode && a.step == b.step &&
           a.token == b.token;
  }
  /// Meant for whatever is now, and not to be told from the next of its kind.
  bool anonymous() const { return episode == 0 && step == 0 && token == 0; }
};

/// What went on so far; for diagnostics.
struct RanchCounters {
  std::uint64_t farm_steps{};  ///< over all farms
  std::uint64_t late_ships{};  ///< held for want of a command; in lockstep each that was given up
  std::uint64_t barrier_timeouts{};  ///< lockstep: commands answered TIMEOUT
  std::uint64_t superseded{};        ///< clients that were overtaken by another of the same ship
  std::uint64_t dropped_clients{};   ///< holders of a ship who fell silent and lost it
  std::uint64_t refused{};           ///< requests answered with any other code of refusal
  std::uint64_t saves{};             ///< states handed out by save_state
  std::vector<std::int32_t> absent;  ///< ships that lockstep has given up until they command again
  double joint_step_age_s{1e9};      ///< since the last joint step
  std::string fault;                 ///< why paced running paused itself; empty: it did not
  std::uint64_t untold{};            ///< what the listener missed
  std::string untold_why;            ///< the last time; empty: it missed nothing
};

/// The farms as they stand, seen while nothing moves.
struct RanchView {
  const aquafarm::FarmBatch& batch;
  const std::string& yaml;  ///< canonical text of the scenario
  MessageContext context;
  std::uint64_t episode_count{};  ///< episodes that farm 0 has begun; tells a new one
  std::uint64_t version{};        ///< changes whenever farm 0 does
  bool joint{};  ///< the last change was a joint step's: nobody waits to see each observation
};

/// Is told of changes while nothing moves; must be quick and must not call the ranch.
class RanchListener {
 public:
  virtual ~RanchListener() = default;
  /// Farm 0 has stepped or begun an episode.
  virtual void OnChange(const RanchView& view) = 0;
  virtual void OnEpisodeEnd(const aquafarm_msgs::EpisodeSummary& summary) = 0;
};

/// Is told of all that decides the farms' episodes, in order, while nothing moves; must not call
/// the ranch.
class RanchRecorder {
 public:
  virtual ~RanchRecorder() = default;
  /// Farm `number` has begun an episode, or goes on with a loaded one.
  /// @param context of the ranch then: its pace and rate
  virtual void OnStart(const aquafarm::Farm& farm, std::int32_t number,
                       const MessageContext& context) = 0;
  /// It has taken a step. @param actions [agents]
  virtual void OnStep(const aquafarm::Farm& farm, std::int32_t number,
                      const std::uint8_t* actions) = 0;
  /// Something from outside has changed it between two steps.
  virtual void OnIntervention(const aquafarm::Farm& farm, std::int32_t number) = 0;
};

class Ranch {
 public:
  /// @throws InputError when the scenario cannot be laid out
  Ranch(std::shared_ptr<const aquafarm::Scenario> scenario, const RanchOptions& options);

  /// @param listener must outlive the ranch's use; null: none
  void SetListener(RanchListener* listener);
  /// The same; it is told at once of the episodes that the farms are in.
  void SetRecorder(RanchRecorder* recorder);

  /// Lockstep: returns when the step was taken, refused or timed out. Paced: at once.
  aquafarm_msgs::CommandResult Command(const ShipCommand& command);
  /// Takes a ship for the calling node alone, or gives it back.
  void Claim(std::int32_t ship, const std::string& caller, bool release,
             aquafarm_msgs::Claim::Response& response);
  /// The same as Command for a move, whose action must be one.
  aquafarm_msgs::CommandResult MoveShip(const ShipCommand& command);
  /// The answer stays valid until the next call of Step, which the caller must not overlap.
  /// @param caller node that asks; empty: not known
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

  /// Takes the steps of paced running when they are due; returns after Shutdown.
  void RunPaced();
  /// Takes one paced step of farm 0, or begins its next episode when the present one is over.
  void Tick();
  /// Answers all who wait, and all later commands, with SHUTTING_DOWN.
  void Shutdown();

  /// Calls `look` while nothing moves.
  void Inspect(const std::function<void(const RanchView&)>& look);
  RanchCounters counters();
  std::int32_t agents() const { return agents_; }
  const aquafarm::Scenario& scenario() const { return *scenario_; }
  const std::shared_ptr<const aquafarm::Scenario>& shared_scenario() const { return scenario_; }

 private:
  using Clock = std::chrono::steady_clock;
  using Lock = std::unique_lock<std::mutex>;

  /// What is known of one ship's commands.
  struct Slot {
    std::optional<ShipCommand> pending;                    // for the next step
    std::uint64_t ticket{};                                // of the newest command
    std::optional<aquafarm_msgs::CommandResult>* reply{};  // of who waits for it; null: nobody
    std::optional<ShipCommand> last;  // the last accepted command and its answer
    aquafarm_msgs::CommandResult answer;
    std::condition_variable changed;
    bool is_absent{};            // it was late, and nobody waits for it until it is back
    std::string holder;          // node that has claimed it; empty: none
    Clock::time_point heard_at;  // of the holder's last command or claim
  };
  struct Refusal {
    std::uint8_t code{};
    std::string message;
  };
  /// The last accepted request of its kind; another client's numbers mean nothing.
  struct Numbered {
    std::uint64_t sequence{};  // 0: none
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
  std::optional<Refusal> Hear(const ShipCommand& command);
  std::optional<Refusal> CheckHolder(std::int32_t ship, const std::string& caller);
  bool IsHeldByAnother(Slot& slot, const std::string& caller);
  void GoOnWithoutTheLate();
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
  void FillSpec(std::int32_t farm, aquafarm_msgs::FarmSpec& spec) const;
  void ForgetAnswers();

  void Advance();
  void Changed(bool by_joint_step = false);
  void Tell(const std::function<void(RanchListener&)>& telling);
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
  std::uint32_t steps_to_pause_{};  // 0: it does not pause by itself
  std::uint64_t episode_count_{};
  std::uint64_t version_{};
  std::uint64_t turn_;  // of StepResult; begins so that a node that came back has others
  bool ending_{};
  bool changed_jointly_{};  // the last change was a joint step's
  std::condition_variable pace_changed_;
  std::vector<std::unique_ptr<Slot>> slots_;
  std::vector<std::uint8_t> actions_;  // scratch, one per ship
  aquafarm::View view_;                // scratch
  RanchListener* listener_{};
  RanchRecorder* recorder_{};
  RanchCounters counters_;
  Clock::time_point joint_step_at_{};  // of the last joint step; the clock's zero: none

  Numbered last_step_;
  aquafarm_msgs::Step::Response step_answer_;
  aquafarm_msgs::Step::Response step_refusal_;
  Numbered last_reset_;
  aquafarm_msgs::Reset::Response reset_answer_;
};

}  // namespace aquafarm_sim
