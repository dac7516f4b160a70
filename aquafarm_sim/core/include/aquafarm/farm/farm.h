// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// One episode on one farm (Algorithm 1; rules in docs/model.md). A step, in this order:
///   MoveDisasters → Act (ships in id order; the lower id has right of way) → Damage → Consume (if
///   the scenario has energy) → Reward → Finish. Step never allocates. Reset allocates only after
///   SetDisaster or Load has set a track, or if another owner still holds the drawn storm's track.

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/farm/accounts.h"
#include "aquafarm/farm/disaster.h"
#include "aquafarm/farm/layout.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/grid/episode_summary.h"
#include "aquafarm/grid/reward.h"
#include "aquafarm/scenario/scenario.h"
#include "aquafarm/tracks/place_storm.h"

namespace aquafarm {

class Hasher;
struct SavedDisaster;

/// Forecasts of one disaster that were issued during an episode, in order of issue; null: none.
using Forecasts = std::shared_ptr<const std::vector<IssuedForecast>>;

/// A rescue ship, or a self-propelled device that acts as a ship.
struct Ship {
  Cell cell{};
  std::int32_t own_device{kNone};  ///< id of the self-propelled device; kNone: rescue ship
  std::int32_t aboard{};           ///< devices aboard
  bool active{true};               ///< false once a self-propelled device is delivered
  Action action{Action::kHold};    ///< in the last step
  Outcome outcome{Outcome::kHeld};
  RewardTerms terms;          ///< of this ship in the last step, before sharing
  float reward{};             ///< in the last step, after sharing
  float episode_return{};     ///< sum of rewards
  double energy{};            ///< consumed in the last step [kWh]
  double distance{};          ///< travelled in the last step [km]
  double episode_energy{};    ///< sum of energy [kWh]
  double episode_distance{};  ///< sum of distance [km]
};

/// State of a device in an episode.
struct Device {
  Cell cell{};  ///< where it was deployed or delivered; Farm::CellOf returns its current cell
  float value{};
  float health{1.0F};
  std::int32_t carrier{kNone};  ///< ship that carries it; kNone unless status is kAboard
  DeviceKind kind{};
  DeviceStatus status{DeviceStatus::kDeployed};
  bool self_propelled{};
};

/// Statistics of an episode, updated every step.
struct EpisodeRecord : EpisodeStatistics {
  std::int32_t ship_steps{};  ///< steps of rescue ships not moored in a port; 0 without money
};

/// Returns the summary of an episode that the farm with index `farm` played.
EpisodeSummary SummaryOf(const EpisodeRecord& record, std::int32_t farm);

/// Storms drawn for the disasters of a farm in the present episode.
struct DrawnStorms {
  std::vector<std::shared_ptr<std::vector<Waypoint>>>
      tracks;                                ///< by disaster; null if it draws none
  std::vector<const ArchivedStorm*> storms;  ///< by disaster; null if it draws none
  StormPlacer placer;
  std::vector<StormErrors> errors;  ///< of the storm that is placed
};

/// One farm. Calling Step after the end of an episode is a programming error.
class Farm {
 public:
  /// Creates a farm at the start of episode 0 of seed 0.
  /// @param scenario must have passed ValidateScenario
  /// @throws InputError when its layout cannot be drawn
  explicit Farm(std::shared_ptr<const Scenario> scenario);
  /// Creates a farm that uses a shared fixed layout instead of drawing its own.
  Farm(std::shared_ptr<const Scenario> scenario, std::shared_ptr<const Layout> fixed_layout);

  /// Starts episode `episode` of the sequence `seed`.
  /// @throws InputError when the episode's layout cannot be drawn; call Reset with another episode
  void Reset(std::uint64_t seed, std::uint64_t episode);

  /// Loads the first ship, device and disaster into the cache; helps if Step follows some 50 ns
  /// later.
  void Prefetch() const;

  /// Executes one step. @param actions one per agent, [AgentCount()], each an Action incl. kHold
  void Step(const std::uint8_t* actions);

