// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Policies in Python: a function such as act(observations, masks) in a file, or a model of
/// Stable-Baselines3. The function or model runs in a separate process, so that it may use any
/// Python and any package. The process runs aquafarm_agents/scripts/serve_policy.py, which
/// describes the messages.

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/base/mutex.h"

namespace aquafarm::agents {

/// Returns whether the text is FILE.py, FILE.py:FUNCTION or FILE.zip.
bool IsPythonPolicy(const std::string& where);

/// A Python process that chooses actions. Its interpreter is $AQUAFARM_PYTHON, else the python of
/// the active virtual environment, else python3. Thread-safe.
class PolicyProcess {
 public:
  /// Default of answer_limit_s [s].
  static constexpr int kAnswerLimit_s = 60;

  /// Starts the process and waits for up to 180 s until the policy is loaded.
  /// @param where FILE.py, FILE.py:FUNCTION or FILE.zip
  /// @param answer_limit_s max time for sending one array to the process in Act, and for receiving
  ///   one array from it [s]
  /// @throws InputError if the process cannot start or load the policy
  explicit PolicyProcess(const std::string& where, int answer_limit_s = kAnswerLimit_s);
  ~PolicyProcess();
  PolicyProcess(const PolicyProcess&) = delete;
  PolicyProcess& operator=(const PolicyProcess&) = delete;

  /// The observation type that the policy reads: kIndexBit, kFeaturesBit or kPlanesBit.
  std::uint8_t observation_types() const { return observation_types_; }

  /// Chooses the actions of all agents.
  /// @param actions is resized to [N, S]
  /// @throws InputError if the policy fails or returns invalid actions. If the process reports
  ///   the error itself, Act may be called again. After any other error, such as a timeout, Act
  ///   closes the connection, and each later call throws the same error
  void Act(const EnvironmentSpec& spec, const StepResults& results,
           std::vector<std::uint8_t>& actions);

 private:
  using Clock = std::chrono::steady_clock;

  /// A time limit for the process.
  struct Limit {
    int seconds;
    const char* expected;  ///< end of the error message after this time
  };

  std::string ReadLine(const Limit& limit);
  std::string Ask(const EnvironmentSpec& spec, const StepResults& results,
                  std::vector<std::uint8_t>& actions);
  void Await(int events, Clock::time_point end, const Limit& limit) const;
  void Send(const void* bytes, std::size_t count, const Limit& limit);
  void Receive(void* bytes, std::size_t count, const Limit& limit);
  [[noreturn]] void Fail(const std::string& reason) const;
  std::uint8_t KindOf(const std::string& line) const;
  void Stop();
  void Start(const std::vector<std::string>& command, bool keeps_python_path);

  std::string where_;
  int socket_{-1};
  int process_{-1};
  std::uint8_t observation_types_{};
  Limit answer_limit_;
  std::string broken_;  // the error after which the connection was closed; empty while it is open
  Mutex mutex_;         // locked during a request and its answer
};

/// Returns a policy that requests its actions from `process`. Several policies may share a process.
std::unique_ptr<Policy> MakePythonPolicy(std::shared_ptr<PolicyProcess> process,
                                         const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
