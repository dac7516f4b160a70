// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace aquafarm::agents {

/// Rank of this process among the processes of one training, as set by its launcher.
struct RankVariables {
  int rank{};            ///< [0, world_size)
  int world_size{1};     ///< number of processes; 1: this process trains alone
  std::string launcher;  ///< name of the variable with world_size; empty without a launcher
  std::string master_addr{"127.0.0.1"};  ///< host of rank 0
  int master_port{29500};                ///< TCP port that rank 0 opens
};

/// Returns the value of an environment variable; nullptr if it is not set.
using GetVariable = std::function<const char*(const char*)>;

/// Reads the variables of the first of these launchers that has set them: torchrun (RANK,
/// WORLD_SIZE), Open MPI's mpirun, MPICH's mpiexec, Slurm's srun. Returns the defaults if no
/// launcher has set them. With several processes, also reads the address of rank 0:
///
///   MASTER_ADDR   host of rank 0. If not set: with srun the first host of the Slurm step, else
///                 127.0.0.1
///   MASTER_PORT   port that rank 0 opens. If not set: a hash of the job's name selects a port in
///                 [20000, 29999], so that two jobs on one host rarely use the same one. The name
///                 is in PMIX_NAMESPACE (Open MPI), PMI_JOBID (mpiexec), or SLURM_JOB_ID and
///                 SLURM_STEP_ID (srun). Without a name the port is 29500
///
/// @throws InputError if a variable has a wrong value, if only one of RANK and WORLD_SIZE is set,
///   or if MASTER_ADDR is not set although the ranks are on several hosts
RankVariables ReadRankVariables(const GetVariable& get);

}  // namespace aquafarm::agents
