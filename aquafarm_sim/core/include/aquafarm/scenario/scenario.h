// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Every number of a farm, as plain structs with the defaults of the paper or, where it is silent,
/// of docs/model.md. scenario_yaml.h is the only reader and writer of these as files.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/grid/cell.h"
#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/scenario/enums.h"
#include "aquafarm/scenario/limits.h"

namespace aquafarm {

/// An inclusive range that a number is drawn from.
template <typename T>
struct Range {
  T min{};
  T max{};
};

/// A block of island cells.
struct IslandBlock {
  Cell south_west{};
  std::int32_t width{1};
  std::int32_t height{1};
};

/// Rocks: `count` drawn ones, or exactly the cells of `cells`; each with its own fixed reward.
struct RockSpec {
  Range<std::int32_t> count{20, 40};  // [decided]
  Range<float> reward{-5.0F, -1.0F};  // §2.5
  std::vector<Cell> cells;            ///< explicit rocks; then count is not used
};

/// Ports: `count` drawn water cells at a shore, or exactly `cells`.
struct PortSpec {
  std::int32_t count{4};  // §2.4
  std::vector<Cell> cells;
};

struct ShipSpec {
  std::int32_t count{1};
  std::int32_t capacity{1};  ///< devices aboard at most [decided]
};

/// One device of an explicit placement.
struct DeviceSite {
  Cell cell{};
  DeviceKind kind{};
  std::optional<float> value;  ///< none: drawn from DeviceSpec::value
  bool self_propelled{};
};

/// Devices: `count` placed by `placement`, kinds taken in turn from `kinds`; or `sites`.
struct DeviceSpec {
  DevicePlacement placement{DevicePlacement::kRandom};
  std::int32_t count{3};
  std::vector<DeviceKind> kinds{DeviceKind::kTemporaryBreeding, DeviceKind::kMonitoring,
                                DeviceKind::kBreedingRelease, DeviceKind::kDeepWaterBreeding};
  Range<float> value{50.0F, 100.0F};
  float health{1.0F};  ///< at the start, in (0, 1]
  std::int32_t self_propelled{
      0};                         ///< so many of the drawn devices, the last ones, drive themselves
  std::vector<DeviceSite> sites;  ///< for DevicePlacement::kExplicit
  std::int32_t Total() const {
    return placement == DevicePlacement::kExplicit ? static_cast<std::int32_t>(sites.size())
                                                   : count;
  }
};

/// Radii of a ring to the north-east, south-east, south-west and north-west [cells]; 0: not there.
using QuadrantRadii = std::array<float, 4>;

/// A timed waypoint of a disaster; between two of them everything but grade is interpolated.
struct Waypoint {
  float step{};  ///< steps since the episode's start; may lie before it
  float x{};     ///< [cells]
  float y{};
  std::int32_t grade{1};
  std::vector<float> radii;  ///< [cells], ascending; as many as the disaster has risks
  std::vector<float> risks;  ///< as radii
  /// Rings that are no circles, as many as radii, which are then the largest of each; empty:
  /// circles
  std::vector<QuadrantRadii> quadrants{};
};

/// Where a forecast has a disaster at a step.
struct ForecastPoint {
  float step{};  ///< steps since the episode's start
  float x{};     ///< [cells]
  float y{};
};

/// A forecast as an authority issued it.
struct IssuedForecast {
  float step{};                       ///< of its issue; may lie before the episode's start
  std::vector<ForecastPoint> points;  ///< in order of time, all after its issue
};

/// Risks of the rings by grade, 1 to 4, each the worst first; empty where a scenario gives none.
using GradeRisks = std::vector<std::vector<float>>;

/// DisasterInfo of §2.1, with how it moves.
struct DisasterSpec {
  DisasterKind kind{DisasterKind::kTyphoon};
  std::int32_t grade{3};                            ///< 1 blue … 4 red
  std::vector<float> radii{2.0F, 4.0F, 6.0F};       ///< [cells], ascending
  std::vector<float> risks{-20.0F, -10.0F, -5.0F};  ///< each in [-20, -5], worst first
  float speed{0.5F};                                ///< [cells/step]
  std::optional<std::int32_t> heading_deg;  ///< compass bearing it moves towards; none: drawn
  float turn_probability{0.1F};             ///< each step, by +-45 degrees
  float radius_growth{0.0F};                ///< [cells/step], added to every radius
  Border border{Border::kReflect};
  std::int32_t duration{1000};                ///< [steps] [decided]
  std::optional<std::array<float, 2>> start;  ///< centre (x, y) [cells]; none: drawn
  std::vector<Waypoint> track;                ///< if not empty, it moves along this instead
  std::vector<QuadrantRadii> quadrants{};     ///< as in Waypoint
  GradeRisks grade_risks{};                   ///< what bulletins that come later bring, too
  /// What an authority forecast of it, in order of issue: agents are told the newest one issued,
  /// and the truth follows the track. Only with a track; see forecast.h.
  std::vector<IssuedForecast> forecasts{};
};

/// The rewards of §2.5.
struct RewardSpec {
  float island_crash{-20.0F};
  float pickup{20.0F};
  float drop_off{20.0F};
  float illegal{-10.0F};
  float collision{-5.0F};  // [decided]
  float step{-1.0F};
  RewardSharing sharing{RewardSharing::kIndividual};
};

struct DamageSpec {
  float crash_probability{1.0F};
  float island_damage{0.2F};      ///< health lost aboard in a crash on an island
  float exposure_damage{0.001F};  ///< health lost per step and unit of |risk|
};

/// What an agent sees (§2.3).
struct ViewSpec {
  ViewMode mode{ViewMode::kFull};
  float sensor_radius{5.0F};
  std::int32_t bulletin_period{20};  ///< [steps]; 0: no bulletins
  float bulletin_noise{0.0F};        ///< centre off by up to this on each axis [cells]
  bool shared_sight{};               ///< agents are networked: what one of them sees, all know
  bool waterways{};  ///< features tell the way by water to ports and devices, as a chart plotter
  bool courses{};    ///< features tell the risk forecast along each course
  /// Mean error of a disaster's forecast position after 24, 48 and 72 hours [km]: agents are told
  /// a forecast track that errs so much, and the truth follows the track; empty: they are told
  /// how it moves now. See forecast.h.
  std::vector<float> forecast_error_km{};
};

/// A field of the sea on the cells of a farm, from netCDF or as given.
struct SeaLayer {
  std::string name;           ///< in expressions and topics: a-z, 0-9 and _, a letter first
  std::string units;          ///< as its source says; may be empty
  std::vector<float> values;  ///< [H, W] from the south-west; NaN: land or unknown
};

/// The sea as it stays during an episode.
struct SeaSpec {
  std::vector<SeaLayer> layers;
  /// Risk at each cell whatever the disasters do, [H, W]: 0, NaN (none known) or in [-20, -5];
  /// empty: none
  std::vector<float> risk;
  /// Value of a device drawn at each cell, [H, W]; NaN: drawn as elsewhere; empty: none
  std::vector<float> device_value;
};

/// A whole farm.
struct Scenario {
  std::string name{"unnamed"};
  std::string description;
  std::int32_t width{25};
  std::int32_t height{25};
  double cell_size_m{1000.0};
  double step_duration_s{180.0};
  std::optional<GeoPoint> origin;          ///< the centre of the south-west cell (0, 0)
  std::optional<std::int64_t> start_time;  ///< UTC of step 0 [s since 1970]
  std::int32_t step_limit{5000};           // §4.2

