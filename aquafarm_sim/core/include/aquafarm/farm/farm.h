// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// One episode on one farm (Algorithm 1 of the paper; rules in docs/model.md). A step calls, in
/// this order: MoveDisasters; Act for each ship in id order, so that the lower id has right of way;
/// Damage; Consume if the scenario has energy; Reward; CountShipSteps if the scenario has money;
/// Finish.
///
/// Step never allocates memory. Reset allocates only in three cases: its buffers grow, as in the
/// first episodes; another owner still holds the track of a drawn storm; or a disaster of the
/// scenario has grade_factors.

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

/// Forecasts of one disaster that SetDisaster or IssueForecast set during an episode, in order of
/// issue; null if there are none.
using Forecasts = std::shared_ptr<const std::vector<IssuedForecast>>;

/// A rescue ship, or a self-propelled device that acts as a ship.
struct Ship {
  Cell cell{};
  std::int32_t own_device{kNone};  ///< id of the self-propelled device; kNone: rescue ship
  std::int32_t aboard{};           ///< number of devices aboard
  bool active{true};               ///< false once a self-propelled device is delivered
  Action action{Action::kHold};    ///< action in the last step
  Outcome outcome{Outcome::kHeld};
  RewardTerms terms;          ///< terms of this ship in the last step, before sharing
  float reward{};             ///< reward in the last step, after sharing
  float episode_return{};     ///< sum of `reward` in this episode
  double energy{};            ///< energy consumed in the last step [kWh]
  double distance{};          ///< distance travelled in the last step [km]
  double episode_energy{};    ///< sum of `energy` in this episode [kWh]
  double episode_distance{};  ///< sum of `distance` in this episode [km]
};

/// State of a device in an episode.
struct Device {
  Cell cell{};                  ///< current cell; while aboard, the cell of the pickup
  float value{};                ///< value × health is added to the reward of its delivery
  float health{1.0F};           ///< [0, 1]
  std::int32_t carrier{kNone};  ///< id of the ship that carries it; kNone unless status is kAboard
  DeviceKind kind{};
  DeviceStatus status{DeviceStatus::kDeployed};
  bool self_propelled{};
};

/// Statistics of an episode, updated every step.
struct EpisodeRecord : EpisodeStatistics {
  std::int32_t ship_steps{};  ///< ship-steps of rescue ships that are not moored; 0 without money
};

/// Returns the summary of an episode. @param farm index of the farm that played it
EpisodeSummary SummaryOf(const EpisodeRecord& record, std::int32_t farm);

/// Storms that are drawn for the disasters of a farm in the current episode.
struct DrawnStorms {
  std::vector<std::shared_ptr<std::vector<Waypoint>>>
      tracks;                                ///< by disaster; null without DisasterSpec::storms
  std::vector<const ArchivedStorm*> storms;  ///< by disaster; null without DisasterSpec::storms
  StormPlacer placer;
  std::vector<StormErrors> errors;  ///< errors of the last storm placed
};

/// One farm with its current episode. Not thread-safe.
class Farm {
 public:
  /// Creates a farm at the start of episode 0 of seed 0.
  /// @param scenario must have passed ValidateScenario
  /// @throws InputError if the layout cannot be drawn
  explicit Farm(std::shared_ptr<const Scenario> scenario);
  /// Creates a farm that uses a shared layout in all episodes instead of drawing layouts.
  /// @param fixed_layout layout of the same scenario; null: the farm draws layouts
  /// @throws InputError if the farm draws layouts and the first one cannot be drawn
  Farm(std::shared_ptr<const Scenario> scenario, std::shared_ptr<const Layout> fixed_layout);

  /// Starts episode `episode` of the sequence `seed`.
  /// @throws InputError if the layout of the episode cannot be drawn. The farm must then be reset
  ///   to another episode before it is used.
  void Reset(std::uint64_t seed, std::uint64_t episode);

  /// Loads the first ship, device and disaster into the processor's cache. Call it shortly before
  /// Step.
  void Prefetch() const;

  /// Executes one step.
  /// @param actions [AgentCount()], one Action per agent; kHold is allowed
  /// @throws LogicError if the episode has ended, or if the action of an active ship is invalid
  void Step(const std::uint8_t* actions);

  const Scenario& scenario() const { return *scenario_; }
  /// The scenario as a shared pointer, for other farms of the same scenario.
  const std::shared_ptr<const Scenario>& shared_scenario() const { return scenario_; }
  /// Chart, ports and initial cells of the devices in this episode.
  const Layout& layout() const { return *layout_; }
  /// The layout as a shared pointer, for other farms with the same fixed layout.
  const std::shared_ptr<const Layout>& shared_layout() const { return layout_; }
  /// Ships by id: the rescue ships, then the self-propelled devices, [AgentCount()].
  const std::vector<Ship>& ships() const { return ships_; }
  /// Devices by id, including delivered ones.
  const std::vector<Device>& devices() const { return devices_; }
  /// Disasters by id: the true state, independent of what ships observe.
  const std::vector<Disaster>& disasters() const { return disasters_; }
  /// Returns the last bulletin of a disaster. Bulletin::step is kNone if none was issued.
  const Bulletin& BulletinOf(std::size_t disaster) const;
  /// Waypoints of each disaster; empty for a disaster without a track.
  const std::vector<Track>& tracks() const { return tracks_; }
  /// Forecasts of each disaster that were set during this episode. They affect only observations
  /// and plans. NewestForecast (forecast.h) also considers the forecasts of the scenario.
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
  /// Returns whether the episode has ended. Reset starts another one.
  bool over() const { return record_.reason != EndReason::kNone; }
  /// Returns the accounts of an ended episode. Returns nullopt before the end, or if the scenario
  /// has no money.
  std::optional<Accounts> SettleAccounts() const;

