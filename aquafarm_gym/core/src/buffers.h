// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/numpy.h>

#include <string>
#include <string_view>
#include <vector>

#include "aquafarm/observation/farm_batch.h"

namespace aquafarm::python {

/// Name, type and shape of an array to which a member of BatchOutput points.
struct BufferType {
  std::string name;   ///< name of the member
  std::string dtype;  ///< NumPy name of the type of the values
  std::vector<pybind11::ssize_t> shape;
};

/// Returns the arrays that a batch can write, in the order of BatchOutput. The array `index` is
/// missing if the scenario has too many states for a table (Encoder::state_count is 0).
std::vector<BufferType> BufferTypes(const FarmBatch& batch);

/// Returns a type and a shape as text, such as "uint8 [4, 1, 8, 25, 25]".
std::string Describe(const std::string& dtype, const std::vector<pybind11::ssize_t>& shape);
std::string Describe(const pybind11::array& array);

/// Returns whether an array is writable, aligned and row-major, and has the type and shape of
/// `type`.
bool Fits(const pybind11::array& array, const BufferType& type);

/// Sets the member `name` of `output` to `data`.
void Point(BatchOutput& output, std::string_view name, void* data);

}  // namespace aquafarm::python
