// SPDX-License-Identifier: BSD-3-Clause
#include "buffers.h"

#include <type_traits>

#include "aquafarm/base/check.h"

namespace aquafarm::python {
namespace py = pybind11;

namespace {

std::string DtypeOf(const float*) { return "float32"; }
std::string DtypeOf(const std::uint8_t*) { return "uint8"; }
std::string DtypeOf(const std::uint16_t*) { return "uint16"; }
std::string DtypeOf(const std::uint32_t*) { return "uint32"; }
std::string DtypeOf(const std::uint64_t*) { return "uint64"; }

}  // namespace

std::vector<BufferType> BufferTypes(const FarmBatch& batch) {
  using Columns = StepField::Columns;
  const Scenario& scenario = batch.scenario();
  std::vector<BufferType> types;
  BatchOutput none;
  VisitStepFields(
      [&](const StepField& field, const auto* pointer) {
        if (field.bit == kIndexField && batch.encoder().state_count() == 0) return;
        std::vector<py::ssize_t> shape{batch.farms()};
        if (field.rows == StepField::Rows::kAgents) shape.push_back(batch.agents());
        if (field.columns == Columns::kTerms) shape.push_back(kRewardTermCount);
        if (field.columns == Columns::kFeatures) shape.push_back(batch.encoder().feature_count());
        if (field.columns == Columns::kPlanes) {
          shape.insert(shape.end(), {Encoder::kPlaneCount, scenario.height, scenario.width});
        }
        types.push_back({field.name, DtypeOf(pointer), shape});
      },
      none);
  return types;
}

std::string Describe(const std::string& dtype, const std::vector<py::ssize_t>& shape) {
  std::string text = dtype + " [";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(shape[i]);
  }
  return text + "]";
}

std::string Describe(const py::array& array) {
  return Describe(py::str(array.dtype()), {array.shape(), array.shape() + array.ndim()});
}

bool Fits(const py::array& array, const BufferType& type) {
  constexpr int kBlock = py::array::c_style | py::detail::npy_api::NPY_ARRAY_ALIGNED_;
  return array.dtype().equal(py::dtype(type.dtype)) && array.writeable() &&
         (array.flags() & kBlock) == kBlock &&
         std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()) == type.shape;
}

void Point(BatchOutput& output, std::string_view name, void* data) {
  VisitStepFields(
      [&](const StepField& field, auto*& pointer) {
        if (name == field.name) pointer = static_cast<std::decay_t<decltype(pointer)>>(data);
      },
      output);
}

}  // namespace aquafarm::python
