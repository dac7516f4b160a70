// SPDX-License-Identifier: BSD-3-Clause
#include "planning/water_distance.h"

namespace aquafarm::agents {

std::vector<std::int32_t> WaterDistance(const Layout& layout, const std::vector<Cell>& sources) {
  Grid<std::int32_t> steps;
  std::vector<Cell> queue;
  StepsByWater(layout.cells, sources.data(), sources.size(), steps, queue);
  return {steps.data(), steps.data() + steps.size()};
}

}  // namespace aquafarm::agents
