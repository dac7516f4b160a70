// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Slow oracles for the value networks and their updates: plain loops in double precision, gradients
// by central differences, Adam by its equations (Kingma and Ba 2015). They share no code with the
// learners.

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "aquafarm/grid/action.h"

namespace aquafarm::agents::test {

using Values = std::vector<double>;

/// Reads layers from a flat parameter vector, in the order of PyTorch's modules.
class ParameterReader {
 public:
  explicit ParameterReader(const Values& parameters) : parameters_(parameters) {}

  /// Reads a layer in the layout of torch::nn::Linear: W [outputs, x.size()], then b [outputs].
  /// Returns W x + b.
  Values Linear(const Values& x, std::size_t outputs) {
    const std::size_t bias = place_ + outputs * x.size();
    Values y(outputs);
    for (std::size_t o = 0; o < outputs; ++o) {
      y[o] = parameters_.at(bias + o);
      for (std::size_t i = 0; i < x.size(); ++i) {
        y[o] += parameters_[place_ + o * x.size() + i] * x[i];
      }
    }
    place_ = bias + outputs;
    return y;
  }
  void Skip(std::size_t count) { place_ += count; }
  double at(std::size_t offset) const { return parameters_.at(place_ + offset); }
  bool is_at_end() const { return place_ == parameters_.size(); }

 private:
  const Values& parameters_;
  std::size_t place_{};
};

inline Values Relu(Values x) {
  for (double& one : x) one = one > 0.0 ? one : 0.0;
  return x;
}

/// Returns Q(s, ·) of a network with two hidden layers of `hidden` units.
/// @param x features
inline Values MlpOracle(const Values& parameters, const Values& x, std::size_t hidden) {
  ParameterReader reader(parameters);
  const Values first = Relu(reader.Linear(x, hidden));
  const Values second = Relu(reader.Linear(first, hidden));
  return reader.Linear(second, kActionCount);
}

/// State of an LSTM.
struct Memory {
  Values h;  // output, [hidden]
  Values c;  // cell state, [hidden]
};

/// Returns Q(s, ·) of the recurrent network and updates its state (Hochreiter and Schmidhuber 1997,
/// with the forget gate of Gers et al. 2000; gates in PyTorch's order i, f, g, o).
/// @param skip whether the layer after the LSTM also receives the input of the LSTM
inline Values LstmOracle(const Values& parameters, const Values& x, std::size_t hidden, bool skip,
                         Memory& memory) {
  ParameterReader reader(parameters);
  const Values seen = Relu(reader.Linear(x, hidden));
  // Weights of the input; as many weights of h and two biases follow.
  const std::size_t of_input = 4 * hidden * hidden;
  Values gates(4 * hidden);
  for (std::size_t g = 0; g < gates.size(); ++g) {
    gates[g] = reader.at(2 * of_input + g) + reader.at(2 * of_input + gates.size() + g);
    for (std::size_t i = 0; i < hidden; ++i) {
      gates[g] += reader.at(g * hidden + i) * seen[i];
      gates[g] += reader.at(of_input + g * hidden + i) * memory.h[i];
    }
  }
  reader.Skip(2 * of_input + 2 * gates.size());
  const auto sigmoid = [](double z) { return 1.0 / (1.0 + std::exp(-z)); };
  for (std::size_t i = 0; i < hidden; ++i) {
    memory.c[i] = sigmoid(gates[hidden + i]) * memory.c[i] +
                  sigmoid(gates[i]) * std::tanh(gates[2 * hidden + i]);
    memory.h[i] = sigmoid(gates[3 * hidden + i]) * std::tanh(memory.c[i]);
  }
  Values joined = memory.h;
  if (skip) joined.insert(joined.end(), seen.begin(), seen.end());
  return reader.Linear(Relu(reader.Linear(joined, joined.size())), kActionCount);
}

/// Returns the gradient of `loss` at `parameters`, computed by central differences.
inline Values Differences(Values parameters, const std::function<double(const Values&)>& loss) {
  constexpr double kStep = 1e-6;
  Values gradient(parameters.size());
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double at = parameters[i];
    parameters[i] = at + kStep;
    const double above = loss(parameters);
    parameters[i] = at - kStep;
    gradient[i] = (above - loss(parameters)) / (2.0 * kStep);
    parameters[i] = at;
  }
  return gradient;
}

/// Returns the parameters after one step of Adam with PyTorch's constants.
/// @param mean, square moving averages before the step
/// @param step number of this step, starting at 1
/// @param rate learning rate
inline Values AdamOracle(Values parameters, const Values& gradient, const Values& mean,
                         const Values& square, int step, double rate) {
  constexpr double kMeanDecay = 0.9;
  constexpr double kSquareDecay = 0.999;
  constexpr double kEpsilon = 1e-8;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double m = kMeanDecay * mean[i] + (1.0 - kMeanDecay) * gradient[i];
    const double v = kSquareDecay * square[i] + (1.0 - kSquareDecay) * gradient[i] * gradient[i];
    const double unbiased_m = m / (1.0 - std::pow(kMeanDecay, step));
    const double unbiased_v = v / (1.0 - std::pow(kSquareDecay, step));
    parameters[i] -= rate * unbiased_m / (std::sqrt(unbiased_v) + kEpsilon);
  }
  return parameters;
}

}  // namespace aquafarm::agents::test
