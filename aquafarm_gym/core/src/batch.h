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

namespace aquafarm::python {

/// A FarmBatch and the NumPy arrays that it writes. The arrays are NumPy's own memory, so nothing
/// is copied on the way to Python.
class Batch {
 public:
  inline static constexpr std::uint64_t kMaxFarms = 1U << 20U;
  inline static constexpr std::uint64_t kMaxThreads = 1024;

  /// @param write names of the buffers to allocate
  /// @throws InputError for a number out of range or a buffer that does not exist
  Batch(std::shared_ptr<const Scenario> scenario, pybind11::handle farms,
        const std::vector<std::string>& write, pybind11::handle threads);

  /// Writes into `array` from now on. NumPy refuses to resize it while it is bound.
  /// @throws InputError when its type or shape does not fit
  void Bind(const std::string& name, const pybind11::array& array);

  void Reset(pybind11::handle seed, pybind11::handle first_episode);
  /// Starts the next episode in the farms that `mask` (bool [N]) selects.
  void StartNext(const pybind11::array& mask);
  /// Starts episode episodes[i] of the sequence seeds[i] in the farms that `mask` selects, both
  /// [N]; later episodes of these farms are `stride` apart.
  void Start(const pybind11::array& mask, const pybind11::sequence& seeds,
             const pybind11::sequence& episodes, pybind11::handle stride);
  /// @throws InputError for actions of another type, shape or range, or before the first reset
  void Step(const pybind11::array& actions);

  /// Records of the episodes that are over, by farm, as dicts.
  pybind11::list Finished() const;
  /// The present state of one farm as text.
  std::string Text(pybind11::handle farm) const;

  pybind11::bytes Save() const;
  void Load(const std::string& bytes);

  /// All that another process needs to continue this batch: see FromState.
  pybind11::tuple State() const;
  static std::unique_ptr<Batch> FromState(const pybind11::tuple& state);
  /// Whether both have the same scenario, buffers and state.
  bool Equals(const Batch& other) const;

  const FarmBatch& batch() const { return batch_; }
  const std::map<std::string, pybind11::array>& buffers() const { return buffers_; }

 private:
  /// Refuses a call while another thread's call runs; taken and returned under the GIL, which
  /// reset and step release in between.
  class Turn;

  const BufferType& TypeOf(const std::string& name) const;
  void Keep(const BufferType& type, pybind11::array array);
  /// The farms that a mask selects. @throws InputError unless it is bool [N] with a true entry
  std::vector<std::int32_t> Selected(const pybind11::array& mask) const;
  std::vector<std::string> BufferNames() const;

  std::shared_ptr<const Scenario> scenario_;
  std::int32_t threads_{};
  FarmBatch batch_;
  std::vector<BufferType> types_;
  std::map<std::string, pybind11::array> buffers_;
  /// Weak references to the arrays in use and to the arrays they are views of: NumPy refuses to
  /// resize an array that has one, even with refcheck=False.
  std::map<std::string, std::vector<pybind11::weakref>> guards_;
  BatchOutput output_;
  bool is_reset_{};
  mutable bool busy_{};
};

}  // namespace aquafarm::python
