// SPDX-License-Identifier: BSD-3-Clause
// Pictures of farms, drawn with the code of aquafarm_viz. The ROS messages that this code reads are
// plain structs here (plain_messages.py), so the module needs neither ROS nor a display.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_sim/convert/conversions.h"
#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/draw/image.h"
#include "arguments.h"
#include "batch.h"

namespace aquafarm::python {
namespace py = pybind11;

/// Draws one farm of a batch. The trails and routes of the ships begin at the first picture of an
/// episode.
class Painter {
 public:
  Painter(py::handle width, py::handle height, const std::string& layers, const std::string& style)
      : size_{CheckSide(width, "width"), CheckSide(height, "height")},
        layers_(aquafarm_viz::ParseLayers(layers)),
        painter_(size_, aquafarm_viz::StyleByName(style)) {}

  /// Returns a picture of one farm, uint8 [height, width, 3], RGB.
  /// @throws InputError if there is no such farm; pybind11::value_error if the farm cannot be drawn
  py::array_t<std::uint8_t> Draw(const Batch& batch, py::handle farm) {
    const auto last = static_cast<std::uint64_t>(batch.batch().farms()) - 1;
    const auto number = static_cast<std::int32_t>(
        WholeNumber(farm, "Painter: farm", 0, last, "pass the number of one farm of this batch"));
    batch.Inspect(number, [&](const Encoder& encoder, const Farm& shown) {
      Read(batch.batch().farms(), encoder, shown);
    });
    trail_.Update(state_);
    route_.Update(state_);
    if (auto fault = aquafarm_viz::CheckSpec(spec_); !fault.empty()) throw py::value_error(fault);
    if (auto fault = aquafarm_viz::CheckState(state_); !fault.empty()) throw py::value_error(fault);
    const cv::Mat& drawn =
        painter_.Draw(spec_, state_, {&trail_, nullptr, &route_, layers_, nullptr, nullptr});
    py::array_t<std::uint8_t> pixels({drawn.rows, drawn.cols, 3});
    cv::Mat out(drawn.rows, drawn.cols, CV_8UC3, pixels.mutable_data());
    cv::cvtColor(drawn, out, cv::COLOR_BGR2RGB);
    return pixels;
  }

 private:
  static int CheckSide(py::handle side, const std::string& name) {
    return static_cast<int>(WholeNumber(side, "Painter: " + name, aquafarm_viz::kMinImageSide,
                                        aquafarm_viz::kMaxImageSide, "pass a size in pixels"));
  }

  // Converts the farm to messages: the state at each call, the constants once per episode.
  void Read(std::int32_t farms, const Encoder& encoder, const Farm& farm) {
    const aquafarm_sim::MessageContext context;
    aquafarm_sim::ToMsg(farm, context, state_);
    const Scenario& scenario = farm.scenario();
    if (spec_.width == scenario.width && spec_.scenario_hash == scenario.hash &&
        spec_.seed == farm.seed() && spec_.episode == farm.episode()) {
      return;
    }
    aquafarm_sim::ToMsg(farm, encoder, farms, ToYaml(scenario), context, spec_);
  }

  aquafarm_viz::ImageSize size_;
  aquafarm_viz::Layers layers_;
  aquafarm_viz::FarmPainter painter_;
  aquafarm_viz::Trail trail_;
  aquafarm_viz::Trail route_{aquafarm_viz::Trail::kWhole};
  aquafarm_msgs::FarmSpec spec_;
  aquafarm_msgs::FarmState state_;
};

}  // namespace aquafarm::python

PYBIND11_MODULE(_pictures, module) {
  namespace py = pybind11;
  using aquafarm::python::Painter;
  module.doc() = "Pictures of farms, as aquafarm_viz draws them.";
  py::module_::import("aquafarm_core._native");  // defines FarmBatch
  module.attr("LAYERS") = aquafarm_viz::LayerNames();
  py::class_<Painter>(module, "Painter", R"(Draws farms as ./aquafarm render does.

width, height: pixels in [160, 4096]. layers: names in LAYERS, separated by commas, or "none";
values and moves are not drawn. style: dark for screens, light for print. Use one Painter per
farm: a picture of another episode starts the trails of the ships again.)")
      .def(py::init<py::handle, py::handle, const std::string&, const std::string&>(),
           py::arg("width") = 800, py::arg("height") = 640, py::arg("layers") = "trail,risk,labels",
           py::arg("style") = "dark")
      .def("draw", &Painter::Draw, py::arg("batch"), py::arg("farm") = 0,
           "Returns a picture of the present state of one farm, uint8 [height, width, 3], RGB.");
}
