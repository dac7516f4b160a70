// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/token_actor_critic.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "aquafarm/grid/action.h"
#include "ppo/ppo_loss.h"
#include "ppo/weight_drawer.h"

namespace aquafarm::agents {
namespace {

constexpr std::size_t kE = TokenActorCritic::kEmbedding;

using Embedding = Eigen::Map<Eigen::Array<float, static_cast<int>(kE), 1>>;
using ConstEmbedding = Eigen::Map<const Eigen::Array<float, static_cast<int>(kE), 1>>;

Embedding At(std::vector<float>& values, std::size_t begin) {
  return Embedding(values.data() + begin);
}
ConstEmbedding At(const std::vector<float>& values, std::size_t begin) {
  return ConstEmbedding(values.data() + begin);
}

// Updates the maximum of each unit. The loops have no branches and no aliases, so that compilers
// vectorize them.
void KeepMax(const float* __restrict values, std::int32_t token, float* __restrict max,
             std::int32_t* __restrict best) {
  for (std::size_t i = 0; i < kE; ++i) best[i] = values[i] > max[i] ? token : best[i];
  for (std::size_t i = 0; i < kE; ++i) max[i] = std::max(values[i], max[i]);
}

const float kScoreScale = 1.0F / std::sqrt(static_cast<float>(kE));

}  // namespace

TokenActorCritic::TokenActorCritic(const TokenLayout& layout, std::size_t hidden,
                                   std::uint64_t seed)
    : hidden_(hidden),
      joined_size_(hidden + (kKinds + kHeads) * kE),
      features_(layout.groups.back().end()),
      ship_{0, layout.of(TokenKind::kShip).size, hidden} {
  std::size_t end = ship_.end();
  const auto next = [&end](std::size_t inputs, std::size_t outputs) {
    const Linear layer{end, inputs, outputs};
    end = layer.end();
    return layer;
  };
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    Tokens& tokens = kinds_[kind];
    tokens.group = layout.groups[kind + 1];
    tokens.first = next(tokens.group.size, kE);
    tokens.second = next(kE, kE);
  }
  query_ = next(hidden, kHeads * kE);
  first_ = next(joined_size_, hidden);
  second_ = next(hidden, hidden);
  head_ = next(hidden, kActorCriticOutputs);
  weights_.resize(end);
  gradient_.resize(end);
  WeightDrawer drawer({seed});
  drawer.Draw(ship_, weights_);
  for (const Tokens& tokens : kinds_) {
    drawer.Draw(tokens.first, weights_);
    drawer.Draw(tokens.second, weights_);
  }
  for (const Linear* layer : {&query_, &first_, &second_}) drawer.Draw(*layer, weights_);
  drawer.DrawHead(head_, weights_);
}

void TokenActorCritic::Reserve(std::size_t rows) {
  if (outputs_.size() >= rows * kActorCriticOutputs) return;
  outputs_.resize(rows * kActorCriticOutputs);
  ship_in_.resize(rows * ship_.inputs);
  for (auto* one : {&queries_, &query_slopes_}) one->resize(rows * kHeads * kE);
  for (auto* one : {&joined_, &joined_slopes_}) one->resize(rows * joined_size_);
  for (auto* one :
       {&ship_out_, &ship_slopes_, &first_out_, &second_out_, &first_slopes_, &second_slopes_}) {
    one->resize(rows * hidden_);
  }
  for (Tokens& tokens : kinds_) {
    const std::size_t capacity = rows * tokens.group.slots;
    tokens.begin.resize(rows + 1);
    tokens.features.resize(capacity * tokens.first.inputs);
    for (auto* one : {&tokens.middle, &tokens.embedding, &tokens.middle_slopes, &tokens.slopes}) {
      one->resize(capacity * kE);
    }
    tokens.scores.resize(capacity * kHeads);
    tokens.best.resize(rows * kE);
  }
}

