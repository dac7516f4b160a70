// SPDX-License-Identifier: BSD-3-Clause
// The native module of the Python package aquafarm_core: scenarios, batches of farms that write
// into NumPy arrays, policies and planners.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm/base/version.h"
#include "aquafarm/observation/farm_batch.h"
#include "aquafarm/scenario/enums.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "batch.h"
#include "policies.h"

namespace aquafarm::python {
namespace py = pybind11;

std::vector<std::string> Names(int count, std::string (*name)(int)) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.push_back(name(i));
  return names;
}

template <typename T>
std::string NameOf(int value) {
  return std::string(ToString(static_cast<T>(value)));
}

// Defines functions for _abi.py, which checks at import that this module and NumPy use the same
// array layout.
void DefineProbes(py::module_& module) {
  module.def(
      "_made_array",
      [](const std::string& dtype, const std::vector<py::ssize_t>& shape) {
        return py::array(py::dtype(dtype), shape);
      },
      py::arg("dtype"), py::arg("shape"), "Returns an array that is allocated like the buffers.");
  module.def(
      "_write_last",
      [](py::array array, std::uint8_t value) {
        auto* bytes = static_cast<std::uint8_t*>(array.mutable_data());
        bytes[array.nbytes() - 1] = value;
      },
      py::arg("array"), py::arg("value"), "Writes the last byte of an array in place.");
}

// Returns a dict from the name of each entry of an episode summary to its CSV column.
// @param added true: only the entries that older files may lack (EpisodeField::is_added); false:
//   only the other entries
py::dict ColumnsOfEpisodes(bool added) {
  py::dict columns;
  if (!added) columns["farm"] = "farm";
  VisitEpisodeFields([&](const EpisodeField& field) {
    if (field.is_added == added) columns[field.name] = field.column;
  });
  if (!added) columns["success"] = "success";
  return columns;
}

void DefineConstants(py::module_& module) {
  module.attr("VERSION") = kVersion;
  module.attr("PYBIND11") = py::make_tuple(PYBIND11_VERSION_MAJOR, PYBIND11_VERSION_MINOR);
#ifdef NDEBUG
  module.attr("OPTIMISED") = true;
#else
  module.attr("OPTIMISED") = false;
#endif
  module.attr("SOURCE_SCENARIO_FOLDER") = AQUAFARM_SCENARIO_DIR;
  module.attr("SOURCE_POLICY_FOLDER") = AQUAFARM_POLICY_DIR;
  module.attr("ACTIONS") = Names(kActionCount, NameOf<Action>);
  module.attr("HOLD") = static_cast<int>(Action::kHold);
  module.attr("DEVICE_KINDS") = Names(kDeviceKindCount, NameOf<DeviceKind>);
  module.attr("DISASTER_KINDS") = Names(kDisasterKindCount, NameOf<DisasterKind>);
  module.attr("OUTCOMES") = Names(kOutcomeCount, NameOf<Outcome>);
  module.attr("REASONS") = Names(kEndReasonCount, NameOf<EndReason>);
  module.attr("STEP_LIMIT") = static_cast<int>(EndReason::kStepLimit);
  module.attr("TERMS") = std::vector<std::string>(kRewardTermNames.begin(), kRewardTermNames.end());
  module.attr("PLANES") = Encoder::plane_names();
  module.attr("NO_EPISODE") = DictOf(EpisodeSummary{});
  module.attr("EPISODE_COLUMNS") = ColumnsOfEpisodes(false);
  module.attr("ADDED_COLUMNS") = ColumnsOfEpisodes(true);
}

void DefineScenario(py::module_& module) {
  py::class_<Scenario, std::shared_ptr<Scenario>>(module, "Scenario",
                                                  "A complete farm, as its file describes it.")
      .def_static(
          "load",
          [](const std::string& path) { return std::make_shared<Scenario>(LoadScenario(path)); },
          py::arg("path"),
          "Reads a scenario file. Raises ValueError with line and key if it is wrong.")
      .def_static(
          "parse",
          [](const std::string& text, const std::string& name) {
            return std::make_shared<Scenario>(ParseScenario(text, name));
          },
          py::arg("text"), py::arg("name") = "scenario", "Reads the text of a scenario.")
      .def_property_readonly("yaml", [](const Scenario& s) { return ToYaml(s); })
      .def_readonly("name", &Scenario::name)
      .def_readonly("hash", &Scenario::hash)
      .def_readonly("width", &Scenario::width)
      .def_readonly("height", &Scenario::height)
      .def_readonly("step_limit", &Scenario::step_limit)
      .def_property_readonly("ships", [](const Scenario& s) { return s.ships.count; })
      .def_property_readonly("agents", &Scenario::AgentCount)
      .def_property_readonly(
          "has_team_rewards",
          [](const Scenario& s) { return s.rewards.sharing == RewardSharing::kTeam; },
          "True if each agent receives the sum of the rewards of all agents.")
      .def(
          "__eq__", [](const Scenario& a, const Scenario& b) { return ToYaml(a) == ToYaml(b); },
          py::is_operator())
      .def("__hash__", [](const Scenario& s) { return py::hash(py::int_(s.hash)); })
      .def("__repr__",
           [](const Scenario& s) { return "<aquafarm_core.Scenario '" + s.name + "'>"; })
      .def(py::pickle([](const Scenario& s) { return py::make_tuple(ToYaml(s), s.name); },
                      [](const py::tuple& state) {
                        return std::make_shared<Scenario>(ParseScenario(
                            state[0].cast<std::string>(), state[1].cast<std::string>()));
                      }));
}

