// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What farms have shown, kept for learning: a ring of moments, each holding one observation of
/// every agent of every farm (an *entry*). Every observation is stored once; a transition is a pair
/// of neighbouring moments, a sequence a run of them.
///
///   moment        t            t+1          t+2
///   observation   o_t          o_t+1        o_t+2
///   action        a_t          a_t+1        …         chosen from o_t
///   reward        r_t          r_t+1        …         that led to o_t
///
/// An episode's last moment has a reason; its action counts for nothing, and the next moment is the
/// first of another episode. So is one that started without a reason before it: the farms were lost
/// in mid-episode, and what was done last led nowhere that is known.

#include <cstdint>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/base/rng.h"

namespace aquafarm::agents {

/// Priorities of Schaul et al. 2016 ("Prioritized experience replay"): a sum tree.
class SumTree {
 public:
  explicit SumTree(std::size_t leaves);
  void Set(std::size_t leaf, float priority);
  float Get(std::size_t leaf) const { return nodes_[leaves_ + leaf]; }
  float Total() const { return nodes_[1]; }
  /// The leaf in which `mass` in [0, Total()) falls.
  std::size_t Find(float mass) const;

 private:
  std::size_t leaves_;        // a power of two
  std::vector<float> nodes_;  // heap order; node 1 is the root
};

struct ReplayOptions {
  std::size_t capacity{100000};    ///< transitions
  std::size_t entries{1};          ///< farms × agents
  std::int32_t agents{1};          ///< of a farm
  std::size_t observation_size{};  ///< numbers of one observation
  std::size_t carry_size{};        ///< numbers that an agent carries from step to step; 0: none
};

/// One transition over n steps, or until its episode ended or was lost.
struct Transition {
  std::size_t from{};  ///< row of the observation; see Replay::observation
  std::size_t to{};    ///< row of the observation that the target looks at
  std::uint8_t action{};
  float reward{};    ///< discounted sum over the steps between
  float discount{};  ///< of the value at `to`; 0 after termination
};

/// What became of all agents of a farm together over n steps, or until their episode ended.
struct JointTransition {
  std::size_t to{};  ///< row of the farm's first agent in the moment that the target looks at
  float discount{};  ///< of the value at `to`, for those agents that are not done there
};

/// Numbers of type Scalar: float features, or bytes of planes.
template <typename Scalar>
class Replay {
 public:
  explicit Replay(const ReplayOptions& options);

  /// Adds a moment. @param observations [entries, observation_size]
  /// @param carry [entries, carry_size] what each agent carried into this moment
  void Add(const Results& results, const Scalar* observations, const float* carry = nullptr);
  /// Completes the newest moment with what was chosen then. @param actions [entries]
  void SetActions(const std::vector<std::uint8_t>& actions);

  /// Moments kept, at most moment_capacity().
  std::size_t size() const { return size_; }
  std::size_t moment_capacity() const { return moments_; }
  std::size_t entries() const { return options_.entries; }

  /// Whether a transition (or a run of `steps` moments) begins here: the moment has `steps` later
  /// ones, its episode was not over, and the next moment is of the same episode, which it is not
  /// where farms were lost on the way. @param age moments after the oldest kept, [0, size())
  bool Begins(std::size_t age, std::size_t entry, std::size_t steps) const {
    return age + steps < size_ && reasons_[Row(age, entry)] == 0 &&
           started_[Row(age + 1, entry)] == 0;
  }
  /// Whether it does for any agent of a farm. @param first entry of its first agent
  bool BeginsForAny(std::size_t age, std::size_t first, std::size_t steps) const {
    for (std::size_t agent = 0; agent < static_cast<std::size_t>(options_.agents); ++agent) {
      if (Begins(age, first + agent, steps)) return true;
    }
    return false;
  }
  /// @returns the transition over `steps` steps that begins at a row where Begins holds
  Transition At(std::size_t age, std::size_t entry, std::size_t steps, float discount) const;

  /// @param first entry of a farm's first agent
  /// @param rewards [agents] gets each agent's discounted sum over the steps between
  JointTransition JointAt(std::size_t age, std::size_t first, std::size_t steps, float discount,
                          float* rewards) const;

  /// Row of a moment's entry in the arrays; stays while the moment is kept.
  std::size_t Row(std::size_t age, std::size_t entry) const {
    return ((oldest_ + age) % moments_) * options_.entries + entry;
  }
  /// Age of the moment of a row.
  std::size_t Age(std::size_t row) const {
    return (row / options_.entries + moments_ - oldest_) % moments_;
  }
  std::size_t rows() const { return moments_ * options_.entries; }
  const Scalar* observation(std::size_t row) const {
    return observations_.data() + row * options_.observation_size;
  }
  const float* carry(std::size_t row) const { return carry_.data() + row * options_.carry_size; }
  ActionMask legal(std::size_t row) const { return legal_[row]; }
  std::uint8_t action(std::size_t row) const { return actions_[row]; }
  float reward(std::size_t row) const { return rewards_[row]; }
  EndReason reason(std::size_t row) const { return static_cast<EndReason>(reasons_[row]); }
  bool started(std::size_t row) const { return started_[row] != 0; }

  /// Bytes of memory that the arrays take.
  std::size_t bytes() const;
  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError when sections are missing or do not fit
  void Load(const Checkpoint& checkpoint);

 private:
  ReplayOptions options_;
  std::size_t moments_;
  std::size_t oldest_{};
  std::size_t size_{};
  std::vector<Scalar> observations_;
  std::vector<float> carry_;
  std::vector<float> rewards_;
  std::vector<ActionMask> legal_;
  std::vector<std::uint8_t> actions_;
  std::vector<std::uint8_t> reasons_;
  std::vector<std::uint8_t> started_;
};

extern template class Replay<float>;
extern template class Replay<std::uint8_t>;

}  // namespace aquafarm::agents
