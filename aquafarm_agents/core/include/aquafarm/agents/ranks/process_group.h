// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The processes of one training, possibly on several hosts. Each process is a *rank*. The ranks
/// find each other with the store of c10d, the communication library of PyTorch. They exchange sums
/// and bytes with Gloo, a backend of c10d (docs/decisions/ranks.md). The virtual functions of
/// ProcessGroup are collective: all ranks must call the same functions in the same order.

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "aquafarm/agents/ranks/rank_variables.h"

namespace aquafarm::agents {

/// Thrown when another rank of the training is missing, has ended or does not answer, when the
/// ranks cannot connect, or when rank 0 cannot open its port. what() is one line.
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
  /// Time that this rank has spent in exchanges so far, including waits for other ranks [s].
  double exchange_s() const { return exchange_s_; }

  /// On every rank, replaces `values` and `numbers` by their sums over all ranks. The vectors are
  /// added as a binary tree of ranks, ((0 + 1) + (2 + 3)) + …, so all ranks receive the same bits.
  /// Each vector must have the same size on all ranks.
  /// @throws RankLost
  virtual void Sum(std::vector<float>& values, std::vector<double>& numbers) = 0;

  /// On rank 0, returns the bytes of each rank, [size()]; on the other ranks an empty vector.
  /// @throws RankLost
  virtual std::vector<std::string> Gather(const std::string& bytes) = 0;

  /// On every rank, returns the bytes of rank 0.
  /// @param bytes ignored on the other ranks
  /// @throws RankLost
  virtual std::string Broadcast(const std::string& bytes) = 0;

  /// Calls `work` on rank 0. The other ranks wait until it has returned, for at most
  /// GroupTimes::work_s. The default of this limit is longer than that of an exchange, because
  /// access to a disk may take longer.
  /// @param work ignored on the other ranks
  /// @throws RankLost; on rank 0 also every exception of `work`, after which the group must not be
  ///   used
  virtual void RunOnRank0(const std::function<void()>& work) = 0;

 protected:
  ProcessGroup(int rank, int size) : rank_(rank), size_(size) {}

  const int rank_;
  const int size_;
  double exchange_s_{};
};

/// Time limits of a process group.
struct GroupTimes {
  double start_s{25.0};   ///< max wait for all ranks at the start [s]
  double answer_s{25.0};  ///< max wait for another rank in an exchange [s]
  double work_s{900.0};   ///< max wait for the work of RunOnRank0 [s]
};

/// Connects this process with the other ranks.
/// @throws RankLost if ranks are missing after start_s, if rank 0 cannot open its port or does not
///   answer, or if the ranks cannot connect
/// @throws InputError if the number of ranks is not a power of two, or if the name of the host of
///   rank 0 cannot be resolved
std::unique_ptr<ProcessGroup> JoinProcessGroup(const RankVariables& variables,
                                               const GroupTimes& times);

/// Calls `work` once for the whole training: on rank 0, or in this process if `group` is null.
/// @throws as ProcessGroup::RunOnRank0, and what `work` throws
inline void RunOnce(ProcessGroup* group, const std::function<void()>& work) {
  if (group == nullptr) return work();
  group->RunOnRank0(work);
}

/// Replaces arrays[0] by the sum of all arrays, added as a binary tree like ProcessGroup::Sum. The
/// contents of the other arrays are then unspecified.
/// @param arrays must have equal sizes; their number must be a power of two
template <typename T>
void AddAsTree(std::vector<std::vector<T>>& arrays) {
  for (std::size_t step = 1; step < arrays.size(); step *= 2) {
    for (std::size_t i = 0; i + step < arrays.size(); i += 2 * step) {
      for (std::size_t k = 0; k < arrays[i].size(); ++k) arrays[i][k] += arrays[i + step][k];
    }
  }
}

}  // namespace aquafarm::agents
