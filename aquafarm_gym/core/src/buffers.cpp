// SPDX-License-Identifier: BSD-3-Clause
#include "buffers.h"

#include "aquafarm/base/check.h"

namespace aquafarm::python {
namespace py = pybind11;

std::vector<BufferType> BufferTypes(const FarmBatch& batch) {
  const py::ssize_t n = batch.farms();
  const py::ssize_t s = batch.agents();
  const Scenario& scenario = batch.scenario();
  std::vector<BufferType> types{
      {"rewards", "float32", {n, s}},
      {"terms", "float32", {n, s, kRewardTermCount}},
      {"outcomes", "uint8", {n, s}},
      {"legal", "uint16", {n, s}},
      {"in_play", "uint8", {n, s}},
      {"reasons", "uint8", {n}},
      {"started", "uint8", {n}},
      {"hashes", "uint64", {n}},
      {"features", "float32", {n, s, batch.encoder().feature_count()}},
      {"planes", "uint8", {n, s, Encoder::kPlaneCount, scenario.height, scenario.width}}};
  if (batch.encoder().state_count() != 0) types.push_back({"index", "uint32", {n, s}});
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
  if (name == "rewards") output.rewards = static_cast<float*>(data);
  if (name == "terms") output.terms = static_cast<float*>(data);
  if (name == "outcomes") output.outcomes = static_cast<std::uint8_t*>(data);
  if (name == "legal") output.legal = static_cast<ActionMask*>(data);
  if (name == "in_play") output.in_play = static_cast<std::uint8_t*>(data);
  if (name == "reasons") output.reasons = static_cast<std::uint8_t*>(data);
  if (name == "started") output.started = static_cast<std::uint8_t*>(data);
  if (name == "hashes") output.hashes = static_cast<std::uint64_t*>(data);
  if (name == "index") output.index = static_cast<std::uint32_t*>(data);
  if (name == "features") output.features = static_cast<float*>(data);
  if (name == "planes") output.planes = static_cast<std::uint8_t*>(data);
}

}  // namespace aquafarm::python
