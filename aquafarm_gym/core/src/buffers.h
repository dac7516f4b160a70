// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/numpy.h>

#include <string>
#include <string_view>
#include <vector>

#include "aquafarm/observation/farm_batch.h"

namespace aquafarm::python {

/// One array of BatchOutput, described for NumPy.
struct BufferType {
  std::string name;   ///< of the member of BatchOutput
  std::string dtype;  ///< NumPy's name of the type
  std::vector<pybind11::ssize_t> shape;
};

/// Returns the arrays that a batch can write, in the order of BatchOutput.
std::vector<BufferType> BufferTypes(const FarmBatch& batch);

/// Returns "uint8 [4, 1, 8, 25, 25]".
std::string Describe(const std::string& dtype, const std::vector<pybind11::ssize_t>& shape);
std::string Describe(const pybind11::array& array);

/// Returns true for a writable row-major array of this type and shape.
bool Fits(const pybind11::array& array, const BufferType& type);

/// Sets `data` as the array `name` that a batch writes.
void Point(BatchOutput& output, std::string_view name, void* data);

}  // namespace aquafarm::python
