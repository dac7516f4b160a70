// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// All parameters of a farm, as plain structs. § marks sections of the paper. [decided] marks
/// defaults that the paper does not give; docs/model.md explains them. scenario_yaml.h reads and
/// writes scenarios as text.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/grid/cell.h"
#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/grid/reward.h"
#include "aquafarm/scenario/enums.h"
#include "aquafarm/scenario/limits.h"
#include "aquafarm/tracks/storm_library.h"
#include "aquafarm/tracks/waypoint.h"

namespace aquafarm {

/// A range of numbers, bounds included. Floats drawn from it are below max, except for rounding.
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

/// Rocks: `count` random cells, or exactly the cells in `cells`. The crash reward of each rock is
/// drawn when the layout is drawn.
struct RockSpec {
  Range<std::int32_t> count{20, 40};  // [decided]
  Range<float> reward{-5.0F, -1.0F};  ///< range of the crash rewards (§2.5)
  std::vector<Cell> cells;            ///< explicit rocks; if not empty, count is not used
};

/// Ports: `count` random water cells, or exactly the cells in `cells`. Random ports are next to an
/// island, or at the edge of the map if there are no islands.
struct PortSpec {
  std::int32_t count{4};  // §2.4
  std::vector<Cell> cells;
};

struct ShipSpec {
  std::int32_t count{1};     ///< rescue ships
  std::int32_t capacity{1};  ///< max number of devices aboard one ship [decided]
};

/// One device of an explicit placement.
struct DeviceSite {
  Cell cell{};
  DeviceKind kind{};
  std::optional<float> value;  ///< if unset: SeaSpec::device_value or DeviceSpec::value
  bool self_propelled{};
  std::optional<double> insured_value{};  ///< if unset: MoneySpec::device_values of the kind
};

/// Devices. With DevicePlacement::kExplicit, `sites` lists them. With another placement there are
/// `count` devices, and device i has kind kinds[i mod kinds.size()].
struct DeviceSpec {
  DevicePlacement placement{DevicePlacement::kRandom};
  std::int32_t count{3};
  std::vector<DeviceKind> kinds{DeviceKind::kTemporaryBreeding, DeviceKind::kMonitoring,
                                DeviceKind::kBreedingRelease, DeviceKind::kDeepWaterBreeding};
  Range<float> value{50.0F, 100.0F};  ///< range of the values drawn for the devices
  float health{1.0F};                 ///< health at the start of an episode, in (0, 1]
  /// Number of self-propelled devices, which have the last ids; not used with kExplicit.
  std::int32_t self_propelled{0};
  std::vector<DeviceSite> sites;  ///< for DevicePlacement::kExplicit
  /// Returns the number of devices.
  std::int32_t Total() const {
    return placement == DevicePlacement::kExplicit ? static_cast<std::int32_t>(sites.size())
                                                   : count;
  }
};

/// A forecast issued by an authority.
struct IssuedForecast {
  float step{};  ///< step of issue; may be negative
  /// Forecast positions in order of time, all after the step of issue. Either all points have
  /// rings, or no point has rings. If the points have no rings, other rings apply; see forecast.h.
  std::vector<Waypoint> points{};
};

/// Random differences between a drawn storm and the recorded one (storms/draw_storm.h). The shifts
/// have mean 0. The factor of the wind is drawn with mean 1; a factor below 0.3 becomes 0.3. The
/// factor of the radii has median 1.
struct StormPerturbation {
  double along_km{};   ///< standard deviation of the shift along the storm's motion
  double across_km{};  ///< standard deviation of the shift across the storm's motion
  double start_h{};    ///< max shift of the time of the closest approach; uniformly distributed
  double intensity{};  ///< standard deviation of the factor of the wind
  double size{};       ///< standard deviation of the logarithm of the factor of the radii
};

/// Recorded storms. In each episode the disaster follows one of them (storms/draw_storm.h).
struct StormsSpec {
  Range<std::int32_t> years;             ///< years of the storms for training
  Range<std::int32_t> evaluation_years;  ///< years of the storms for evaluation; outside `years`
  double within_km{300.0};  ///< max distance of the closest approach to the middle of the farm
  double approach_h{24.0};  ///< hours from step 0 to the closest approach
  StormPerturbation perturbation;
  /// The storms of both ranges of years that have a ring of at least 34 kt and come within
  /// `within_km` of the middle of the farm: the text of an archive (tracks/archive.h).
  std::string tracks;
  /// The storms of `tracks` on the farm; set by the reader of scenarios.
  std::shared_ptr<const StormLibrary> library;
  GradeRisks risks;  ///< risks of the rings for grades 1 to 4; set by the reader of scenarios
};

/// A disaster (DisasterInfo in §2.1) and the parameters of its motion.
struct DisasterSpec {
  DisasterKind kind{DisasterKind::kTyphoon};
  std::int32_t grade{3};                            ///< 1 blue … 4 red
  std::vector<float> radii{2.0F, 4.0F, 6.0F};       ///< [cells], ascending
  std::vector<float> risks{-20.0F, -10.0F, -5.0F};  ///< each in [-20, -5], worst first
  float speed{0.5F};                                ///< [cells/step]
  std::optional<std::int32_t> heading_deg;  ///< compass bearing of the motion; random if unset
  float turn_probability{0.1F};             ///< probability per step of a turn by +-45 degrees
  float radius_growth{0.0F};                ///< [cells/step], added to every radius
  Border border{Border::kReflect};
  std::int32_t duration{1000};                ///< [steps] [decided]
  std::optional<std::array<float, 2>> start;  ///< centre (x, y) [cells]; random if unset
  std::vector<Waypoint> track;  ///< if not empty, determines position, grade, rings and risks
  std::vector<QuadrantRadii> quadrants{};  ///< as in Waypoint
  /// Risks of the rings for grades 1 to 4; empty if unset. Waypoints that specify no risks get
  /// those of their grade. This also applies to the waypoints of bulletins that arrive during an
  /// episode.
  GradeRisks grade_risks{};
  /// Factors of `risks` for grades 1 to 4, an alternative to grade_risks. If both are empty, the
  /// grade does not affect the risks. Waypoints that specify risks keep them.
  std::vector<float> grade_factors{};
  /// Forecasts issued by an authority, in order of issue. Agents observe the newest issued
  /// forecast until the step of its last point. The disaster itself follows the track. Forecasts
  /// require a track; see forecast.h.
  std::vector<IssuedForecast> forecasts{};
  /// If set, every episode draws a storm, which the disaster follows instead of `track`. `track`
  /// then contains the first storm for training, as recorded.
  std::optional<StormsSpec> storms{};
  /// Min wind in each ring [kn], strongest first, one per risk; empty if unknown. Labels, legends
  /// and warnings of pictures and rviz use these winds. They do not affect the farm.
  std::vector<std::int32_t> ring_winds_kt{};
  /// Name of the storm, such as "In-Fa"; may be empty. Pictures and rviz show the name. It does not
  /// affect the farm.
  std::string name{};
};

/// Returns the risks of the rings for grades 1 to 4: grade_risks if set, else `risks` times the
/// factor of the grade (grade_factors), clamped to [kWorstRisk, kMildestRisk]. Empty if grade_risks
/// and grade_factors are both empty.
GradeRisks RisksByGrade(const DisasterSpec& disaster);

/// The rewards of §2.5.
struct RewardSpec : RewardWeights {
  RewardSharing sharing{RewardSharing::kIndividual};
};

/// Factors of the damage that a kind of disaster does to a kind of device: [device][disaster].
using DamageFactors = std::array<std::array<float, kDisasterKindCount>, kDeviceKindCount>;
/// Factors of 1 for all kinds.
inline constexpr DamageFactors kEqualDamage = [] {
  DamageFactors factors{};
  for (auto& row : factors) {
    for (float& factor : row) factor = 1.0F;
  }
  return factors;
}();

struct DamageSpec {
  /// Probability that a crash damages the devices aboard, or the self-propelled device that
  /// crashes, [0, 1].
  float crash_probability{1.0F};
  /// Health that each of these devices loses in a crash into an island.
  float island_damage{0.2F};
  float exposure_damage{0.001F};  ///< health lost per step and unit of |risk|
  /// Factors of exposure_damage. They do not apply to the risk of the sea.
  DamageFactors kinds{kEqualDamage};

