// SPDX-License-Identifier: BSD-3-Clause
#include "local_ranks.h"

#include <netinet/in.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "app.h"
#include "aquafarm/agents/base/exit_code.h"
#include "aquafarm/agents/ranks/processors.h"
#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

// Returns a TCP port of the loopback interface that is free now.
int FreePort() {
  const int s = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  const bool is_bound = s >= 0 && bind(s, any, size) == 0 && getsockname(s, any, &size) == 0;
  if (s >= 0) close(s);
  if (!is_bound) throw InputError("ranks: found no free TCP port on 127.0.0.1");
  return ntohs(address.sin_port);
}

// Starts rank `rank` of this program with the variables of torchrun. A rank ends with its parent.
pid_t StartRank(int rank, int ranks, int port, char** argv) {
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child != 0) return child;
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(static_cast<int>(ExitCode::kRankLost));
  cpu_set_t processors;
  if (sched_getaffinity(0, sizeof(processors), &processors) == 0) {
    processors = ProcessorsOf(processors, rank, ranks);
    sched_setaffinity(0, sizeof(processors), &processors);
  }
  setpgid(0, 0);  // Ctrl-C reaches it through the parent, once
  setenv("RANK", std::to_string(rank).c_str(), 1);
  setenv("WORLD_SIZE", std::to_string(ranks).c_str(), 1);
  setenv("LOCAL_WORLD_SIZE", std::to_string(ranks).c_str(), 1);
  setenv("MASTER_ADDR", "127.0.0.1", 1);
  setenv("MASTER_PORT", std::to_string(port).c_str(), 1);
  execv("/proc/self/exe", argv);
  _exit(static_cast<int>(ExitCode::kInternal));
}

}  // namespace

int RunLocalRanks(int ranks, char** argv) {
  StopOnSignals();
  std::signal(SIGCHLD, SIG_DFL);  // if the caller ignored it, waitpid would find no child
  const int port = FreePort();
  std::vector<pid_t> pids;
  for (int rank = 0; rank < ranks; ++rank) {
    pids.push_back(StartRank(rank, ranks, port, argv));
    if (pids.back() > 0) continue;
    std::fprintf(stderr, "ranks: cannot start rank %d of %d: %s; start fewer ranks\n", rank, ranks,
                 std::strerror(errno));
    for (const pid_t pid : pids) {
      if (pid > 0) kill(pid, SIGKILL);
    }
    return static_cast<int>(ExitCode::kRankLost);
  }
  int result = 0;
  bool is_forwarded = false;
  for (int left = ranks; left > 0;) {
    if (stop_requested && !is_forwarded) {
      is_forwarded = true;
      for (const pid_t pid : pids) {
        if (pid != 0) kill(pid, SIGINT);
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    for (int rank = 0; rank < ranks; ++rank) {
      pid_t& pid = pids[static_cast<std::size_t>(rank)];
      int status = 0;
      if (pid == 0 || waitpid(pid, &status, WNOHANG) != pid) continue;
      const bool has_ended = WIFEXITED(status);
      if (WIFSIGNALED(status)) {
        std::fprintf(stderr, "rank %d was ended by signal %d\n", rank, WTERMSIG(status));
      }
      const int code = has_ended ? WEXITSTATUS(status) : static_cast<int>(ExitCode::kRankLost);
      if (result == 0) result = code;
      pid = 0;
      --left;
    }
  }
  return result;
}

}  // namespace aquafarm::agents
