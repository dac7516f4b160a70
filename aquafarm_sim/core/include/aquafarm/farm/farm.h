// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// One episode on one farm (Algorithm 1; rules in docs/model.md). A step, in this order:
///   MoveDisasters → Act (ships in id order; the lower id has right of way) → Damage → Reward →
///   Finish. Nothing here allocates after construction but Reset of a track set from outside.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/farm/disaster.h"
#include "aquafarm/farm/layout.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/grid/reward.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// A rescue ship, or a self-propelled device acting as a ship of its own.
struct Ship {
  Cell cell{};
  std::int32_t own_device{kNone};  ///< the self-propelled device that it is; kNone: rescue ship
  std::int32_t aboard{};           ///< devices aboard
  bool in_play{true};              ///< false once a self-propelled device is delivered
  Action action{Action::kHold};    ///< of the last step
  Outcome outcome{Outcome::kHeld};
  RewardTerms terms;       ///< of the last step, its own
  float reward{};          ///< of the last step, after sharing
  float episode_return{};  ///< sum of rewards
};

/// A device in play.
struct Device {
  Cell cell{};  ///< where it was deployed or delivered; Farm::CellOf says where it is now
  float value{};
  float health{1.0F};
  std::int32_t carrier{kNone};  ///< ship it is aboard; kNone unless status is kAboard
  DeviceKind kind{};
  DeviceStatus status{DeviceStatus::kDeployed};
  bool self_propelled{};
};

/// What an episode came to, kept as it goes.
struct EpisodeRecord {
  std::uint64_t seed{};
  std::uint64_t episode{};
  std::int32_t steps{};
  float episode_return{};  ///< sum over ships of their own terms
  std::int32_t delivered{};
  std::int32_t devices{};
  float delivered_health{};  ///< sum of health over delivered devices
  std::int32_t crashes{};
  std::int32_t collisions{};
  std::int32_t steps_in_disaster{};  ///< ship-steps spent at a risk
  EndReason reason{};
  /// Whether every device was delivered.
  bool Success() const { return reason == EndReason::kAllRetrieved; }
};

/// One farm; stepping after the end is a programmer's mistake.
class Farm {
 public:
  /// Stands at the start of episode 0 of seed 0.
  /// @param scenario must have passed ValidateScenario
  /// @throws InputError when its layout cannot be drawn
  explicit Farm(std::shared_ptr<const Scenario> scenario);
  /// Shares a fixed layout between farms instead of drawing it again.
  Farm(std::shared_ptr<const Scenario> scenario, std::shared_ptr<const Layout> fixed_layout);

  /// Starts episode `episode` of the sequence `seed`.
  /// @throws InputError when the episode's own layout cannot be drawn; Reset to another then
  void Reset(std::uint64_t seed, std::uint64_t episode);

  /// Takes one step. @param actions one per agent, [AgentCount()], each an Action incl. kHold
  void Step(const std::uint8_t* actions);

  const Scenario& scenario() const { return *scenario_; }
  /// Chart, ports and places of the devices in this episode.
  const Layout& layout() const { return *layout_; }
  /// The same, for other farms of a fixed layout.
  const std::shared_ptr<const Layout>& shared_layout() const { return layout_; }
  /// By id: the rescue ships, then the self-propelled devices, [AgentCount()].
  const std::vector<Ship>& ships() const { return ships_; }
  /// By id, delivered ones too.
  const std::vector<Device>& devices() const { return devices_; }
  /// By id, as they are, whatever a ship knows of them.
  const std::vector<Disaster>& disasters() const { return disasters_; }
  /// Each disaster's waypoints; empty for one that moves on its own.
  const std::vector<Track>& tracks() const { return tracks_; }
  /// What this episode came to so far.
  const EpisodeRecord& record() const { return record_; }
  /// Key of all chance of the sequence of episodes.
  std::uint64_t seed() const { return record_.seed; }
  /// Number of this episode in the sequence, from 0.
  std::uint64_t episode() const { return record_.episode; }
  /// Steps taken in this episode.
  std::int32_t step() const { return record_.steps; }
  /// Why the episode ended; kNone while it goes on.
  EndReason reason() const { return record_.reason; }
  /// Whether the episode has ended; only Reset and Load go on then.
  bool over() const { return record_.reason != EndReason::kNone; }

  /// Worst risk of disasters and sea at a cell of the map now; 0 or negative.
  float RiskAt(Cell cell) const;

  /// Where a device is now: its own cell, or its carrier's.
  Cell CellOf(std::int32_t device) const {
    const Device& one = devices_[static_cast<std::size_t>(device)];
    if (one.carrier != kNone) return ships_[static_cast<std::size_t>(one.carrier)].cell;
    return one.cell;
  }

  /// Which actions would not be ILLEGAL for a ship now. All moves for one out of play.
  ActionMask LegalActions(std::int32_t ship) const;

  /// Hash of the whole state that decides the future and what agents see; equal states give equal
  /// hashes on any machine.
  std::uint64_t Hash() const;

  /// Writes an episode in progress as CBOR bytes.
  std::string Save() const;
  /// Continues a saved episode, bit for bit.
  /// @throws InputError when the bytes are damaged, of another version or of another scenario;
  ///         the farm is then as it was
  void Load(const std::string& bytes);

  /// Replaces disaster `id`, or adds one when id is their number: a bulletin arrives. A spec
  /// without start keeps the present centre (a new one needs a start or a track). Forecasts are
  /// told only of the scenario's own track: a spec has none.
  /// @throws InputError on an id or spec out of range, or forecasts; the farm is then as it was
  void SetDisaster(std::int32_t id, const DisasterSpec& spec);
  /// Most disasters of a farm, those added by bulletins included.
  inline static constexpr std::int32_t kMaxDisasters = 64;

  /// Puts a ship elsewhere, for questions of what it would do there.
  /// @throws InputError when the cell is off the map, blocked or taken; the farm is then as it was
  void PlaceShip(std::int32_t ship, Cell cell);

 private:
  void MoveDisasters();
  void IssueBulletins();
  void Act(std::int32_t id, Action action);
  void Move(Ship& ship, std::int32_t id, Action action);
  void PickUp(Ship& ship, std::int32_t id);
  void DropOff(Ship& ship, std::int32_t id);
  void Damage();
  void Reward();
  void Finish();
  void CrashInto(const Ship& ship, std::int32_t id, std::uint8_t bits);
  void ResetTracks();
  Track Owned(std::size_t id, std::vector<Waypoint> track) const;
  void CheckConsistent() const;
  bool Occupied(std::int32_t index) const;
  void IndexShips();
  std::int32_t DeviceToPickUp(const Ship& ship) const;

  std::shared_ptr<const Scenario> scenario_;
  std::shared_ptr<Layout> own_layout_;  // null when the layout is shared
  std::shared_ptr<const Layout> layout_;
  std::unique_ptr<LayoutGenerator> generator_;
  std::vector<Ship> ships_;
  std::vector<std::int32_t> ship_index_;  // each ship's linear cell; kNone: out of play
  std::vector<Device> devices_;
  std::vector<Disaster> disasters_;
  std::vector<Track> tracks_;
  bool tracks_changed_{};  // by SetDisaster or Load, in this episode
  EpisodeRecord record_;
  std::int32_t remaining_{};  // devices not yet delivered
};

/// Rock or island crashes cost a device aboard this share of its health.
float CrashDamage(const Scenario& scenario, std::uint8_t bits, float crash_reward);

}  // namespace aquafarm
