// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Runs a program as a child process of a test, with time limits.

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

namespace aquafarm::agents::test {

/// A child process. The destructor kills it if Wait has not seen its end.
class Process {
 public:
  /// Starts a program.
  /// @param arguments path of the program, then its arguments
  /// @param output path of the file that receives stdout and stderr
  Process(std::vector<std::string> arguments, const std::string& output) {
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ != 0) return;
    const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }
  ~Process() {
    if (pid_ <= 0) return;
    Kill(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void Kill(int signal) const { kill(pid_, signal); }

  /// Returns the running child processes of the program.
  std::vector<pid_t> Children() const {
    const std::string id = std::to_string(pid_);
    std::ifstream file("/proc/" + id + "/task/" + id + "/children");
    return {std::istream_iterator<pid_t>(file), {}};
  }

  /// Waits for the end of the program.
  /// @returns its exit code; −n if signal n ended it; −1000 if it did not end within the limit
  int Wait(double limit_s = 60.0) {
    const auto start = std::chrono::steady_clock::now();
    int status = 0;
    while (waitpid(pid_, &status, WNOHANG) == 0) {
      if (std::chrono::steady_clock::now() - start > std::chrono::duration<double>(limit_s)) {
        return -1000;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  pid_t pid_{};
};

/// Polls until condition() returns true. Returns false if it does not within the time limit.
template <typename Condition>
bool WaitUntil(Condition&& condition, double limit_s = 30.0) {
  const auto start = std::chrono::steady_clock::now();
  while (!condition()) {
    if (std::chrono::steady_clock::now() - start > std::chrono::duration<double>(limit_s)) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace aquafarm::agents::test
