// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <torch/torch.h>

#include <algorithm>

#include "networks/noise.h"

namespace aquafarm::agents {

/// Returns a tensor of numbers of a random stream, uniform from -1 to 1.
inline torch::Tensor NoiseTensor(const std::vector<std::int64_t>& shape, std::uint32_t stream) {
  torch::Tensor tensor = torch::empty(shape);
  const std::vector<float> values = Noise(static_cast<std::size_t>(tensor.numel()), stream);
  std::copy(values.begin(), values.end(), tensor.data_ptr<float>());
  return tensor;
}

}  // namespace aquafarm::agents