  /// Returns the worst current risk of disasters and sea at a cell of the map; 0 or negative.
  float RiskAt(Cell cell) const;
  /// Returns the current risk that damages devices of a kind at a cell of the map. In contrast to
  /// RiskAt, the risk of each disaster is first multiplied by a factor from DamageSpec::kinds.
  float DamagingRiskAt(Cell cell, DeviceKind kind) const;

  /// Returns the current cell of a device: the cell of its carrier, or its own cell without a
  /// carrier.
  Cell CellOf(std::int32_t device) const {
    return CellOf(devices_[static_cast<std::size_t>(device)]);
  }
  /// Overload for a device of this farm.
  Cell CellOf(const Device& device) const {
    // Branch-free: the processor could not predict a branch, because its outcome varies between
    // farms.
    const std::size_t is_aboard = device.carrier == kNone ? 0 : 1;
    const Cell aboard = ships_[is_aboard * static_cast<std::size_t>(device.carrier)].cell;
    const Cell cells[] = {device.cell, aboard};
    return cells[is_aboard];
  }

  /// Returns the legal actions of a ship in the current state. All moves are legal. A ship that is
  /// not active has no other legal action.
  ActionMask LegalActions(std::int32_t ship) const;

  /// Returns a hash of all state that affects later steps or observations. Equal states have equal
  /// hashes on every machine.
  std::uint64_t Hash() const;

  /// Returns a hash of the layout, ships, devices and disasters, without seed and episode number.
  /// Right after Reset it identifies the start of an episode. Two episodes of a scenario with equal
  /// start hashes differ only in later random draws.
  std::uint64_t StartHash() const;

  /// Returns the storm that a disaster drew in this episode; nullptr for a disaster without storms.
  const ArchivedStorm* DrawnStormOf(std::int32_t disaster) const;

  /// Serializes an episode in progress as CBOR bytes.
  std::string Save() const;
  /// Restores an episode written by Save; the episode then continues bit-identically.
  /// @throws InputError if the bytes are damaged or belong to another version or scenario; the farm
  ///   is then unchanged
  void Load(const std::string& bytes);
  /// Copies the episode in progress of a farm of the same scenario. The copy continues
  /// bit-identically. The two farms may have two scenario objects with the same Scenario::hash,
  /// for example a scenario and a copy whose ViewSpec was changed after the hash was set.
  /// @throws LogicError if the hashes of the scenarios differ
  /// @throws InputError if a layout must be drawn for this farm and cannot be drawn. A layout is
  ///   drawn only if exactly one of the two farms needs routes (ViewSpec::NeedsRoutes).
  void CopyStateFrom(const Farm& from);

  /// Replaces disaster `id`, or adds a disaster if `id` is the number of disasters. If the spec has
  /// neither start nor track, the disaster keeps the centre of the one that it replaces. An added
  /// disaster needs a start or a track. The disaster follows the track of the spec. The steps of
  /// the track count from the start of the episode.
  /// Agents receive the forecasts of the spec, which replace those set earlier in this episode. In
  /// partial view, a spec with forecasts also issues a bulletin of the new state at once.
  /// @throws InputError if the id or the spec is invalid or the spec has storms; the farm is then
  ///   unchanged
  void SetDisaster(std::int32_t id, const DisasterSpec& spec);

  /// Applies a forecast of disaster `id`: agents receive it from now on. The disaster itself does
  /// not change. In partial view, a bulletin of the current state is issued at once.
  /// @param forecast its step of issue is not after the current step and not before that of the
  ///   newest forecast that applies. Its last point is after the current step. Its points have as
  ///   many rings as the disaster, or none.
  /// @throws InputError if the id or the forecast is invalid; the farm is then unchanged
  void IssueForecast(std::int32_t id, const IssuedForecast& forecast);

  /// Returns whether PlaceShip may move a ship to a cell. The cell must be on the map and must not
  /// be a rock or island. It must also be a port, the ship's own cell, or a cell without another
  /// active ship.
  /// @throws LogicError if there is no such ship
  bool CanPlaceShip(std::int32_t ship, Cell cell) const;
  /// Moves a ship to another cell, so that the caller can query the agent's action there.
  /// @throws InputError if CanPlaceShip returns false; the farm is then unchanged
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

  // The members that Step uses come first, so that they share cache lines.
  std::shared_ptr<const Scenario> scenario_;
  std::shared_ptr<const Layout> layout_;
  std::vector<Ship> ships_;
  std::vector<std::int32_t> ship_index_;  // LinearIndex of each ship's cell; kNone: not active
  std::vector<Device> devices_;
  std::vector<Disaster> disasters_;
  std::vector<Track> tracks_;
  std::array<double, 2> move_km_{};  // length of a straight and of a diagonal move [km]
  std::int32_t remaining_{};         // number of devices not yet delivered
  bool tracks_changed_{};            // whether SetDisaster or Load has set tracks
  EpisodeRecord record_;

  std::shared_ptr<Layout> own_layout_;  // null if the layout is shared
  std::unique_ptr<LayoutGenerator> generator_;
  std::vector<Forecasts> forecasts_;
  std::vector<Bulletin> bulletins_;     // by disaster; may be empty in full view
  std::unique_ptr<DrawnStorms> drawn_;  // null if no disaster has storms
};

/// Returns the health that each device aboard loses if its ship crashes into a rock or island and
/// the crash causes damage (DamageSpec::crash_probability). A self-propelled device loses the same
/// if it crashes.
/// @param bits CellBits of the rock or island
/// @param crash_reward reward of the crash, 0 or negative
float CrashDamage(const Scenario& scenario, std::uint8_t bits, float crash_reward);

}  // namespace aquafarm
