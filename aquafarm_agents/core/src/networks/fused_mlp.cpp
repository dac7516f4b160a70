// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include "aquafarm/base/check.h"
#include "networks/fused.h"
#include "networks/fused_parts.h"

namespace aquafarm::agents {
namespace {

using torch::Tensor;
using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

std::size_t Size(const Tensor& tensor, std::int64_t dimension) {
  return static_cast<std::size_t>(tensor.size(dimension));
}

// A fully connected layer. Its bias is passed to Forward.
struct Layer {
  const Tensor& weight;
  std::size_t inputs() const { return Size(weight, 1); }
  std::size_t outputs() const { return Size(weight, 0); }

  Tensor Forward(const Tensor& in, const Tensor& bias) const {
    const std::size_t rows = Size(in, 0);
    Tensor out = torch::empty({in.size(0), weight.size(0)}, in.options().requires_grad(false));
    LinearForward(rows, inputs(), outputs(), Data(in), Data(weight), Data(bias),
                  out.data_ptr<float>());
    return out;
  }
  Tensor ForwardRelu(const Tensor& in, const Tensor& bias) const {
    Tensor out = Forward(in, bias);
    Rectify(static_cast<std::size_t>(out.numel()), out.data_ptr<float>());
    return out;
  }
  // Sets gradients[0] to the gradient of the weight and gradients[1] to that of the bias.
  void Gradient(const Tensor& in, const std::vector<float>& slopes, Tensor* gradients) const {
    gradients[0] = torch::empty_like(weight);
    gradients[1] = torch::empty({weight.size(0)}, weight.options());
    LinearGradient(Size(in, 0), inputs(), outputs(), Data(in), slopes.data(),
                   gradients[0].data_ptr<float>(), gradients[1].data_ptr<float>());
  }
  void AddInputSlopes(const std::vector<float>& slopes, float beta,
                      std::vector<float>& in_slopes) const {
    const std::size_t rows = slopes.size() / outputs();
    in_slopes.resize(rows * inputs());
    LinearInputSlopes(rows, inputs(), outputs(), slopes.data(), Data(weight), beta,
                      in_slopes.data());
  }
};

struct MlpOutputs {
  Tensor first;
  Tensor second;
  Tensor q;
};

MlpOutputs Evaluate(const Tensor& input, const Tensor& first_weight, const Tensor& first_bias,
                    const Tensor& second_weight, const Tensor& second_bias,
                    const Tensor& advantage_weight, const Tensor& advantage_bias,
                    const Tensor& value_weight, const Tensor& value_bias) {
  MlpOutputs outputs;
  outputs.first = Layer{first_weight}.ForwardRelu(input, first_bias);
  outputs.second = Layer{second_weight}.ForwardRelu(outputs.first, second_bias);
  outputs.q = Layer{advantage_weight}.Forward(outputs.second, advantage_bias);
  if (value_weight.numel() > 0) {
    const Tensor values = Layer{value_weight}.Forward(outputs.second, value_bias);
    AddStateValue(Size(outputs.q, 0), Size(outputs.q, 1), Data(values),
                  outputs.q.data_ptr<float>());
  }
  return outputs;
}

struct MlpFunction : torch::autograd::Function<MlpFunction> {
  enum Saved { kInput, kFirst, kSecond, kAdvantage, kValue, kFirstOut, kSecondOut, kSavedCount };

  static Tensor forward(AutogradContext* context, const Tensor& input, const Tensor& first_weight,
                        const Tensor& first_bias, const Tensor& second_weight,
                        const Tensor& second_bias, const Tensor& advantage_weight,
                        const Tensor& advantage_bias, const Tensor& value_weight,
                        const Tensor& value_bias) {
    const MlpOutputs outputs = Evaluate(input, first_weight, first_bias, second_weight, second_bias,
                                        advantage_weight, advantage_bias, value_weight, value_bias);
    variable_list saved(kSavedCount);
    saved[kInput] = input;
    saved[kFirst] = first_weight;
    saved[kSecond] = second_weight;
    saved[kAdvantage] = advantage_weight;
    saved[kValue] = value_weight;
    saved[kFirstOut] = outputs.first;
    saved[kSecondOut] = outputs.second;
    context->save_for_backward(saved);
    return outputs.q;
  }

  static variable_list backward(AutogradContext* context, const variable_list& output_slopes) {
    const variable_list saved = context->get_saved_variables();
    const Tensor of_q = output_slopes[0].contiguous();
    std::vector<float> slopes(Data(of_q), Data(of_q) + of_q.numel());
    variable_list gradients(9);
    std::vector<float> below;
    const Layer advantage{saved[kAdvantage]};
    if (saved[kValue].numel() > 0) {
      std::vector<float> value_slopes(slopes.size() / advantage.outputs());
      SplitStateValue(value_slopes.size(), advantage.outputs(), slopes.data(), value_slopes.data());
      Layer{saved[kValue]}.Gradient(saved[kSecondOut], value_slopes, &gradients[7]);
      Layer{saved[kValue]}.AddInputSlopes(value_slopes, 0.0F, below);
      advantage.AddInputSlopes(slopes, 1.0F, below);
    } else {
      advantage.AddInputSlopes(slopes, 0.0F, below);
    }
    advantage.Gradient(saved[kSecondOut], slopes, &gradients[5]);
    BackwardRelu(below.size(), Data(saved[kSecondOut]), below.data());
    Layer{saved[kSecond]}.Gradient(saved[kFirstOut], below, &gradients[3]);
    Layer{saved[kSecond]}.AddInputSlopes(below, 0.0F, slopes);
    BackwardRelu(slopes.size(), Data(saved[kFirstOut]), slopes.data());
    Layer{saved[kFirst]}.Gradient(saved[kInput], slopes, &gradients[1]);
    if (saved[kInput].requires_grad()) {
      Layer{saved[kFirst]}.AddInputSlopes(slopes, 0.0F, below);
      gradients[0] = torch::tensor(below).view(saved[kInput].sizes());
    }
    return gradients;
  }
};

}  // namespace

bool CanFuse(const Tensor& input, const Tensor& weight) {
  return input.is_cpu() && weight.is_cpu() && input.scalar_type() == torch::kFloat &&
         weight.scalar_type() == torch::kFloat;
}

Tensor FusedMlp(const Tensor& input, const Tensor& first_weight, const Tensor& first_bias,
                const Tensor& second_weight, const Tensor& second_bias,
                const Tensor& advantage_weight, const Tensor& advantage_bias,
                const Tensor& value_weight, const Tensor& value_bias) {
  AQUAFARM_CHECK_EQ(input.size(-1), first_weight.size(1));
  const Tensor rows = input.reshape({-1, input.size(-1)}).contiguous();
  std::vector<std::int64_t> shape = input.sizes().vec();
  shape.back() = advantage_weight.size(0);
  // Function::apply does not accept undefined tensors.
  const bool dueling = value_weight.defined();
  const Tensor value = dueling ? value_weight : torch::empty({0});
  const Tensor bias = dueling ? value_bias : value;
  if (!torch::GradMode::is_enabled()) {
    return Evaluate(rows, first_weight, first_bias, second_weight, second_bias, advantage_weight,
                    advantage_bias, value, bias)
        .q.view(shape);
  }
  return MlpFunction::apply(rows, first_weight, first_bias, second_weight, second_bias,
                            advantage_weight, advantage_bias, value, bias)
      .view(shape);
}

}  // namespace aquafarm::agents