void DefineBatch(py::module_& module) {
  py::class_<Batch>(module, "FarmBatch", R"(Many farms of one scenario, stepped together.

`buffers` has the arrays named in `write` or bound later. The batch writes directly into them.
N farms, S agents: rewards float32 [N, S], terms float32 [N, S, len(TERMS)], energy float32 [N, S]
(kWh), distance float32 [N, S] (km), outcomes uint8 [N, S], legal uint16 [N, S], active uint8
[N, S], end_reasons uint8 [N], is_first uint8 [N], hashes uint64 [N], index uint32 [N, S],
features float32 [N, S, len(feature_names)], planes uint8 [N, S, len(PLANES), height, width].
A farm whose end reason is not 0 ignores its actions in the next step and starts its next episode.
Numbers out of range and arrays that do not fit raise ValueError.)")
      .def(py::init([](std::shared_ptr<Scenario> scenario, const py::object& farms,
                       const std::vector<std::string>& write, const py::object& threads) {
             return std::make_unique<Batch>(std::move(scenario), farms, write, threads);
           }),
           py::arg("scenario"), py::arg("farms") = 1,
           py::arg("write") = std::vector<std::string>{"rewards", "end_reasons", "is_first"},
           py::arg("threads") = 1)
      .def("bind", &Batch::Bind, py::arg("name"), py::arg("array"),
           "Uses `array` as the buffer `name` from now on, for example a part of a replay buffer.")
      .def(
          "reset", &Batch::Reset, py::arg("seed"), py::arg("first_episode") = 0,
          "Starts the sequence `seed`. Farm i of N starts at episode first_episode + i, then plays "
          "every N-th episode.")
      .def("start", &Batch::Start, py::arg("mask"), py::arg("seeds"), py::arg("episodes"),
           py::arg("stride") = 1,
           "Starts episodes[i] of the sequence seeds[i] in the farms that `mask` (bool [N]) "
           "selects. The episode numbers of these farms then increase by `stride`.")
      .def("start_next", &Batch::StartNext, py::arg("mask"),
           "Starts the next episode in the farms that `mask` (bool [N]) selects.")
      .def("step", &Batch::Step, py::arg("actions"),
           "Takes one step in every farm. actions: uint8 [N, S], each in [0, 10]; 10 holds.")
      .def("finished", &Batch::Finished,
           "Returns a list with a dict of statistics for each farm whose episode has ended.")
      .def("text", &Batch::Text, py::arg("farm") = 0,
           "Returns the present state of one farm as text.")
      .def("start_hash", &Batch::StartHash, py::arg("farm") = 0,
           "Returns a hash of layout, ships, devices and disasters of one farm, without seed and "
           "episode number. Directly after reset, it identifies the start of an episode.")
      .def("save", &Batch::Save, "Returns the state of all farms as bytes, also in mid-episode.")
      .def("load", &Batch::Load, py::arg("data"),
           "Restores saved farms, which continue bit-identically. The bytes do not contain the "
           "`stride` of start.")
      .def("__eq__", &Batch::Equals, py::is_operator())
      .def(py::pickle([](const Batch& batch) { return batch.State(); }, &Batch::FromState))
      .def_property_readonly(
          "buffers",
          [](const Batch& batch) {
            return py::module_::import("aquafarm_core._names").attr("Buffers")(batch.buffers());
          })
      .def_property_readonly("farms", [](const Batch& b) { return b.batch().farms(); })
      .def_property_readonly("agents", [](const Batch& b) { return b.batch().agents(); })
      .def_property_readonly("scenario", &Batch::scenario)
      .def_property_readonly("state_count",
                             [](const Batch& b) { return b.batch().encoder().state_count(); })
      .def_property_readonly("feature_names",
                             [](const Batch& b) { return b.batch().encoder().feature_names(); });
}

}  // namespace aquafarm::python

PYBIND11_MODULE(_native, module) {
  module.doc() = "Scenarios, batches of farms that write into NumPy arrays, policies, planners.";
  pybind11::register_exception_translator([](std::exception_ptr raised) {
    try {
      if (raised) std::rethrow_exception(raised);
    } catch (const aquafarm::InputError& error) {
      PyErr_SetString(PyExc_ValueError, error.what());
    }
  });
  aquafarm::python::DefineProbes(module);
  aquafarm::python::DefineConstants(module);
  aquafarm::python::DefineScenario(module);
  aquafarm::python::DefineBatch(module);
  aquafarm::python::DefinePolicies(module);
}
