// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace aquafarm::agents {

/// Place of this process among the processes of one training, as its launcher describes it.
struct RankVariables {
  int rank{};            ///< [0, world_size)
  int world_size{1};     ///< 1: this process trains alone
  std::string launcher;  ///< variable that holds the number of processes; empty if there is none
  std::string master_addr{"127.0.0.1"};  ///< host of rank 0
  int master_port{29500};                ///< TCP port that rank 0 opens
};

/// Returns the value of an environment variable, nullptr if it is not set.
using GetVariable = std::function<const char*(const char*)>;

/// Reads the variables of torchrun (RANK, WORLD_SIZE), Open MPI's mpirun, MPICH's mpiexec or
/// Slurm's srun, in this order, and MASTER_ADDR and MASTER_PORT.
///
/// Without MASTER_ADDR rank 0 is on this host if all ranks are, or on the first host of a Slurm
/// step. Without MASTER_PORT the port follows from the job (PMIX_NAMESPACE of Open MPI, PMI_JOBID
/// of mpiexec, SLURM_JOB_ID and SLURM_STEP_ID of srun), one of 10,000, so that two jobs on one host
/// seldom meet. It is 29500 if the launcher sets none of these.
/// @throws InputError naming the variable, its value and the expected range
RankVariables ReadRankVariables(const GetVariable& get);

}  // namespace aquafarm::agents
