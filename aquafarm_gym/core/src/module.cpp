// SPDX-License-Identifier: BSD-3-Clause
// The Python module aquafarm_core: scenarios, and FarmBatch writing into NumPy arrays.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm/base/version.h"
#include "aquafarm/observation/farm_batch.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "buffers.h"

namespace aquafarm::python {
namespace py = pybind11;

/// A FarmBatch and the NumPy arrays that it writes; they are NumPy's own memory, so nothing is
/// copied on the way to Python.
class Batch {
 public:
  Batch(std::shared_ptr<const Scenario> scenario, std::int32_t farms, std::int32_t threads,
        const std::vector<std::string>& write)
      : batch_(std::move(scenario), CheckFarms(farms), threads), types_(BufferTypes(batch_)) {
    for (const std::string& name : write) {
      const BufferType& type = TypeOf(name);
      py::array array(py::dtype(type.dtype), type.shape);
      std::memset(array.mutable_data(), 0, static_cast<std::size_t>(array.nbytes()));
      Keep(type, std::move(array));
    }
  }

  void Bind(const std::string& name, const py::array& array) {
    const Turn turn(busy_);
    const BufferType& type = TypeOf(name);
    if (!Fits(array, type)) {
      throw InputError(name + ": got " + Describe(array) + ", expected writeable row-major " +
                       Describe(type.dtype, type.shape));
    }
    Keep(type, array);
  }

  void Reset(std::uint64_t seed, std::uint64_t first_episode) {
    const Turn turn(busy_);
    const py::gil_scoped_release release;
    batch_.Reset(seed, first_episode, output_);
    is_reset_ = true;
  }

  void Step(const py::array& actions) {
    const Turn turn(busy_);
    const std::vector<py::ssize_t> shape{batch_.farms(), batch_.agents()};
    if (!actions.dtype().equal(py::dtype::of<std::uint8_t>()) || actions.ndim() != 2 ||
        actions.shape(0) != shape[0] || actions.shape(1) != shape[1] ||
        (actions.flags() & py::array::c_style) == 0) {
      throw InputError("actions: got " + Describe(actions) + ", expected row-major " +
                       Describe("uint8", shape));
    }
    if (!is_reset_) throw InputError("step: got no reset before, expected one");
    const auto* first = static_cast<const std::uint8_t*>(actions.data());
    const py::gil_scoped_release release;
    const std::uint8_t worst = *std::max_element(first, first + actions.size());
    if (worst > kActionCount) {
      throw InputError("actions: got " + std::to_string(worst) + ", expected [0, " +
                       std::to_string(kActionCount) + "]");
    }
    batch_.Step(first, output_);
  }

  /// How the episodes that are over went, by farm.
  py::list Finished() const {
    const Turn turn(busy_);
    py::list finished;
    for (std::int32_t i = 0; i < batch_.farms(); ++i) {
      const EpisodeRecord& record = batch_.farm(i).record();
      if (record.reason == EndReason::kNone) continue;
      py::dict one;
      one["farm"] = i;
      one["seed"] = record.seed;
      one["episode"] = record.episode;
      one["steps"] = record.steps;
      one["episode_return"] = record.episode_return;
      one["devices"] = record.devices;
      one["delivered"] = record.delivered;
      one["delivered_health"] =
          record.delivered == 0 ? 0.0F
                                : record.delivered_health / static_cast<float>(record.delivered);
      one["crashes"] = record.crashes;
      one["collisions"] = record.collisions;
      one["steps_in_disaster"] = record.steps_in_disaster;
      one["reason"] = ToString(record.reason);
      one["success"] = record.Success();
      finished.append(one);
    }
    return finished;
  }

  py::bytes Save() const {
    const Turn turn(busy_);
    return batch_.Save();
  }
  void Load(const std::string& bytes) {
    const Turn turn(busy_);
    batch_.Load(bytes);
    batch_.Write(output_);
    is_reset_ = true;
  }

  const FarmBatch& batch() const { return batch_; }
  const std::map<std::string, py::array>& buffers() const { return buffers_; }

 private:
  /// Refuses a call while another thread's still runs; taken and given back under the GIL, which
  /// reset and step release in between.
  class Turn {
   public:
    explicit Turn(bool& busy) : busy_(busy) {
      if (busy_) throw std::runtime_error("FarmBatch: another thread's call still runs");
      busy_ = true;
    }
    ~Turn() { busy_ = false; }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    bool& busy_;
  };

  static std::int32_t CheckFarms(std::int32_t farms) {
    if (farms < 1) {
      throw InputError("farms: got " + std::to_string(farms) + ", expected at least 1");
    }
    return farms;
  }

  const BufferType& TypeOf(const std::string& name) const {
    std::string names;
    for (const BufferType& type : types_) {
      if (type.name == name) return type;
      names += (names.empty() ? "" : ", ") + type.name;
    }
    throw InputError("buffer: got '" + name + "', expected one of: " + names);
  }

  void Keep(const BufferType& type, py::array array) {
    Point(output_, type.name, array.mutable_data());
    buffers_[type.name] = std::move(array);
  }