  const Scenario& scenario() const { return *scenario_; }
  /// The scenario as a shared pointer, for other farms of the same scenario.
  const std::shared_ptr<const Scenario>& shared_scenario() const { return scenario_; }
  /// Chart, ports and initial device cells of this episode.
  const Layout& layout() const { return *layout_; }
  /// The layout as a shared pointer, for other farms with the same fixed layout.
  const std::shared_ptr<const Layout>& shared_layout() const { return layout_; }
  /// Ships by id: the rescue ships, then the self-propelled devices, [AgentCount()].
  const std::vector<Ship>& ships() const { return ships_; }
  /// Devices by id, including delivered ones.
  const std::vector<Device>& devices() const { return devices_; }
  /// Disasters by id: the true state, independent of what ships observe.
  const std::vector<Disaster>& disasters() const { return disasters_; }
  /// Returns the last bulletin of a disaster; its step is kNone if none was issued.
  const Bulletin& BulletinOf(std::size_t disaster) const;
  /// Waypoints of each disaster; empty for a disaster without a track.
  const std::vector<Track>& tracks() const { return tracks_; }
  /// Forecasts of each disaster that were issued during this episode. Agents receive them. They
  /// have no effect on the disasters; forecast.h merges them with the scenario's.
  const std::vector<Forecasts>& forecasts() const { return forecasts_; }
  /// Statistics of this episode so far.
  const EpisodeRecord& record() const { return record_; }
  /// Random seed of the sequence of episodes.
  std::uint64_t seed() const { return record_.seed; }
  /// Number of this episode in the sequence, from 0.
  std::uint64_t episode() const { return record_.episode; }
  /// Steps taken in this episode.
  std::int32_t step() const { return record_.steps; }
  /// Reason why the episode ended; kNone while it runs.
  EndReason reason() const { return record_.reason; }
  /// Whether the episode has ended; call Reset or Load to continue.
  bool over() const { return record_.reason != EndReason::kNone; }
  /// Returns the accounts of an episode that has ended; nullopt before its end and without `money`.
  std::optional<Accounts> SettleAccounts() const;

  /// Returns the current worst risk of disasters and sea at a cell of the map; 0 or negative.
  float RiskAt(Cell cell) const;
  /// Returns the current risk of disasters and sea that damages a kind of device at a cell of the
  /// map: that of RiskAt, with each disaster's risk times its factor of damage.kinds.
  float DamagingRiskAt(Cell cell, DeviceKind kind) const;

  /// Returns the current cell of a device: its own cell, or the cell of its carrier.
  Cell CellOf(std::int32_t device) const {
    return CellOf(devices_[static_cast<std::size_t>(device)]);
  }
  /// As above. @param device of this farm
  Cell CellOf(const Device& device) const {
    // Branch-free: farms differ in it, so a branch would be mispredicted.
    const std::size_t is_aboard = device.carrier == kNone ? 0 : 1;
    const Cell aboard = ships_[is_aboard * static_cast<std::size_t>(device.carrier)].cell;
    const Cell cells[] = {device.cell, aboard};
    return cells[is_aboard];
  }

  /// Returns the legal actions of a ship in the current state; all moves if it is out of play.
  ActionMask LegalActions(std::int32_t ship) const;

  /// Returns a hash of all state that affects the future or the observations. Equal states give
  /// equal hashes on every machine.
  std::uint64_t Hash() const;

  /// Returns a hash of the layout, ships, devices and disasters, without seed and episode number.
  /// Right after Reset it identifies the start of an episode: two episodes with equal hashes differ
  /// at most in later random draws.
  std::uint64_t StartHash() const;

  /// Returns the storm that a disaster drew in this episode; nullptr for a disaster without storms.
  const ArchivedStorm* DrawnStormOf(std::int32_t disaster) const;

