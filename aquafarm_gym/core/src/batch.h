// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/observation/farm_batch.h"
#include "buffers.h"
#include "turn.h"

namespace aquafarm::python {

/// Returns a Python dict with the fields of a summary and the bool `success`. The end reason is a
/// name.
pybind11::dict DictOf(const EpisodeSummary& summary);

/// A FarmBatch of N farms with S agents each, and NumPy arrays for its results. The batch writes
/// directly into the memory of the arrays, without a copy. Most functions throw std::runtime_error
/// while a call of another thread runs (Turn).
class Batch {
 public:
  inline static constexpr std::uint64_t kMaxFarms = 1U << 20U;
  inline static constexpr std::uint64_t kMaxThreads = 1024;

  /// @param farms a whole number in [1, kMaxFarms]
  /// @param write names of the buffers to allocate
  /// @param threads a whole number in [1, kMaxThreads]
  /// @throws InputError if a number is out of range, if a buffer is unknown, or in the same cases
  ///   as the constructor of FarmBatch
  Batch(std::shared_ptr<const Scenario> scenario, pybind11::handle farms,
        const std::vector<std::string>& write, pybind11::handle threads);

  /// Uses `array` as the buffer `name` from now on. NumPy refuses to resize an array in use.
  /// @throws InputError if the buffer is unknown, or if `array` does not fit (Fits)
  void Bind(const std::string& name, const pybind11::array& array);

  /// Does the same as FarmBatch::Reset with stride N.
  /// @throws InputError if a number is out of range, or in the same cases as FarmBatch::Reset
  void Reset(pybind11::handle seed, pybind11::handle first_episode);
  /// Starts the next episode in the farms that `mask` (bool [N]) selects.
  /// @throws InputError if the type or shape of `mask` is wrong, if a layout cannot be drawn, or
  ///   before the first reset
  void StartNext(const pybind11::array& mask);
  /// Starts episode episodes[i] of the seed seeds[i] in each farm i that `mask` (bool [N]) selects.
  /// Both lists have N entries. Each later episode of such a farm has a number that is higher by
  /// `stride` (at least 1).
  /// @throws InputError if an argument is wrong, if a layout cannot be drawn, or before the first
  ///   reset
  void Start(const pybind11::array& mask, const pybind11::sequence& seeds,
             const pybind11::sequence& episodes, pybind11::handle stride);
  /// Takes one step in every farm. A farm whose episode has ended starts its next episode instead.
  /// @param actions uint8 [N, S], row-major, each in [0, kActionCount] (kHold allowed)
  /// @throws InputError if the actions are wrong, if a layout cannot be drawn, or before the first
  ///   reset
  void Step(const pybind11::array& actions);

  /// Returns a summary (DictOf) of each farm whose episode has ended, in the order of the farms.
  pybind11::list Finished() const;
  /// Returns the present state of one farm as text (RenderText).
  /// @throws InputError if there is no such farm
  std::string Text(pybind11::handle farm) const;
  /// Returns Farm::StartHash of one farm.
  /// @throws InputError if there is no such farm
  std::uint64_t StartHash(pybind11::handle farm) const;
  /// Calls look(batch). The farms do not step during the call.
  /// @throws std::runtime_error while a call of another thread runs
  template <typename Look>
  void InspectAll(Look look) {
    const Turn turn(busy_);
    look(batch_);
  }
  /// Calls look(encoder, farm) with one farm. The farm does not step during the call.
  /// @param farm number of the farm, in [0, N)
  /// @throws std::runtime_error while a call of another thread runs
  template <typename Look>
  void Inspect(std::int32_t farm, Look look) const {
    const Turn turn(busy_);
    look(batch_.encoder(), batch_.farm(farm));
  }

  /// Returns the state of all farms, without their strides.
  pybind11::bytes Save() const;
  /// Restores saved farms and writes their results. The strides do not change.
  /// @throws InputError in the same cases as FarmBatch::Load
  void Load(const std::string& bytes);

  /// Returns everything that FromState needs to continue this batch in another process.
  pybind11::tuple State() const;
  /// Makes a batch from the result of State.
  /// @throws InputError if the number of parts is wrong, or in the same cases as the constructor
  ///   and Load
  /// @throws pybind11::cast_error if a part has the wrong type
  static std::unique_ptr<Batch> FromState(const pybind11::tuple& state);
  /// Returns whether both batches have the same scenario, buffer names, strides and states of the
  /// farms. Also returns false if only one of them has been reset or loaded.
  bool Equals(const Batch& other) const;

  const FarmBatch& batch() const { return batch_; }
  /// Returns the scenario for Python. The pointer is not const, because Python has no constant
  /// objects. Python code cannot change the scenario.
  std::shared_ptr<Scenario> scenario() const {
    return std::const_pointer_cast<Scenario>(scenario_);
  }
  const std::map<std::string, pybind11::array>& buffers() const { return buffers_; }

 private:
  /// Returns one farm. @throws InputError if there is no such farm
  const Farm& FarmOf(pybind11::handle farm) const;
  const BufferType& TypeOf(const std::string& name) const;
  void Keep(const BufferType& type, pybind11::array array);
  /// Returns the numbers of the farms that a mask selects.
  /// @throws InputError if the mask is not bool [N], or before the first reset
  std::vector<std::int32_t> Selected(const pybind11::array& mask) const;
  std::vector<std::string> BufferNames() const;

  std::shared_ptr<const Scenario> scenario_;
  std::int32_t threads_{};
  FarmBatch batch_;
  std::vector<BufferType> types_;
  std::map<std::string, pybind11::array> buffers_;
  /// Weak references, by buffer, to the array in use and to each array whose memory it uses. NumPy
  /// refuses to resize an array that has a weak reference, even with refcheck=False.
  std::map<std::string, std::vector<pybind11::weakref>> guards_;
  BatchOutput output_;
  bool is_reset_{};
  mutable bool busy_{};
};

}  // namespace aquafarm::python