  /// Returns the factors for a kind of device, by kind of disaster.
  const std::array<float, kDisasterKindCount>& FactorsOf(DeviceKind kind) const {
    return kinds[static_cast<std::size_t>(kind)];
  }
  /// Returns whether the damage depends on kinds.
  bool DependsOnKinds() const { return kinds != kEqualDamage; }
};

/// Energy consumption of a kind of vessel (farm/energy.h).
struct EnergyFigures {
  double per_km{};         ///< consumption without load in calm water [kWh/km]
  double per_device{};     ///< relative increase of per_km for each device aboard
  double rough_sea{};      ///< relative increase of per_km at the worst risk; linear in the risk
  double idle_per_step{};  ///< added in each step, with or without a move [kWh]
};

/// Energy consumption of all agents.
struct EnergySpec {
  double weight{};               ///< reward that each kWh costs
  EnergyFigures ships;           ///< for rescue ships
  EnergyFigures self_propelled;  ///< for self-propelled devices; per_device has no effect
};

/// Values and prices in a currency, used by the equations of farm/accounts.h and by rescue plans.
/// They affect neither rewards nor observations.
struct MoneySpec {
  /// Name of the unit. A rescue plan uses the prices only if its devices have values in this
  /// currency.
  std::string currency{"CNY"};
  std::array<double, kDeviceKindCount> device_values{};  ///< insured value by DeviceKind
  double ship_hour{};  ///< price of an hour in which a rescue ship is not moored in a port
  double kwh{};        ///< price of a kWh of energy
  /// Share of a device's remaining value that is lost if the device is not delivered when the
  /// episode ends, [0, 1].
  double at_sea_loss{1.0};
};

/// Observation settings of the agents (§2.3).
struct ViewSpec {
  /// Returns whether the features need Layout::routes.
  bool NeedsRoutes() const { return routes || tokens; }

