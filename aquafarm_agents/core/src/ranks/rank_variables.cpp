// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/ranks/rank_variables.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

struct Launcher {
  const char* rank;
  const char* size;
  const char* local_size;          ///< number of processes on this host; nullptr: no such variable
  std::array<const char*, 2> job;  ///< names that identify the job; nullptr: unused
};

// The names of the variables that each launcher sets. SLURM_NTASKS is not listed, because it is
// also set in a batch script outside of srun.
constexpr std::array<Launcher, 4> kLaunchers{{
    {"RANK", "WORLD_SIZE", "LOCAL_WORLD_SIZE", {}},
    {"OMPI_COMM_WORLD_RANK",
     "OMPI_COMM_WORLD_SIZE",
     "OMPI_COMM_WORLD_LOCAL_SIZE",
     {"PMIX_NAMESPACE"}},
    {"PMI_RANK", "PMI_SIZE", "MPI_LOCALNRANKS", {"PMI_JOBID"}},
    {"SLURM_PROCID", "SLURM_STEP_NUM_TASKS", nullptr, {"SLURM_JOB_ID", "SLURM_STEP_ID"}},
}};

constexpr int kMaxRanks = 65536;
constexpr int kMaxPort = 65535;
constexpr std::uint32_t kFirstJobPort = 20000;  // job ports are below Linux' ephemeral ports
constexpr std::uint32_t kJobPorts = 10000;

int ReadNumber(const char* name, std::string_view text, int min, int max) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < min || value > max) {
    throw InputError(std::string(name) + ": got '" + std::string(text) +
                     "', expected a whole number from " + std::to_string(min) + " to " +
                     std::to_string(max));
  }
  return value;
}

// Returns the first host of a Slurm list: node03 for "node[03-05,07]" and for "node03,node04".
std::string FirstHost(std::string_view hosts) {
  const std::size_t bracket = hosts.find_first_of("[,");
  std::string first(hosts.substr(0, bracket));
  if (bracket == std::string_view::npos || hosts[bracket] == ',') return first;
  const std::string_view numbers = hosts.substr(bracket + 1);
  return first.append(numbers.substr(0, numbers.find_first_of(",-]")));
}

// Returns the 32-bit FNV-1a hash (Fowler, Noll, Vo).
std::uint32_t Hash(std::string_view text) {
  std::uint32_t hash = 2166136261U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  return hash;
}

// Returns the name of the job; empty if the launcher sets no variable that identifies it.
std::string JobOf(const Launcher& launcher, const GetVariable& get) {
  std::string job;
  for (const char* const name : launcher.job) {
    const char* const value = name == nullptr ? nullptr : get(name);
    if (value != nullptr) job += std::string(job.empty() ? "" : ".") + value;
  }
  return job;
}

void ReadMaster(const Launcher& launcher, const GetVariable& get, RankVariables& variables) {
  if (const char* const address = get("MASTER_ADDR"); address != nullptr && *address != '\0') {
    variables.master_addr = address;
  } else if (const char* const hosts = get("SLURM_STEP_NODELIST");
             hosts != nullptr && std::string_view(launcher.rank) == "SLURM_PROCID") {
    variables.master_addr = FirstHost(hosts);
  } else if (launcher.local_size != nullptr) {
    const char* const local = get(launcher.local_size);
    if (local != nullptr &&
        ReadNumber(launcher.local_size, local, 1, kMaxRanks) != variables.world_size) {
      throw InputError(
          "MASTER_ADDR: not set, but the ranks are on several hosts; expected the "
          "host of rank 0, such as mpirun -x MASTER_ADDR=host1");
    }
  }
  if (const char* const port = get("MASTER_PORT"); port != nullptr) {
    variables.master_port = ReadNumber("MASTER_PORT", port, 1, kMaxPort);
  } else if (const std::string job = JobOf(launcher, get); !job.empty()) {
    variables.master_port = static_cast<int>(kFirstJobPort + Hash(job) % kJobPorts);
  }
}

}  // namespace

RankVariables ReadRankVariables(const GetVariable& get) {
  RankVariables variables;
  for (const Launcher& launcher : kLaunchers) {
    const char* const rank = get(launcher.rank);
    const char* const size = get(launcher.size);
    const bool is_torchrun = &launcher == kLaunchers.data();
    if (is_torchrun && (rank == nullptr) != (size == nullptr)) {
      const bool lacks_rank = rank == nullptr;
      throw InputError(std::string(lacks_rank ? launcher.rank : launcher.size) + ": not set, but " +
                       (lacks_rank ? launcher.size : launcher.rank) + "=" +
                       (lacks_rank ? size : rank) + " is; set both, or neither");
    }
    if (rank == nullptr || size == nullptr) continue;
    variables.launcher = launcher.size;
    variables.world_size = ReadNumber(launcher.size, size, 1, kMaxRanks);
    variables.rank = ReadNumber(launcher.rank, rank, 0, variables.world_size - 1);
    if (variables.world_size > 1) ReadMaster(launcher, get, variables);
    break;
  }
  return variables;
}

}  // namespace aquafarm::agents
