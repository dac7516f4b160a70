// SPDX-License-Identifier: BSD-3-Clause
// Converts fields of netCDF files and expressions of the sea to one value per cell of a farm.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "aquafarm/base/check.h"
#include "aquafarm/sea/expression.h"
#include "aquafarm/sea/sea_field.h"
#include "base/text.h"
#include "scenario/schema.h"

namespace aquafarm::internal {

void Resolve(const SeaSource& source, const WorldFrame& frame, const std::string& path,
             std::int32_t width, std::int32_t height, SeaLayer& layer) {
  if (!frame.grid) throw FieldError(Join(path, "file"), "needs grid.origin, which is missing");
  const std::string file = (std::filesystem::path(frame.folder) / source.file).string();
  try {
    const SeaField field = LoadSeaField(
        file, {source.variable, source.time ? source.time : frame.start_time, source.depth_m},
        *frame.grid, width, height);
    const Layer values = ToLayer(field, *frame.grid, width, height);
    if (values.isNaN().all()) {
      throw InputError(file + ": " + field.name + ": has no value on this ranch");
    }
    layer.units = field.units;
    layer.values.assign(values.data(), values.data() + values.size());
  } catch (const InputError& error) {
    throw FieldError(Join(path, "file"), error.what());
  }
}

std::vector<float> ByRule(const std::string& rule, const std::vector<SeaLayer>& layers,
                          const std::string& path) {
  std::vector<NamedLayer> named;
  for (const SeaLayer& layer : layers) {
    const auto cells = static_cast<Eigen::Index>(layer.values.size());
    if (layer.values.size() != layers[0].values.size()) {
      throw FieldError(path, "got layers of different sizes, expected one value per cell in each");
    }
    named.push_back({layer.name, Eigen::Map<const Layer>(layer.values.data(), 1, cells)});
  }
  try {
    const Layer values = Evaluate(rule, named);
    return {values.data(), values.data() + values.size()};
  } catch (const InputError& error) {
    throw FieldError(path, error.what());
  }
}

void CheckPerCell(const std::string& path, const std::vector<float>& values, std::int32_t width,
                  Interval<float> range) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float value = values[i];
    if (std::isnan(value) || value == 0.0F || (value >= range.min && value <= range.max)) continue;
    const auto cell = static_cast<std::int32_t>(i);
    throw FieldError(path, "got " + Format(value) + " at (" + Format(cell % width) + ", " +
                               Format(cell / width) + "), expected 0 or a number in " +
                               Describe(range));
  }
}

}  // namespace aquafarm::internal