  FarmBatch batch_;
  std::vector<BufferType> types_;
  std::map<std::string, py::array> buffers_;
  BatchOutput output_;
  bool is_reset_{};
  mutable bool busy_{};
};

std::vector<std::string> Names(int count, std::string (*name)(int)) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.push_back(name(i));
  return names;
}

template <typename T>
std::string NameOf(int value) {
  return std::string(ToString(static_cast<T>(value)));
}

void DefineConstants(py::module_& module) {
  module.attr("VERSION") = kVersion;
#ifdef NDEBUG
  module.attr("OPTIMISED") = true;
#else
  module.attr("OPTIMISED") = false;
#endif
  module.attr("SCENARIO_FOLDER") = AQUAFARM_SCENARIO_DIR;
  module.attr("ACTIONS") = Names(kActionCount, NameOf<Action>);
  module.attr("HOLD") = static_cast<int>(Action::kHold);
  module.attr("OUTCOMES") = Names(kOutcomeCount, NameOf<Outcome>);
  module.attr("REASONS") = Names(kEndReasonCount, NameOf<EndReason>);
  module.attr("STEP_LIMIT") = static_cast<int>(EndReason::kStepLimit);
  module.attr("TERMS") = std::vector<std::string>(kRewardTermNames.begin(), kRewardTermNames.end());
  module.attr("PLANES") = Encoder::plane_names();
}

void DefineScenario(py::module_& module) {
  py::class_<Scenario, std::shared_ptr<Scenario>>(module, "Scenario",
                                                  "A whole farm as its file describes it.")
      .def_static(
          "load",
          [](const std::string& path) { return std::make_shared<Scenario>(LoadScenario(path)); },
          py::arg("path"), "Reads a scenario file; a fault is a ValueError that says where.")
      .def_static(
          "parse",
          [](const std::string& text, const std::string& name) {
            return std::make_shared<Scenario>(ParseScenario(text, name));
          },
          py::arg("text"), py::arg("name") = "scenario", "Reads a scenario's text.")
      .def_property_readonly("yaml", [](const Scenario& s) { return ToYaml(s); })
      .def_readonly("name", &Scenario::name)
      .def_readonly("hash", &Scenario::hash)
      .def_readonly("width", &Scenario::width)
      .def_readonly("height", &Scenario::height)
      .def_readonly("step_limit", &Scenario::step_limit)
      .def_property_readonly("ships", [](const Scenario& s) { return s.ships.count; })
      .def_property_readonly("agents", &Scenario::AgentCount);
}

void DefineBatch(py::module_& module) {
  py::class_<Batch>(module, "FarmBatch", R"(Many farms of one scenario, stepped together.

`buffers` holds the arrays named in `write`; reset and step write into them and copy nothing.
N farms, S agents: rewards float32 [N, S], terms float32 [N, S, 7], outcomes uint8 [N, S], legal
uint16 [N, S], in_play uint8 [N, S], reasons uint8 [N], started uint8 [N], hashes uint64 [N], index uint32 [N, S],
features float32 [N, S, F], planes uint8 [N, S, P, H, W].
A farm whose reason is not 0 ignores the action of the next step and starts its next episode.)")
      .def(py::init([](std::shared_ptr<Scenario> scenario, std::int32_t farms,
                       const std::vector<std::string>& write, std::int32_t threads) {
             return std::make_unique<Batch>(std::move(scenario), farms, threads, write);
           }),
           py::arg("scenario"), py::arg("farms") = 1,
           py::arg("write") = std::vector<std::string>{"rewards", "reasons", "started"},
           py::arg("threads") = 1)
      .def("bind", &Batch::Bind, py::arg("name"), py::arg("array"),
           "Writes into this array from now on: the caller's memory, such as a replay's.")
      .def("reset", &Batch::Reset, py::arg("seed"), py::arg("first_episode") = 0,
           "Starts the sequence `seed`: farm i of N at episode first_episode + i, then every N-th.")
      .def("step", &Batch::Step, py::arg("actions"),
           "Takes one step in every farm; actions uint8 [N, S], each in [0, 10], 10 holds.")
      .def("finished", &Batch::Finished, "How the episodes that are over went, by farm.")
      .def("save", &Batch::Save, "All farms as bytes, mid-episode.")
      .def("load", &Batch::Load, py::arg("data"), "Continues saved farms bit for bit.")
      .def_property_readonly("buffers", &Batch::buffers)
      .def_property_readonly("farms", [](const Batch& b) { return b.batch().farms(); })
      .def_property_readonly("agents", [](const Batch& b) { return b.batch().agents(); })
      .def_property_readonly("state_count",
                             [](const Batch& b) { return b.batch().encoder().state_count(); })
      .def_property_readonly("feature_names",
                             [](const Batch& b) { return b.batch().encoder().feature_names(); });
}

}  // namespace aquafarm::python

PYBIND11_MODULE(aquafarm_core, module) {
  module.doc() = "The farm's core: scenarios, and many farms stepped into NumPy arrays.";
  pybind11::register_exception_translator([](std::exception_ptr raised) {
    try {
      if (raised) std::rethrow_exception(raised);
    } catch (const aquafarm::InputError& error) {
      PyErr_SetString(PyExc_ValueError, error.what());
    }
  });
  aquafarm::python::DefineConstants(module);
  aquafarm::python::DefineScenario(module);
  aquafarm::python::DefineBatch(module);
}
