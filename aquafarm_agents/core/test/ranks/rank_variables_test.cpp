// SPDX-License-Identifier: BSD-3-Clause
// The variables of torchrun, mpirun, mpiexec and srun are read, and wrong ones are refused in one
// line.
#include "aquafarm/agents/ranks/rank_variables.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "agents_fixture.h"
#include "aquafarm/agents/ranks/process_group.h"
#include "aquafarm/agents/ranks/processors.h"

namespace aquafarm::agents::test {
namespace {

using Variables = std::map<std::string, std::string>;

RankVariables Read(const Variables& variables) {
  return ReadRankVariables([&](const char* name) -> const char* {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  });
}

std::string Refusal(const Variables& variables) {
  return MessageOf<InputError>([&] { Read(variables); });
}

TEST(RankVariables, WithoutALauncherTheProcessIsAlone) {
  const RankVariables got = Read({{"MASTER_ADDR", "host1"}});
  EXPECT_EQ(got.rank, 0);
  EXPECT_EQ(got.world_size, 1);
}

TEST(RankVariables, ReadsThoseOfTorchrun) {
  const RankVariables got =
      Read({{"RANK", "3"}, {"WORLD_SIZE", "4"}, {"MASTER_ADDR", "host1"}, {"MASTER_PORT", "1234"}});
  EXPECT_EQ(got.rank, 3);
  EXPECT_EQ(got.world_size, 4);
  EXPECT_EQ(got.master_addr, "host1");
  EXPECT_EQ(got.master_port, 1234);
}

TEST(RankVariables, ReadsThoseOfOpenMpiOnOneHost) {
  Variables given{{"OMPI_COMM_WORLD_RANK", "1"},
                  {"OMPI_COMM_WORLD_SIZE", "2"},
                  {"OMPI_COMM_WORLD_LOCAL_SIZE", "2"},
                  {"PMIX_NAMESPACE", "1157038081"}};
  const RankVariables got = Read(given);
  EXPECT_EQ(got.rank, 1);
  EXPECT_EQ(got.world_size, 2);
  EXPECT_EQ(got.master_addr, "127.0.0.1");
  given["PMIX_NAMESPACE"] = "1157038082";
  EXPECT_NE(Read(given).master_port, got.master_port) << "two jobs on one host collide";
  given["OMPI_COMM_WORLD_LOCAL_SIZE"] = "1";
  EXPECT_CONTAINS(Refusal(given), "MASTER_ADDR: not set, but the ranks are on several hosts");
}

TEST(RankVariables, ReadsThoseOfSlurmInAStepOnly) {
  Variables given{{"SLURM_PROCID", "0"},
                  {"SLURM_NTASKS", "8"},
                  {"SLURM_JOB_ID", "77"},
                  {"SLURM_STEP_NODELIST", "node[03-05,09]"}};
  EXPECT_EQ(Read(given).world_size, 1) << "a batch script is not a step of srun";
  given["SLURM_STEP_NUM_TASKS"] = "8";
  EXPECT_EQ(Read(given).world_size, 8);
  EXPECT_EQ(Read(given).master_addr, "node03");
  given["SLURM_STEP_NODELIST"] = "alpha,beta";
  EXPECT_EQ(Read(given).master_addr, "alpha");
  const int port = Read(given).master_port;
  given["SLURM_STEP_ID"] = "0";
  const int first = Read(given).master_port;
  given["SLURM_STEP_ID"] = "1";
  EXPECT_NE(Read(given).master_port, first) << "two steps of one job collide";
  given["SLURM_JOB_ID"] = "78";
  EXPECT_NE(Read(given).master_port, port) << "two jobs on one host collide";
}

TEST(RankVariables, ReadsThoseOfMpichOnOneHost) {
  Variables given{{"PMI_RANK", "1"}, {"PMI_SIZE", "2"}, {"MPI_LOCALNRANKS", "2"}};
  EXPECT_EQ(Read(given).rank, 1);
  EXPECT_EQ(Read(given).master_port, 29500);
  given["PMI_JOBID"] = "4711.0";
  const int port = Read(given).master_port;
  given["PMI_JOBID"] = "4711.1";
  EXPECT_NE(Read(given).master_port, port) << "two jobs on one host collide";
  given["MASTER_PORT"] = "1234";
  EXPECT_EQ(Read(given).master_port, 1234);
}

TEST(RankVariables, RefusesWrongValuesInOneLine) {
  EXPECT_EQ(Refusal({{"RANK", "5"}, {"WORLD_SIZE", "2"}}),
            "RANK: got '5', expected a whole number from 0 to 1");
  EXPECT_EQ(Refusal({{"RANK", "0"}, {"WORLD_SIZE", "two"}}),
            "WORLD_SIZE: got 'two', expected a whole number from 1 to 65536");
  EXPECT_EQ(Refusal({{"RANK", "1 "}, {"WORLD_SIZE", "2"}}),
            "RANK: got '1 ', expected a whole number from 0 to 1");
  EXPECT_EQ(Refusal({{"WORLD_SIZE", "2"}}),
            "RANK: not set, but WORLD_SIZE=2 is; set both, or neither");
  EXPECT_EQ(Refusal({{"RANK", "0"}, {"WORLD_SIZE", "2"}, {"MASTER_PORT", "99999"}}),
            "MASTER_PORT: got '99999', expected a whole number from 1 to 65535");
}

std::vector<int> Listed(const cpu_set_t& set) {
  std::vector<int> found;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(cpu, &set)) found.push_back(cpu);
  }
  return found;
}

TEST(ProcessorsOf, DividesTheAllowedProcessors) {
  cpu_set_t all;
  CPU_ZERO(&all);
  for (const int cpu : {1, 4, 5, 7, 9}) CPU_SET(cpu, &all);
  using Numbers = std::vector<int>;
  EXPECT_EQ(Listed(ProcessorsOf(all, 0, 2)), (Numbers{1, 4}));
  EXPECT_EQ(Listed(ProcessorsOf(all, 1, 2)), (Numbers{5, 7}));
  EXPECT_EQ(Listed(ProcessorsOf(all, 3, 4)), (Numbers{7}));
  EXPECT_EQ(Listed(ProcessorsOf(all, 0, 1)), (Numbers{1, 4, 5, 7, 9}));
  EXPECT_EQ(Listed(ProcessorsOf(all, 5, 8)), (Numbers{1, 4, 5, 7, 9})) << "too few for a share";
}

TEST(AddAsTree, AddsPairsOfPairs) {
  // In float, 1e8 + 1 is 1e8. One after the other these four numbers give 1, as a tree 0.
  std::vector<std::vector<float>> arrays{{1e8F}, {1.0F}, {-1e8F}, {1.0F}};
  EXPECT_EQ(((1e8F + 1.0F) + -1e8F) + 1.0F, 1.0F);
  AddAsTree(arrays);
  EXPECT_EQ(arrays[0][0], 0.0F);
}

}  // namespace
}  // namespace aquafarm::agents::test
