// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The processes of one training, possibly on several hosts. They find each other by the store of
/// c10d, the communication library of PyTorch, and exchange sums and bytes over its transport, Gloo
/// (docs/decisions/ranks.md). Every function of ProcessGroup is collective: all ranks call the same
/// functions in the same order.

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "aquafarm/agents/ranks/rank_variables.h"

namespace aquafarm::agents {

/// Thrown when another rank of the training is missing, has ended or does not answer. what() is one
/// line that names it.
class RankLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The ranks of a training, which sum their gradients and exchange arrays.
class ProcessGroup {
 public:
  virtual ~ProcessGroup() = default;

  int rank() const { return rank_; }
  int size() const { return size_; }
  /// Seconds that this rank has spent in exchanges so far, waiting for other ranks included.
  double exchange_s() const { return exchange_s_; }

  /// Replaces `values` and `numbers` by their sums over all ranks, on every rank. They are added as
  /// a binary tree, ((0 + 1) + (2 + 3)) + …, so every rank receives the same bits. The sizes must
  /// be equal on all ranks, and size() must be a power of two.
  /// @throws RankLost
  virtual void Sum(std::vector<float>& values, std::vector<double>& numbers) = 0;

  /// Returns the bytes of all ranks in their order on rank 0; empty on the others.
  /// @throws RankLost
  virtual std::vector<std::string> Gather(const std::string& bytes) = 0;

  /// Returns the bytes of rank 0 on every rank. @param bytes are ignored on the others
  /// @throws RankLost
  virtual std::string Broadcast(const std::string& bytes) = 0;

  /// Calls `work` on rank 0, while the other ranks wait until it returns, for up to
  /// GroupTimes::work_s. A disk may need longer than an exchange. @param work is ignored on the
  /// others
  /// @throws RankLost, and on rank 0 what `work` throws, after which the group must not be used
  virtual void RunOnRank0(const std::function<void()>& work) = 0;

 protected:
  ProcessGroup(int rank, int size) : rank_(rank), size_(size) {}

  const int rank_;
  const int size_;
  double exchange_s_{};
};

struct GroupTimes {
  double start_s{25.0};   ///< max wait for all ranks at the start
  double answer_s{25.0};  ///< max wait for another rank in an exchange
  double work_s{900.0};   ///< max wait for the work of RunOnRank0
};

/// Connects this process with the other ranks.
/// @throws RankLost naming the ranks that are missing after start_s, or the address that does not
///         answer; InputError if the number of ranks is not a power of two, or the name of the
///         host of rank 0 is unknown
std::unique_ptr<ProcessGroup> JoinProcessGroup(const RankVariables& variables,
                                               const GroupTimes& times);

/// Calls `work` once for the training: on rank 0, or in this process if `group` is null.
/// @throws as ProcessGroup::RunOnRank0
inline void RunOnce(ProcessGroup* group, const std::function<void()>& work) {
  if (group == nullptr) return work();
  group->RunOnRank0(work);
}

/// Replaces arrays[0] by the sum of all arrays, added as a binary tree. The other arrays then hold
/// partial sums. @param arrays of equal size; their number is a power of two
template <typename T>
void AddAsTree(std::vector<std::vector<T>>& arrays) {
  for (std::size_t step = 1; step < arrays.size(); step *= 2) {
    for (std::size_t i = 0; i + step < arrays.size(); i += 2 * step) {
      for (std::size_t k = 0; k < arrays[i].size(); ++k) arrays[i][k] += arrays[i + step][k];
    }
  }
}

}  // namespace aquafarm::agents