  ViewMode mode{ViewMode::kFull};
  float sensor_radius{5.0F};         ///< range of a ship's sensors in partial view [cells]
  std::int32_t bulletin_period{20};  ///< [steps]; 0: no periodic bulletins
  float bulletin_noise{0.0F};        ///< max error of the reported centre on each axis [cells]
  bool shared_sight{};               ///< agents are networked and use each other's sensors
  bool routes{};  ///< features include the shortest routes by water to ports and devices
  /// Features include the forecast risk after each move. They also include the mean forecast risk
  /// of each straight course (the ship keeps moving in one direction) and of staying.
  bool lookahead_risk{};
  bool tokens{};  ///< entity tokens replace all other features (observation/tokens.h)
  bool kinds{};   ///< features include the kinds of devices, and kinds and grades of disasters
  /// Range of the sensors of deployed monitoring devices in partial view [cells]. All ships use
  /// these sensors. Self-propelled monitoring devices, and those with health 0, have no sensors.
  /// 0: no monitoring device has sensors.
  float monitoring_radius{};
  /// Mean error of a disaster's forecast position after 24, 48 and 72 hours [km]. If not empty,
  /// agents observe a forecast track with this mean error; the disaster itself follows its track.
  /// Issued forecasts take precedence. If the list is empty and no forecast is issued, agents
  /// observe the last known motion. See forecast.h.
  std::vector<float> forecast_error_km{};
  /// If above 0, the features describe disasters by slot: one slot per disaster of the scenario,
  /// plus this number for disasters that arrive during an episode (observation/disaster_slots.h).
  /// If 0, they describe the scenario's own disasters by id.
  std::int32_t disaster_slots{};
  /// Lead times of the forecast positions in a slot [hours], ascending.
  std::vector<float> forecast_leads_h{};
};

/// A field of the sea on the cells of a farm, read from netCDF or given in the scenario.
struct SeaLayer {
  std::string name;           ///< in expressions and topics; a-z, 0-9 and _, the first a letter
  std::string units;          ///< units given by the source; may be empty
  std::vector<float> values;  ///< [H, W] from the south-west; NaN: land or unknown
};

/// Properties of the sea that stay constant during an episode.
struct SeaSpec {
  std::vector<SeaLayer> layers;
  /// Risk of the sea itself at each cell, [H, W]: 0, NaN (unknown) or a number in [-20, -5]. Empty
  /// if unset.
  std::vector<float> risk;
  /// Value of a device at each cell, [H, W]; NaN: the value is drawn from DeviceSpec::value.
  /// DeviceSite::value overrides the value of the cell. Empty if unset.
  std::vector<float> device_value;
};

/// Ranges of the generated ranches of a family; see family.h.
struct FamilySpec {
  Range<std::int32_t> width{12, 60};   ///< [cells]
  Range<std::int32_t> height{12, 60};  ///< [cells]
  Range<std::int32_t> islands{0, 8};   ///< number of blocks; max size: a fifth of the map's sides
  float coast_share{0.3F};             ///< share of ranches with a coast along one side
  Range<float> rocks{0.0F, 0.06F};     ///< share of the cells that are rocks
  Range<std::int32_t> devices{1, 10};
  Range<std::int32_t> ports{1, 6};
  Range<std::int32_t> capacity{1, 3};
  Range<std::int32_t> disasters{0, 4};
  float storm_share{0.0F};  ///< share of ranches with the scenario's own disasters
  Range<float> exposure_damage{0.0F, 0.002F};  ///< range of DamageSpec::exposure_damage
};

/// A complete description of a farm.
struct Scenario {
  std::string name{"unnamed"};
  std::string description;
  std::int32_t width{25};
  std::int32_t height{25};
  double cell_size_m{1000.0};
  double step_duration_s{180.0};
  std::optional<GeoPoint> origin;          ///< the centre of the south-west cell (0, 0)
  std::optional<std::int64_t> start_time;  ///< UTC of step 0 [s since 1970]
  std::int32_t step_limit{5000};           ///< max steps of an episode (§4.2)

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
  std::optional<EnergySpec> energy;  ///< if unset, energy is 0
  ViewSpec view;
  std::optional<SeaSpec> seas;
  std::optional<MoneySpec> money;    ///< if unset, episodes have no accounts
  std::optional<FamilySpec> family;  ///< if set, every episode draws another ranch; see family.h

  /// HashScenario of this scenario, set by the reader. DrawRanch sets another hash, which
  /// identifies the ranch.
  std::uint64_t hash{};

  std::int32_t CellCount() const { return width * height; }
  /// Number of ports, explicit or random.
  std::int32_t PortCount() const {
    return ports.cells.empty() ? ports.count : static_cast<std::int32_t>(ports.cells.size());
  }
  /// Risk of the sea itself at a cell, 0 or negative; 0 if unknown or unset. Excludes disasters.
  float SeaRiskAt(Cell cell) const {
    if (!seas || seas->risk.empty()) return 0.0F;
    const float risk = seas->risk[static_cast<std::size_t>(cell.y * width + cell.x)];
    return risk < 0.0F ? risk : 0.0F;  // NaN (unknown) gives 0
  }
  /// Number of devices that are agents themselves.
  std::int32_t SelfPropelledCount() const;
  /// Number of devices that a ship must fetch.
  std::int32_t FetchableCount() const { return devices.Total() - SelfPropelledCount(); }
  /// Number of rescue ships and self-propelled devices, which is the number of actions per step.
  /// Rescue ships come first.
  std::int32_t AgentCount() const { return ships.count + SelfPropelledCount(); }
};

}  // namespace aquafarm