  LayoutMode layout{LayoutMode::kFixed};
  std::uint64_t layout_seed{1};
  std::vector<IslandBlock> islands;
  RockSpec rocks;
  PortSpec ports;
  ShipSpec ships;
  DeviceSpec devices;
  std::vector<DisasterSpec> disasters;
  RewardSpec rewards;
  DamageSpec damage;
  ViewSpec view;
  std::optional<SeaSpec> seas;

  /// Hash of the canonical file text; set by the reader, the same for files that mean the same.
  std::uint64_t hash{};

  std::int32_t CellCount() const { return width * height; }
  /// Ports, chosen or drawn.
  std::int32_t PortCount() const {
    return ports.cells.empty() ? ports.count : static_cast<std::int32_t>(ports.cells.size());
  }
  /// Risk of the sea itself at a cell; 0 where it has none.
  float SeaRiskAt(Cell cell) const {
    if (!seas || seas->risk.empty()) return 0.0F;
    const float risk = seas->risk[static_cast<std::size_t>(cell.y * width + cell.x)];
    return risk < 0.0F ? risk : 0.0F;  // NaN: nothing known
  }
  /// Devices that are agents of their own.
  std::int32_t SelfPropelledCount() const;
  /// Devices that a ship must fetch.
  std::int32_t FetchableCount() const { return devices.Total() - SelfPropelledCount(); }
  /// Ships and self-propelled devices: the number of actions a step takes. Rescue ships come first.
  std::int32_t AgentCount() const { return ships.count + SelfPropelledCount(); }
};

}  // namespace aquafarm
