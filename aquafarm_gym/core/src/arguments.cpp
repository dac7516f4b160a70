// SPDX-License-Identifier: BSD-3-Clause
#include "arguments.h"

#include "aquafarm/base/check.h"

namespace aquafarm::python {
namespace py = pybind11;

std::string Given(py::handle argument) {
  constexpr std::size_t kLongest = 60;
  std::string text = py::repr(argument);
  if (text.size() <= kLongest) return text;
  std::size_t end = kLongest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;  // UTF-8
  return text.substr(0, end) + "…";
}

std::uint64_t WholeNumber(py::handle argument, const std::string& where, std::uint64_t low,
                          std::uint64_t high, const std::string& next) {
  const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(argument.ptr()));
  if (number) {
    const std::uint64_t value = PyLong_AsUnsignedLongLong(number.ptr());
    if (PyErr_Occurred() == nullptr && value >= low && value <= high) return value;
  }
  PyErr_Clear();
  throw InputError(where + ": got " + Given(argument) + ", expected a whole number in [" +
                   std::to_string(low) + ", " + std::to_string(high) + "]; " + next);
}

}  // namespace aquafarm::python
