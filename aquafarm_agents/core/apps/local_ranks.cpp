// SPDX-License-Identifier: BSD-3-Clause
#include "local_ranks.h"

#include <netinet/in.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
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
// Returns its process id, or -1 if it cannot be started.
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
  setpgid(0, 0);  // the parent forwards Ctrl-C, so that it arrives once
  setenv("RANK", std::to_string(rank).c_str(), 1);
  setenv("WORLD_SIZE", std::to_string(ranks).c_str(), 1);
  setenv("LOCAL_WORLD_SIZE", std::to_string(ranks).c_str(), 1);
  setenv("MASTER_ADDR", "127.0.0.1", 1);
  setenv("MASTER_PORT", std::to_string(port).c_str(), 1);
  execv("/proc/self/exe", argv);
  _exit(static_cast<int>(ExitCode::kInternal));
}

// The ranks of one training. If a signal ends one of them, the others detect it within seconds and
// exit. Ranks that still wait for it at the start do not detect it; they are ended after
// kLongestWait.
class LocalRanks {
 public:
  LocalRanks(int ranks, char** argv) {
    const int port = FreePort();
    for (int rank = 0; rank < ranks; ++rank) {
      const pid_t pid = StartRank(rank, ranks, port, argv);
      if (pid > 0) {
        pids_.push_back(pid);
        continue;
      }
      std::fprintf(stderr, "ranks: cannot start rank %d of %d: %s; start fewer ranks\n", rank,
                   ranks, std::strerror(errno));
      result_ = static_cast<int>(ExitCode::kRankLost);
      End();
      return;
    }
  }

  // Waits for the end of all ranks. Returns the exit code of the first that failed, else 0.
  int Wait() {
    while (running() > 0) {
      if (stop_requested && !is_forwarded_) {
        is_forwarded_ = true;
        Signal(SIGINT);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      for (std::size_t rank = 0; rank < pids_.size(); ++rank) Look(rank);
      EndThoseThatWait();
    }
    return result_;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kLongestWait{10};

  std::ptrdiff_t running() const {
    return std::count_if(pids_.begin(), pids_.end(), [](pid_t pid) { return pid != 0; });
  }

  void Signal(int signal) const {
    for (const pid_t pid : pids_) {
      if (pid != 0) kill(pid, signal);
    }
  }

  void End() {
    is_ending_ = true;
    Signal(SIGKILL);
  }

  // Records the exit code of a rank if it has ended.
  void Look(std::size_t rank) {
    pid_t& pid = pids_[rank];
    int status = 0;
    if (pid == 0 || waitpid(pid, &status, WNOHANG) != pid) return;
    pid = 0;
    const bool is_killed = WIFSIGNALED(status);
    if (result_ == 0) {
      result_ = is_killed ? static_cast<int>(ExitCode::kRankLost) : WEXITSTATUS(status);
    }
    if (!is_killed || is_ending_) return;
    std::fprintf(stderr, "rank %zu was ended by signal %d\n", rank, WTERMSIG(status));
    if (!killed_at_) killed_at_ = Clock::now();
  }

  void EndThoseThatWait() {
    if (is_ending_ || running() == 0) return;
    if (!killed_at_ || Clock::now() - *killed_at_ < kLongestWait) return;
    std::fprintf(stderr,
                 "ranks: %td of %zu have not ended within %d s after another rank; ending them; "
                 "resume from the last checkpoint\n",
                 running(), pids_.size(), static_cast<int>(kLongestWait.count()));
    End();
  }

  std::vector<pid_t> pids_;                     // by rank; 0 after the process has ended
  std::optional<Clock::time_point> killed_at_;  // when a signal ended the first rank
  bool is_forwarded_{};
  bool is_ending_{};
  int result_{};
};

}  // namespace

int RunLocalRanks(int ranks, char** argv) {
  StopOnSignals();
  std::signal(SIGCHLD, SIG_DFL);  // if the caller ignored it, waitpid would find no child
  return LocalRanks(ranks, argv).Wait();
}

}  // namespace aquafarm::agents
