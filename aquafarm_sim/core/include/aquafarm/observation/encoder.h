// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Numeric encodings of a view: a tabular index, a feature vector, or H × W planes.
///
/// Tabular index: status_rank · W·H + cell. `cell` is the linear index of the ship's cell.
/// `status_rank` numbers the combinations of the status of all fetchable devices (those that are
/// not self-propelled). Each device is deployed, aboard this ship, or gone (delivered or aboard
/// another ship). A ship of capacity C carries at most C devices, so combinations with more devices
/// aboard have no number. For C = 1 and D devices there are 2^D + D·2^(D−1) combinations. As in the
/// paper, the index does not contain the disaster. The paper states |S| = 128,000 and
/// |O| = 32,000, but its products 25·25·2³·4 and 25·25·2³ are 20,000 and 5,000.
///
/// feature_names() and plane_names() list the features and planes in order.

#include <cstdint>
#include <string>
#include <vector>

#include "aquafarm/grid/action.h"
#include "aquafarm/observation/features.h"
#include "aquafarm/observation/view.h"

namespace aquafarm {

/// Encodes views of one scenario. Immutable after construction.
class Encoder {
 public:
  /// @param scenario must outlive the encoder
  explicit Encoder(const Scenario& scenario);

  /// Number of tabular states; 0 if it exceeds kMaxStates or if the scenario has more than 14
  /// fetchable devices.
  std::uint32_t state_count() const { return state_count_; }
  inline static constexpr std::uint64_t kMaxStates = 1ULL << 28U;
  /// Length of a ship's feature vector.
  std::int32_t feature_count() const { return feature_count_; }
  /// Number of planes of a ship, each [H, W].
  std::int32_t plane_count() const { return kPlaneCount; }
  /// Size of all planes of one ship: plane_count · H · W [bytes].
  std::size_t planes_size() const { return planes_size_; }
  /// Names of the features, in order, [feature_count()].
  std::vector<std::string> feature_names() const;
  /// Names of the planes, in order, [plane_count()].
  static std::vector<std::string> plane_names();
  inline static constexpr std::int32_t kPlaneCount = 8;

  /// Returns the tabular index in [0, state_count()). Full and partial views give the same index,
  /// because both contain the ship's cell and the status of all devices.
  /// @throws LogicError if state_count() is 0
  std::uint32_t Index(const Farm& farm, std::int32_t ship) const;
  std::uint32_t Index(const View& view) const;
  /// A decoded tabular state: the ship's cell and the status of each fetchable device.
  struct TabularState {
    Cell cell{};
    std::vector<DeviceStatus> status;  ///< kDelivered: delivered or aboard another ship
  };
  /// Inverse of Index.
  /// @throws LogicError if `index` is not in [0, state_count())
  TabularState Decode(std::uint32_t index) const;

  /// Writes the feature vector. @param out [feature_count()]
  void Features(const View& view, float* out) const;
  /// Writes the planes. A byte of 255 represents the value 1.
  /// @param out [plane_count(), H, W] row-major, the southernmost row first
  void Planes(const View& view, std::uint8_t* out) const;

 private:
  std::uint32_t IndexOf(std::int32_t code, Cell cell) const;

  const Scenario& scenario_;
  std::vector<FeatureGroup> groups_;
  FeatureScales scales_;
  // Rank by status code, which has one base-3 digit per fetchable device; kNone if more devices are
  // aboard than the capacity allows.
  std::vector<std::int32_t> status_rank_;
  std::vector<std::int32_t> status_code_;  // by rank
  std::uint32_t state_count_{};
  std::int32_t feature_count_{};
  std::int32_t fetchable_{};  // number of devices that are not self-propelled
  std::size_t planes_size_{};
  std::vector<std::uint8_t> sea_plane_;  // [H, W] risk of the sea; empty without `seas.risk`
};

}  // namespace aquafarm
