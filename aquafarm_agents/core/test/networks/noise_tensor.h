// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <torch/torch.h>

#include <algorithm>

#include "networks/noise.h"

namespace aquafarm::agents {

/// Returns a float tensor of random numbers, uniform in [-1, 1). Equal arguments give equal
/// numbers.
inline torch::Tensor NoiseTensor(const std::vector<std::int64_t>& shape, std::uint32_t stream) {
  torch::Tensor tensor = torch::empty(shape);
  const std::vector<float> values = Noise(static_cast<std::size_t>(tensor.numel()), stream);
  std::copy(values.begin(), values.end(), tensor.data_ptr<float>());
  return tensor;
}

}  // namespace aquafarm::agents
