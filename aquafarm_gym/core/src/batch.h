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

/// Returns a summary as Python receives it.
pybind11::dict DictOf(const EpisodeSummary& summary);

/// A FarmBatch with the NumPy arrays that it writes. The batch writes directly into the arrays'
/// memory, so nothing is copied for Python.
class Batch {
 public:
  inline static constexpr std::uint64_t kMaxFarms = 1U << 20U;
  inline static constexpr std::uint64_t kMaxThreads = 1024;

  /// @param write names of the buffers to allocate
  /// @throws InputError for a number out of range or an unknown buffer
  Batch(std::shared_ptr<const Scenario> scenario, pybind11::handle farms,
        const std::vector<std::string>& write, pybind11::handle threads);

  /// Writes into `array` from now on. NumPy does not resize it while it is bound.
  /// @throws InputError if its type or shape does not fit
  void Bind(const std::string& name, const pybind11::array& array);

  void Reset(pybind11::handle seed, pybind11::handle first_episode);
  /// Starts the next episode in the farms selected by `mask` (bool [N]).
  void StartNext(const pybind11::array& mask);
  /// Starts episode episodes[i] of the sequence seeds[i] in the farms selected by `mask`; both
  /// lists have N entries. Later episodes of these farms are `stride` apart.
  void Start(const pybind11::array& mask, const pybind11::sequence& seeds,
             const pybind11::sequence& episodes, pybind11::handle stride);
  /// @throws InputError if the type, shape or range of the actions is wrong, or before the first
  ///   reset
  void Step(const pybind11::array& actions);

  /// Returns the records of the farms whose episode has ended, as dicts.
  pybind11::list Finished() const;
  /// Returns the present state of one farm as text.
  std::string Text(pybind11::handle farm) const;
  /// Calls look(farms), which do not step meanwhile.
  /// @throws std::runtime_error while a call of another thread runs
  template <typename Look>
  void InspectAll(Look look) {
    const Turn turn(busy_);
    look(batch_);
  }
  /// Calls look(encoder, farm) with one farm, which does not step meanwhile.
  /// @throws std::runtime_error while a call of another thread runs
  template <typename Look>
  void Inspect(std::int32_t farm, Look look) const {
    const Turn turn(busy_);
    look(batch_.encoder(), batch_.farm(farm));
  }

  pybind11::bytes Save() const;
  void Load(const std::string& bytes);

  /// Returns everything that another process needs to continue this batch; see FromState.
  pybind11::tuple State() const;
  static std::unique_ptr<Batch> FromState(const pybind11::tuple& state);
  /// Returns whether both have the same scenario, buffers and state.
  bool Equals(const Batch& other) const;

  const FarmBatch& batch() const { return batch_; }
  /// The scenario; Python has no constant objects, and nothing of it can be changed there.
  std::shared_ptr<Scenario> scenario() const {
    return std::const_pointer_cast<Scenario>(scenario_);
  }
  const std::map<std::string, pybind11::array>& buffers() const { return buffers_; }

 private:
  const BufferType& TypeOf(const std::string& name) const;
  void Keep(const BufferType& type, pybind11::array array);
  /// Returns the farms selected by a mask. @throws InputError unless it is bool [N] with a true
  /// entry
  std::vector<std::int32_t> Selected(const pybind11::array& mask) const;
  std::vector<std::string> BufferNames() const;

  std::shared_ptr<const Scenario> scenario_;
  std::int32_t threads_{};
  FarmBatch batch_;
  std::vector<BufferType> types_;
  std::map<std::string, pybind11::array> buffers_;
  /// Weak references to the arrays in use and to the arrays that they are views of. NumPy does not
  /// resize an array with a weak reference, even with refcheck=False.
  std::map<std::string, std::vector<pybind11::weakref>> guards_;
  BatchOutput output_;
  bool is_reset_{};
  mutable bool busy_{};
};

}  // namespace aquafarm::python
