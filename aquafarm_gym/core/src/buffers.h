// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/numpy.h>

#include <string>
#include <string_view>
#include <vector>

#include "aquafarm/observation/farm_batch.h"

namespace aquafarm::python {

/// One array of BatchOutput as NumPy knows it.
struct BufferType {
  std::string name;   ///< of the member of BatchOutput
  std::string dtype;  ///< as NumPy spells it
  std::vector<pybind11::ssize_t> shape;
};

/// The arrays that a batch can write, in the order of BatchOutput.
std::vector<BufferType> BufferTypes(const FarmBatch& batch);

/// "uint8 [4, 1, 8, 25, 25]".
std::string Describe(const std::string& dtype, const std::vector<pybind11::ssize_t>& shape);
std::string Describe(const pybind11::array& array);

/// True for an array of this type and shape that can be written as one row-major block.
bool Fits(const pybind11::array& array, const BufferType& type);

/// Lets a batch write `data` as its array `name`.
void Point(BatchOutput& output, std::string_view name, void* data);

}  // namespace aquafarm::python