// Copies the valid tokens of one kind, row after row.
void TokenActorCritic::Collect(const SequenceRows& rows, Tokens& tokens) {
  const std::size_t size = tokens.group.size;
  std::size_t count = 0;
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    tokens.begin[row] = count;
    const float* token = rows.features + row * features_ + tokens.group.begin;
    for (std::size_t slot = 0; slot < tokens.group.slots; ++slot, token += size) {
      if (token[0] == 0.0F) continue;
      std::copy_n(token, size, tokens.features.data() + count * size);
      ++count;
    }
  }
  tokens.begin[rows.rows()] = count;
}

void TokenActorCritic::PoolMax(std::size_t rows, std::size_t kind) {
  Tokens& tokens = kinds_[kind];
  for (std::size_t row = 0; row < rows; ++row) {
    float* const max = joined_max(row, kind);
    std::int32_t* const best = tokens.best.data() + row * kE;
    std::fill_n(max, kE, 0.0F);
    std::fill_n(best, kE, kNone);
    for (std::size_t token = tokens.begin[row]; token < tokens.begin[row + 1]; ++token) {
      KeepMax(tokens.embedding.data() + token * kE, static_cast<std::int32_t>(token), max, best);
    }
  }
}

void TokenActorCritic::Attend(std::size_t rows) {
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t head = 0; head < kHeads; ++head) {
      const auto query = At(std::as_const(queries_), (row * kHeads + head) * kE);
      auto sum = At(joined_, attended(row, head));
      sum = 0.0F;
      float max = -1e30F;
      const auto each = [&](const auto& visit) {
        for (std::size_t kind = 0; kind < kTargets; ++kind) {
          Tokens& tokens = kinds_[kind];
          for (std::size_t t = tokens.begin[row]; t < tokens.begin[row + 1]; ++t) {
            visit(tokens, t, tokens.scores[t * kHeads + head]);
          }
        }
      };
      each([&](const Tokens& tokens, std::size_t t, float& score) {
        score = (query * At(tokens.embedding, t * kE)).sum() * kScoreScale;
        max = std::max(max, score);
      });
      float total = 0.0F;
      each([&](const Tokens&, std::size_t, float& score) {
        score = std::exp(score - max);
        total += score;
      });
      each([&](const Tokens& tokens, std::size_t t, float& score) {
        score /= total;
        sum += score * At(tokens.embedding, t * kE);
      });
    }
  }
}

const float* TokenActorCritic::Forward(const SequenceRows& rows, float*) {
  const std::size_t count = rows.rows();
  Reserve(count);
  for (std::size_t row = 0; row < count; ++row) {
    std::copy_n(rows.features + row * features_, ship_.inputs,
                ship_in_.data() + row * ship_.inputs);
  }
  ship_.ForwardRelu(weights_, count, ship_in_.data(), ship_out_.data());
  query_.Forward(weights_, count, ship_out_.data(), queries_.data());
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    Tokens& tokens = kinds_[kind];
    Collect(rows, tokens);
    const std::size_t valid = tokens.begin[count];
    if (valid > 0) {
      tokens.first.ForwardRelu(weights_, valid, tokens.features.data(), tokens.middle.data());
      tokens.second.ForwardRelu(weights_, valid, tokens.middle.data(), tokens.embedding.data());
    }
    PoolMax(count, kind);
  }
  Attend(count);
  for (std::size_t row = 0; row < count; ++row) {
    std::copy_n(ship_out_.data() + row * hidden_, hidden_, joined_.data() + row * joined_size_);
  }
  first_.ForwardRelu(weights_, count, joined_.data(), first_out_.data());
  second_.ForwardRelu(weights_, count, first_out_.data(), second_out_.data());
  head_.Forward(weights_, count, second_out_.data(), outputs_.data());
  return outputs_.data();
}

