// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Replay buffer: a ring of time steps. A time step contains one observation for each slot, that
/// is, for each agent of each farm. A transition over one step consists of two consecutive time
/// steps. Each observation is stored once, even if one transition ends and another one begins with
/// it.
///
///   time step     t            t+1          t+2
///   observation   o_t          o_t+1        o_t+2
///   action        a_t          a_t+1        …         a_t was chosen at o_t
///   reward        r_t          r_t+1        …         r_t was received on the way to o_t
///
/// The last time step of an episode has an end reason. Its action is unused, and the next time step
/// is the first of another episode. If an agent is done before its farm, its slot has the end
/// reason kAllRetrieved until the episode ends. If a time step has is_first = 1 and the time step
/// before it has no end reason, the farms were *lost*: they started new episodes in mid-episode,
/// because the sim node restarted or another client changed them. The outcome of the last action is
/// then unknown.

#include <cstdint>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/base/rng.h"

namespace aquafarm::agents {

/// Sum tree of priorities (Schaul et al. 2016, "Prioritized experience replay").
class SumTree {
 public:
  /// Makes a tree in which all priorities are 0.
  explicit SumTree(std::size_t leaves);
  void Set(std::size_t leaf, float priority);
  float Get(std::size_t leaf) const { return nodes_[leaves_ + leaf]; }
  /// Returns the sum of all priorities.
  float Total() const { return nodes_[1]; }
  /// Returns the leaf at which the cumulative sum of the priorities first exceeds `mass`.
  /// @param mass in [0, Total())
  std::size_t Find(float mass) const;

 private:
  std::size_t leaves_;        // a power of two
  std::vector<float> nodes_;  // heap order; node 1 is the root
};

/// Sizes of a replay buffer.
struct ReplayOptions {
  /// Max number of stored observations, each of one agent. The buffer has space for at least two
  /// time steps, even if these have more observations than this number.
  std::size_t capacity{100000};
  std::size_t slots{1};            ///< farms × agents
  std::int32_t agents{1};          ///< agents per farm
  std::size_t observation_size{};  ///< values per observation
  std::size_t recurrent_size{};    ///< values of an agent's recurrent state; 0 if there is none
};

/// A transition over n steps, or fewer if the episode ended or the farms were lost.
struct Transition {
  std::size_t from{};  ///< row of the first observation; see Replay::observation
  std::size_t to{};    ///< row of the observation from which the target bootstraps
  std::uint8_t action{};
  float reward{};    ///< discounted sum of the rewards of the steps
  float discount{};  ///< factor of the value at `to`; 0 after termination
};

/// A transition of all agents of a farm over n steps, or fewer if the episode ended for all agents
/// or the farms were lost.
struct JointTransition {
  std::size_t to{};  ///< row of the farm's first agent at the time step of the bootstrap value
  float discount{};  ///< factor of the value at `to`, for agents that are not done there
};

/// Replay buffer with observations of type Scalar: float features, or bytes of planes.
template <typename Scalar>
class Replay {
 public:
  explicit Replay(const ReplayOptions& options);

  /// Adds a time step.
  /// @param observations [slots, observation_size]
  /// @param recurrent_state [slots, recurrent_size] of each agent before this time step; may be
  ///   null if recurrent_size is 0
  void Add(const StepResults& results, const Scalar* observations,
           const float* recurrent_state = nullptr);
  /// Adds the chosen actions to the newest time step. @param actions [slots]
  void SetActions(const std::vector<std::uint8_t>& actions);

  /// Number of stored time steps, at most max_size().
  std::size_t size() const { return size_; }
  std::size_t max_size() const { return max_size_; }
  std::size_t slots() const { return options_.slots; }

  /// Returns whether a transition begins at this time step: at least `steps` later time steps are
  /// stored, the slot has no end reason, and the next time step belongs to the same episode. (The
  /// next time step belongs to another episode if the farms were lost.)
  /// @param age number of time steps after the oldest stored one, [0, size())
  bool Begins(std::size_t age, std::size_t slot, std::size_t steps) const {
    return age + steps < size_ && end_reasons_[Row(age, slot)] == 0 &&
           is_first_[Row(age + 1, slot)] == 0;
  }
  /// Returns whether Begins is true for any agent of a farm.
  /// @param first slot of the farm's first agent
  bool BeginsForAny(std::size_t age, std::size_t first, std::size_t steps) const {
    for (std::size_t agent = 0; agent < static_cast<std::size_t>(options_.agents); ++agent) {
      if (Begins(age, first + agent, steps)) return true;
    }
    return false;
  }
  /// Returns the transition over `steps` steps that begins at time step `age`. Begins must be true
  /// for the same arguments.
  /// @param discount γ per step
  Transition At(std::size_t age, std::size_t slot, std::size_t steps, float discount) const;

  /// Returns the transition of all agents of a farm over `steps` steps that begins at time step
  /// `age`. BeginsForAny must be true for the same arguments.
  /// @param first slot of the farm's first agent
  /// @param discount γ per step
  /// @param rewards receives the discounted sum of each agent's rewards, [agents]
  JointTransition JointAt(std::size_t age, std::size_t first, std::size_t steps, float discount,
                          float* rewards) const;

  /// Returns the row of the arrays with the data of a slot at time step `age`. The row does not
  /// change while the time step is stored.
  std::size_t Row(std::size_t age, std::size_t slot) const {
    return ((oldest_ + age) % max_size_) * options_.slots + slot;
  }
  /// Returns the age of the time step that contains a row.
  std::size_t Age(std::size_t row) const {
    return (row / options_.slots + max_size_ - oldest_) % max_size_;
  }
  std::size_t rows() const { return max_size_ * options_.slots; }
  const Scalar* observation(std::size_t row) const {
    return observations_.data() + row * options_.observation_size;
  }
  const float* recurrent_state(std::size_t row) const {
    return recurrent_state_.data() + row * options_.recurrent_size;
  }
  ActionMask legal(std::size_t row) const { return legal_[row]; }
  std::uint8_t action(std::size_t row) const { return actions_[row]; }
  float reward(std::size_t row) const { return rewards_[row]; }
  EndReason reason(std::size_t row) const { return static_cast<EndReason>(end_reasons_[row]); }
  bool is_first(std::size_t row) const { return is_first_[row] != 0; }

  /// Returns the size of the arrays [bytes].
  std::size_t bytes() const;
  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError if sections are missing or do not fit
  void Load(const Checkpoint& checkpoint);

 private:
  ReplayOptions options_;
  std::size_t max_size_;
  std::size_t oldest_{};
  std::size_t size_{};
  std::vector<Scalar> observations_;
  std::vector<float> recurrent_state_;
  std::vector<float> rewards_;
  std::vector<ActionMask> legal_;
  std::vector<std::uint8_t> actions_;
  std::vector<std::uint8_t> end_reasons_;
  std::vector<std::uint8_t> is_first_;
};

extern template class Replay<float>;
extern template class Replay<std::uint8_t>;

}  // namespace aquafarm::agents
