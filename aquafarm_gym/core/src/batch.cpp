// SPDX-License-Identifier: BSD-3-Clause
#include "batch.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/farm_text.h"
#include "arguments.h"

namespace aquafarm::python {
namespace py = pybind11;
namespace {

constexpr std::uint64_t kAnyNumber = std::numeric_limits<std::uint64_t>::max();

std::int32_t CheckFarms(py::handle farms) {
  return static_cast<std::int32_t>(WholeNumber(farms, "FarmBatch: farms", 1, Batch::kMaxFarms,
                                               "pass the number of farms to step together"));
}

std::int32_t CheckThreads(py::handle threads) {
  return static_cast<std::int32_t>(WholeNumber(threads, "FarmBatch: threads", 1, Batch::kMaxThreads,
                                               "pass the number of threads to step with"));
}

std::uint64_t CheckSeed(py::handle seed) {
  return WholeNumber(seed, "FarmBatch: seed", 0, kAnyNumber, "pass a seed of this range");
}

std::uint64_t CheckEpisode(py::handle episode) {
  return WholeNumber(episode, "FarmBatch: episode", 0, kAnyNumber, "number episodes from 0");
}

// Returns the current name of a buffer. Warns if `name` is its name in version 0.1.0.
std::string CurrentName(const std::string& name) {
  return py::module_::import("aquafarm_core._names").attr("current")(name).cast<std::string>();
}

// Converts a statistic for Python. An end reason becomes its name; a number stays the same.
template <typename T>
T ForPython(T value) {
  return value;
}
std::string_view ForPython(EndReason reason) { return ToString(reason); }

}  // namespace

py::dict DictOf(const EpisodeSummary& summary) {
  py::dict one;
  one["farm"] = summary.farm;
  VisitEpisodeFields(
      [&one](const EpisodeField& field, auto value) { one[field.name] = ForPython(value); },
      summary);
  one["success"] = summary.Success();
  return one;
}

Batch::Batch(std::shared_ptr<const Scenario> scenario, py::handle farms,
             const std::vector<std::string>& write, py::handle threads)
    : scenario_(std::move(scenario)),
      threads_(CheckThreads(threads)),
      batch_(scenario_, CheckFarms(farms), threads_),
      types_(BufferTypes(batch_)) {
  for (const std::string& name : write) {
    const BufferType& type = TypeOf(CurrentName(name));
    py::array array(py::dtype(type.dtype), type.shape);
    std::memset(array.mutable_data(), 0, static_cast<std::size_t>(array.nbytes()));
    Keep(type, std::move(array));
  }
}

void Batch::Bind(const std::string& name, const py::array& array) {
  const Turn turn(busy_);
  const BufferType& type = TypeOf(CurrentName(name));
  if (!Fits(array, type)) {
    throw InputError(name + ": got " + Describe(array) + ", expected writeable row-major " +
                     Describe(type.dtype, type.shape));
  }
  Keep(type, array);
}

void Batch::Reset(py::handle seed, py::handle first_episode) {
  const Turn turn(busy_);
  const std::uint64_t sequence = CheckSeed(seed);
  const std::uint64_t first = CheckEpisode(first_episode);
  const py::gil_scoped_release release;
  batch_.Reset(sequence, first, output_);
  is_reset_ = true;
}

std::vector<std::int32_t> Batch::Selected(const py::array& mask) const {
  const std::vector<py::ssize_t> shape{batch_.farms()};
  if (!mask.dtype().equal(py::dtype("bool")) || mask.ndim() != 1 || mask.shape(0) != shape[0]) {
    throw InputError("mask: got " + Describe(mask) + ", expected " + Describe("bool", shape) +
                     "; set True for each farm that starts");
  }
  if (!is_reset_) {
    throw InputError("FarmBatch: got no reset before, expected one; call reset first");
  }
  std::vector<std::int32_t> selected;
  for (std::int32_t i = 0; i < batch_.farms(); ++i) {
    if (*static_cast<const bool*>(mask.data(i))) selected.push_back(i);
  }
  return selected;
}

void Batch::StartNext(const py::array& mask) {
  const Turn turn(busy_);
  const std::vector<std::int32_t> selected = Selected(mask);
  const py::gil_scoped_release release;
  for (const std::int32_t i : selected) batch_.StartNext(i, output_);
}

void Batch::Start(const py::array& mask, const py::sequence& seeds, const py::sequence& episodes,
                  py::handle stride) {
  const Turn turn(busy_);
  const std::uint64_t apart =
      WholeNumber(stride, "FarmBatch: stride", 1, kAnyNumber, "pass 1 to skip no episode");
  const std::vector<std::int32_t> selected = Selected(mask);
  const auto farms = static_cast<std::size_t>(batch_.farms());
  if (seeds.size() != farms || episodes.size() != farms) {
    throw InputError("start: got " + std::to_string(seeds.size()) + " seeds and " +
                     std::to_string(episodes.size()) + " episodes, expected " +
                     std::to_string(farms) + " of each; pass one per farm");
  }
  std::vector<std::pair<std::uint64_t, std::uint64_t>> starts;
  for (const std::int32_t i : selected) {
    const auto k = static_cast<std::size_t>(i);
    starts.emplace_back(CheckSeed(py::object(seeds[k])), CheckEpisode(py::object(episodes[k])));
  }
  const py::gil_scoped_release release;
  for (std::size_t k = 0; k < selected.size(); ++k) {
    batch_.Start(selected[k], starts[k].first, starts[k].second, apart, output_);
  }
}

void Batch::Step(const py::array& actions) {
  const Turn turn(busy_);
  const std::vector<py::ssize_t> shape{batch_.farms(), batch_.agents()};
  if (!actions.dtype().equal(py::dtype::of<std::uint8_t>()) || actions.ndim() != 2 ||
      actions.shape(0) != shape[0] || actions.shape(1) != shape[1] ||
      (actions.flags() & py::array::c_style) == 0) {
    throw InputError("actions: got " + Describe(actions) + ", expected row-major " +
                     Describe("uint8", shape));
  }
  if (!is_reset_) throw InputError("step: got no reset before, expected one; call reset first");
  const auto* first = static_cast<const std::uint8_t*>(actions.data());
  const py::gil_scoped_release release;
  const std::uint8_t worst = *std::max_element(first, first + actions.size());
  if (worst > kActionCount) {
    throw InputError("actions: got " + std::to_string(worst) + ", expected [0, " +
                     std::to_string(kActionCount) + "]");
  }
  batch_.Step(first, output_);
}

py::list Batch::Finished() const {
  const Turn turn(busy_);
  py::list finished;
  for (std::int32_t i = 0; i < batch_.farms(); ++i) {
    if (batch_.farm(i).over()) finished.append(DictOf(SummaryOf(batch_.farm(i).record(), i)));
  }
  return finished;
}

const Farm& Batch::FarmOf(py::handle farm) const {
  const auto last = static_cast<std::uint64_t>(batch_.farms()) - 1;
  const std::uint64_t i =
      WholeNumber(farm, "FarmBatch: farm", 0, last, "pass the number of one farm of this batch");
  return batch_.farm(static_cast<std::int32_t>(i));
}

std::string Batch::Text(py::handle farm) const {
  const Turn turn(busy_);
  return RenderText(FarmOf(farm));
}

std::uint64_t Batch::StartHash(py::handle farm) const {
  const Turn turn(busy_);
  return FarmOf(farm).StartHash();
}

py::bytes Batch::Save() const {
  const Turn turn(busy_);
  return batch_.Save();
}

void Batch::Load(const std::string& bytes) {
  const Turn turn(busy_);
  batch_.Load(bytes);
  batch_.Write(output_);
  is_reset_ = true;
}

std::vector<std::string> Batch::BufferNames() const {
  std::vector<std::string> names;
  for (const auto& [name, array] : buffers_) names.push_back(name);
  return names;
}

py::tuple Batch::State() const {
  py::list strides;
  for (std::int32_t i = 0; i < batch_.farms(); ++i) strides.append(batch_.stride(i));
  return py::make_tuple(scenario(), batch_.farms(), threads_, BufferNames(), is_reset_, Save(),
                        strides);
}

std::unique_ptr<Batch> Batch::FromState(const py::tuple& state) {
  constexpr std::size_t kParts = 7;
  if (state.size() != kParts) {
    throw InputError("FarmBatch: got a pickled state of " + std::to_string(state.size()) +
                     " parts, expected " + std::to_string(kParts) +
                     "; pickle it again with this version");
  }
  auto batch = std::make_unique<Batch>(state[0].cast<std::shared_ptr<Scenario>>(), state[1],
                                       state[3].cast<std::vector<std::string>>(), state[2]);
  if (!state[4].cast<bool>()) return batch;
  batch->Load(state[5].cast<std::string>());
  const auto strides = state[6].cast<std::vector<std::uint64_t>>();
  if (strides.size() != static_cast<std::size_t>(batch->batch_.farms()) ||
      std::count(strides.begin(), strides.end(), 0U) > 0) {
    throw InputError(
        "FarmBatch: got a pickled state with wrong strides, expected one above 0 for "
        "each farm; pickle it again with this version");
  }
  for (std::size_t i = 0; i < strides.size(); ++i) {
    batch->batch_.set_stride(static_cast<std::int32_t>(i), strides[i]);
  }
  return batch;
}

bool Batch::Equals(const Batch& other) const {
  if (scenario_->hash != other.scenario_->hash || batch_.farms() != other.batch_.farms() ||
      BufferNames() != other.BufferNames() || is_reset_ != other.is_reset_) {
    return false;
  }
  for (std::int32_t i = 0; i < batch_.farms(); ++i) {
    if (batch_.stride(i) != other.batch_.stride(i)) return false;
  }
  if (this == &other) return true;
  const Turn turn(busy_);
  const Turn turn_of_other(other.busy_);
  return batch_.Save() == other.batch_.Save();
}

const BufferType& Batch::TypeOf(const std::string& name) const {
  std::string names;
  for (const BufferType& type : types_) {
    if (type.name == name) return type;
    names += (names.empty() ? "" : ", ") + type.name;
  }
  throw InputError("buffer: got '" + name + "', expected one of: " + names);
}

void Batch::Keep(const BufferType& type, py::array array) {
  std::vector<py::weakref> guards{py::weakref(array)};
  for (py::object base = array.base(); py::isinstance<py::array>(base);) {
    guards.emplace_back(base);
    base = py::reinterpret_borrow<py::array>(base).base();
  }
  Point(output_, type.name, array.mutable_data());
  guards_[type.name] = std::move(guards);
  buffers_[type.name] = std::move(array);
}

}  // namespace aquafarm::python