// With w = softmax(s), s_i = q · e_i / √E, a = Σ w_i e_i and g = d loss / da:
//   d/de_i = w_i g + ds_i q / √E,   d/dq = Σ ds_i e_i / √E,   ds_i = w_i (g · e_i − g · a)
void TokenActorCritic::AttendBackward(std::size_t rows) {
  std::fill(query_slopes_.begin(), query_slopes_.end(), 0.0F);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t head = 0; head < kHeads; ++head) {
      const std::size_t at = (row * kHeads + head) * kE;
      const auto query = At(std::as_const(queries_), at);
      auto query_slope = At(query_slopes_, at);
      const auto slope = At(std::as_const(joined_slopes_), attended(row, head));
      const float mean = (slope * At(std::as_const(joined_), attended(row, head))).sum();
      for (std::size_t kind = 0; kind < kTargets; ++kind) {
        Tokens& tokens = kinds_[kind];
        for (std::size_t t = tokens.begin[row]; t < tokens.begin[row + 1]; ++t) {
          const auto embedding = At(std::as_const(tokens.embedding), t * kE);
          const float weight = tokens.scores[t * kHeads + head];
          const float score_slope = weight * ((slope * embedding).sum() - mean) * kScoreScale;
          At(tokens.slopes, t * kE) += weight * slope + score_slope * query;
          query_slope += score_slope * embedding;
        }
      }
    }
  }
}

void TokenActorCritic::EncodeBackward(std::size_t rows, Tokens& tokens) {
  const std::size_t valid = tokens.begin[rows];
  if (valid == 0) return;
  BackwardRelu(valid * kE, tokens.embedding.data(), tokens.slopes.data());
  tokens.second.AddGradient(valid, tokens.middle.data(), tokens.slopes.data(), gradient_);
  tokens.second.BackwardInput(weights_, valid, tokens.slopes.data(), tokens.middle_slopes.data());
  BackwardRelu(valid * kE, tokens.middle.data(), tokens.middle_slopes.data());
  tokens.first.AddGradient(valid, tokens.features.data(), tokens.middle_slopes.data(), gradient_);
}

void TokenActorCritic::Backward(const SequenceRows& rows, const float* slopes) {
  const std::size_t count = rows.rows();
  head_.AddGradient(count, second_out_.data(), slopes, gradient_);
  head_.BackwardInput(weights_, count, slopes, second_slopes_.data());
  BackwardRelu(count * hidden_, second_out_.data(), second_slopes_.data());
  second_.AddGradient(count, first_out_.data(), second_slopes_.data(), gradient_);
  second_.BackwardInput(weights_, count, second_slopes_.data(), first_slopes_.data());
  BackwardRelu(count * hidden_, first_out_.data(), first_slopes_.data());
  first_.AddGradient(count, joined_.data(), first_slopes_.data(), gradient_);
  first_.BackwardInput(weights_, count, first_slopes_.data(), joined_slopes_.data());
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    Tokens& tokens = kinds_[kind];
    std::fill_n(tokens.slopes.begin(), tokens.begin[count] * kE, 0.0F);
    for (std::size_t row = 0; row < count; ++row) {
      const float* const slope = joined_slopes_.data() + row * joined_size_ + hidden_ + kind * kE;
      for (std::size_t i = 0; i < kE; ++i) {
        const std::int32_t best = tokens.best[row * kE + i];
        if (best != kNone) tokens.slopes[static_cast<std::size_t>(best) * kE + i] += slope[i];
      }
    }
  }
  AttendBackward(count);
  for (Tokens& tokens : kinds_) EncodeBackward(count, tokens);
  query_.AddGradient(count, ship_out_.data(), query_slopes_.data(), gradient_);
  query_.BackwardInput(weights_, count, query_slopes_.data(), ship_slopes_.data());
  for (std::size_t row = 0; row < count; ++row) {
    const float* const from = joined_slopes_.data() + row * joined_size_;
    float* const to = ship_slopes_.data() + row * hidden_;
    for (std::size_t i = 0; i < hidden_; ++i) to[i] += from[i];
  }
  BackwardRelu(count * hidden_, ship_out_.data(), ship_slopes_.data());
  ship_.AddGradient(count, ship_in_.data(), ship_slopes_.data(), gradient_);
}

}  // namespace aquafarm::agents