  /// Serializes an episode in progress as CBOR bytes.
  std::string Save() const;
  /// Restores a saved episode, which then continues bit-identically.
  /// @throws InputError when the bytes are damaged or belong to another version or scenario; the
  ///         farm is then unchanged
  void Load(const std::string& bytes);
  /// Becomes a copy of a farm of the same scenario, with its episode in progress, and then
  /// continues bit-identically. The scenarios may be two objects, which may differ in what ships
  /// observe.
  /// @throws InputError when the layout has to be drawn again for other observations and cannot be
  void CopyStateFrom(const Farm& from);

  /// Applies a bulletin: replaces disaster `id`, or adds a disaster when `id` equals their number.
  /// A spec without start keeps the current centre; a new disaster needs a start or a track. The
  /// track is the truth, and the spec's forecasts are what agents receive. They replace those
  /// issued before; with forecasts, the bulletin is issued at once.
  /// @throws InputError on an id or spec out of range; the farm is then unchanged
  void SetDisaster(std::int32_t id, const DisasterSpec& spec);

  /// Applies a forecast of disaster `id`: from now on agents receive it, with a bulletin that is
  /// issued at once. The disaster itself does not change.
  /// @param forecast issued at the present step or earlier, not before the newest one in force,
  ///   with a point after the present step; its rings are as many as those of the disaster
  /// @throws InputError on an id or forecast out of range; the farm is then unchanged
  void IssueForecast(std::int32_t id, const IssuedForecast& forecast);

  /// Returns whether PlaceShip may move a ship to a cell: one on the map that is not blocked, and
  /// that no other ship occupies unless it is a port.
  bool CanPlaceShip(std::int32_t ship, Cell cell) const;
  /// Moves a ship to another cell, to query an agent's behaviour there.
  /// @throws InputError unless CanPlaceShip; the farm is then unchanged
  void PlaceShip(std::int32_t ship, Cell cell);

 private:
  void MoveDisasters();
  void IssueBulletins();
  void IssueBulletin(std::size_t id);
  void LoadDisasters(std::vector<SavedDisaster> saved);
  void Act(std::int32_t id, Action action);
  void Move(Ship& ship, std::int32_t id, Action action);
  void PickUp(Ship& ship, std::int32_t id);
  void DropOff(Ship& ship, std::int32_t id);
  void Damage();
  void Consume(const EnergySpec& energy);
  void Reward();
  void Finish();
  void CountShipSteps();
  void CrashInto(const Ship& ship, std::int32_t id, std::uint8_t bits);
  void ResetTracks();
  void DrawStorms();
  std::vector<Waypoint>& DrawnTrack(std::size_t id);
  void CopyTracksFrom(const Farm& from);
  void HashState(Hasher& hasher) const;
  Track Owned(std::size_t id, std::vector<Waypoint> track) const;
  void CheckConsistent() const;
  bool Occupied(std::int32_t index) const;
  void IndexShips();
  std::int32_t DeviceToPickUp(const Ship& ship) const;

  // What a step uses comes first, so that it takes few cache lines.
  std::shared_ptr<const Scenario> scenario_;
  std::shared_ptr<const Layout> layout_;
  std::vector<Ship> ships_;
  std::vector<std::int32_t> ship_index_;  // each ship's linear cell; kNone: out of play
  std::vector<Device> devices_;
  std::vector<Disaster> disasters_;
  std::vector<Track> tracks_;
  std::array<double, 2> move_km_{};  // length of a straight and of a diagonal move
  std::int32_t remaining_{};         // devices not yet delivered
  bool tracks_changed_{};            // by SetDisaster or Load during this episode
  EpisodeRecord record_;

  std::shared_ptr<Layout> own_layout_;  // null when the layout is shared
  std::unique_ptr<LayoutGenerator> generator_;
  std::vector<Forecasts> forecasts_;
  std::vector<Bulletin> bulletins_;     // by disaster; may be empty if none was issued
  std::unique_ptr<DrawnStorms> drawn_;  // null: no disaster has storms
};

/// Returns the fraction of its health that a device aboard loses in a crash into a rock or island.
float CrashDamage(const Scenario& scenario, std::uint8_t bits, float crash_reward);

}  // namespace aquafarm
