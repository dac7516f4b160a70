// SPDX-License-Identifier: BSD-3-Clause
#include "networks/row_network.h"

#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/grid/action.h"

namespace aquafarm::agents {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// out = W·in + b. `weights` points to W followed by b and is advanced past them.
void Apply(const float*& weights, const Eigen::Ref<const Eigen::VectorXf>& in,
           Eigen::VectorXf& out) {
  const Eigen::Map<const Matrix> matrix(weights, out.size(), in.size());
  weights += matrix.size();
  out = Eigen::Map<const Eigen::VectorXf>(weights, out.size());
  weights += out.size();
  out.noalias() += matrix * in;
}

}  // namespace

RowNetwork::RowNetwork(std::size_t features, const DeepOptions& options, std::vector<float> weights)
    : weights_(std::move(weights)),
      features_(static_cast<Eigen::Index>(features)),
      dueling_(options.dueling),
      first_(options.hidden_size),
      second_(options.hidden_size),
      values_(static_cast<Eigen::Index>(kActionCount)),
      state_value_(options.dueling ? 1 : 0) {
  const Eigen::Index count = (features_ + 1) * first_.size() +
                             (first_.size() + 1) * second_.size() +
                             (second_.size() + 1) * (values_.size() + state_value_.size());
  AQUAFARM_CHECK_EQ(static_cast<Eigen::Index>(weights_.size()), count);
}

const float* RowNetwork::Forward(const float* features) {
  const float* weights = weights_.data();
  Apply(weights, Eigen::Map<const Eigen::VectorXf>(features, features_), first_);
  first_ = first_.cwiseMax(0.0F);
  Apply(weights, first_, second_);
  second_ = second_.cwiseMax(0.0F);
  Apply(weights, second_, values_);
  if (dueling_) {
    Apply(weights, second_, state_value_);
    values_.array() += state_value_[0] - values_.mean();
  }
  return values_.data();
}

}  // namespace aquafarm::agents
