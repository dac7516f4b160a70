// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "ppo/actor_critic.h"
#include "ppo/linear.h"
#include "ppo/token_layout.h"

namespace aquafarm::agents {

/// The ActorCritic of entity tokens (token_layout.h). All tokens of one kind share an encoder, so
/// the outputs do not depend on the order of the tokens, and the weights do not depend on the
/// number of slots:
///
///   ship      x = ReLU(Linear(ship))
///   token     e = ReLU(Linear(ReLU(Linear(token))))      one encoder for each kind
///   maximum   m = max over the valid tokens of a kind; m = 0 without a valid token
///   attention a = Σ softmax(q · e / √E) e over devices and ports, for each of kHeads queries
///             q = Linear(x); a = 0 without a valid token
///   outputs   Linear(ReLU(Linear(ReLU(Linear([x, m…, a…])))))
///
/// A token is valid if its slot holds an entity. The other slots are skipped and take no time.
class TokenActorCritic final : public ActorCritic {
 public:
  TokenActorCritic(const TokenLayout& layout, std::size_t hidden, std::uint64_t seed);

  std::size_t state_size() const override { return 0; }
  std::size_t chunk_rows() const override { return 256; }
  const float* Forward(const SequenceRows& rows, float* state_after) override;
  void Backward(const SequenceRows& rows, const float* slopes) override;

  inline static constexpr std::size_t kEmbedding = 48;  ///< E: units of each layer of an encoder
  inline static constexpr std::size_t kHeads = 2;       ///< number of attention queries

 private:
  inline static constexpr std::size_t kKinds = kTokenKindCount - 1;  // without the ship
  inline static constexpr std::size_t kTargets = 2;                  // devices and ports

  /// The valid tokens of one kind in a batch, row after row.
  struct Tokens {
    TokenGroup group;
    Linear first;
    Linear second;
    std::vector<std::size_t> begin;  // [rows + 1] index of the first token of each row
    std::vector<float> features;     // [tokens, size]
    std::vector<float> middle;       // [tokens, E]
    std::vector<float> embedding;    // [tokens, E]
    std::vector<float> middle_slopes;
    std::vector<float> slopes;
    std::vector<float> scores;       // [tokens, kHeads] softmax weights; devices and ports only
    std::vector<std::int32_t> best;  // [rows, E] token with the maximum; kNone: the maximum is 0
  };

  void Reserve(std::size_t rows);
  void Collect(const SequenceRows& rows, Tokens& tokens);
  void PoolMax(std::size_t rows, std::size_t kind);
  void Attend(std::size_t rows);
  void AttendBackward(std::size_t rows);
  void EncodeBackward(std::size_t rows, Tokens& tokens);
  float* joined_max(std::size_t row, std::size_t kind) {
    return joined_.data() + row * joined_size_ + hidden_ + kind * kEmbedding;
  }
  std::size_t attended(std::size_t row, std::size_t head) const {
    return row * joined_size_ + hidden_ + (kKinds + head) * kEmbedding;
  }

  const std::size_t hidden_;
  const std::size_t joined_size_;
  const std::size_t features_;  // number of features of a row
  Linear ship_;
  std::array<Tokens, kKinds> kinds_;
  Linear query_;
  Linear first_;
  Linear second_;
  Linear head_;
  // [rows, …] activations of the last Forward, and slopes of the last Backward
  std::vector<float> ship_in_;
  std::vector<float> ship_out_;
  std::vector<float> queries_;
  std::vector<float> joined_;
  std::vector<float> first_out_;
  std::vector<float> second_out_;
  std::vector<float> outputs_;
  std::vector<float> ship_slopes_;
  std::vector<float> query_slopes_;
  std::vector<float> joined_slopes_;
  std::vector<float> first_slopes_;
  std::vector<float> second_slopes_;
};

}  // namespace aquafarm::agents
