// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/python_policy.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "aquafarm/agents/base/text.h"
#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

namespace fs = std::filesystem;

constexpr int kStartLimit_s = 180;  // importing torch takes long on a busy machine
constexpr int kChildSocket = 3;
constexpr std::uint32_t kMaxWords = 4096;  // max bytes of an error
constexpr const char* kEnded =
    "its Python process has ended, its last lines are above; AQUAFARM_PYTHON selects a Python";

// Returns the path of serve_policy.py: next to this program if it is installed there, else in the
// sources.
std::string ServerPath() {
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path installed = program.parent_path() / "serve_policy.py";
  return fs::exists(installed, ignored) ? installed.string()
                                        : AQUAFARM_SCRIPT_DIR "/serve_policy.py";
}

const char* Variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr || *value == '\0' ? nullptr : value;
}

// The observations of all agents as bytes, and the shape of one observation.
struct Observations {
  const void* data{};
  std::size_t size{};
  std::array<std::uint32_t, 3> shape{1, 1, 1};
};

Observations ObservationsOf(std::uint8_t observation_types, const EnvironmentSpec& spec,
                            const StepResults& results) {
  const auto count = [](std::int32_t value) { return static_cast<std::uint32_t>(value); };
  if (observation_types == kIndexBit) {
    return {results.index.data(), results.index.size() * sizeof(std::uint32_t)};
  }
  if (observation_types == kPlanesBit) {
    return {results.planes.data(),
            results.planes.size(),
            {count(spec.plane_count), count(spec.height), count(spec.width)}};
  }
  return {results.features.data(),
          results.features.size() * sizeof(float),
          {count(spec.feature_count), 1, 1}};
}

class PythonPolicy final : public Policy {
 public:
  PythonPolicy(std::shared_ptr<PolicyProcess> process, EnvironmentSpec spec)
      : process_(std::move(process)), spec_(std::move(spec)) {}
  std::uint8_t observation_types() const override { return process_->observation_types(); }
  void Begin(std::uint64_t, std::int32_t) override {}
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override {
    process_->Act(spec_, results, actions);
  }

 private:
  std::shared_ptr<PolicyProcess> process_;
  EnvironmentSpec spec_;
};

}  // namespace

bool IsPythonPolicy(const std::string& where) {
  const bool has_stem = where != ".py" && where != ".zip";
  return (has_stem && (EndsWith(where, ".py") || EndsWith(where, ".zip"))) ||
         where.find(".py:") != std::string::npos;
}

PolicyProcess::PolicyProcess(const std::string& where, int answer_limit_s)
    : where_(where),
      answer_limit_{answer_limit_s,
                    "expected its actions: make act faster, or play fewer farms at a time"} {
  const char* const chosen = Variable("AQUAFARM_PYTHON");
  const char* const venv = Variable("VIRTUAL_ENV");
  std::string python = "python3";
  if (chosen != nullptr) {
    python = chosen;
  } else if (venv != nullptr) {
    python = std::string(venv) + "/bin/python";
  }
  // ROS sets PYTHONPATH to packages for Debian's Python. They would hide packages of another
  // Python.
  const bool is_default = chosen == nullptr && venv == nullptr;
  Start({python, ServerPath(), std::to_string(kChildSocket), where_}, is_default);
  try {
    observation_types_ =
        KindOf(ReadLine({kStartLimit_s,
                         "expected the kind of its observations: make its import faster, "
                         "or start it on a less busy machine"}));
  } catch (...) {
    Stop();
    throw;
  }
}

std::uint8_t PolicyProcess::KindOf(const std::string& line) const {
  if (line == "index") return kIndexBit;
  if (line == "planes") return kPlanesBit;
  if (line != "features") Fail(line);
  return kFeaturesBit;
}

PolicyProcess::~PolicyProcess() { Stop(); }

void PolicyProcess::Stop() {
  close(socket_);  // the process then reads the end of its input, and ends
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    if (waitpid(process_, nullptr, WNOHANG) != 0) return;
    poll(nullptr, 0, 20);
  }
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

void PolicyProcess::Start(const std::vector<std::string>& command, bool keeps_python_path) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw InputError("policy " + where_ + ": cannot open a socket: " + std::strerror(errno));
  }
  socket_ = ends[0];
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::vector<char*> variables;
  for (char** one = environ; *one != nullptr; ++one) {
    if (keeps_python_path || std::strncmp(*one, "PYTHONPATH=", 11) != 0) variables.push_back(*one);
  }
  variables.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ends[1], kChildSocket);
  const int error =
      posix_spawnp(&process_, arguments[0], &actions, nullptr, arguments.data(), variables.data());
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (error == 0) return;
  process_ = -1;
  close(socket_);
  throw InputError("policy " + where_ + ": cannot start " + command[0] + ": " +
                   std::strerror(error) + "; set AQUAFARM_PYTHON to a Python");
}

void PolicyProcess::Fail(const std::string& reason) const {
  throw InputError("policy " + where_ + ": " + reason);
}

std::string PolicyProcess::ReadLine(const Limit& limit) {
  std::string line;
  for (char one = 0; line.size() < kMaxWords;) {
    Receive(&one, 1, limit);
    if (one == '\n') break;
    line += one;
  }
  return line;
}

void PolicyProcess::Await(int events, Clock::time_point end, const Limit& limit) const {
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) {
      Fail("got no answer within " + std::to_string(limit.seconds) + " s, " + limit.expected);
    }
    pollfd ready{socket_, static_cast<short>(events), 0};
    if (poll(&ready, 1, static_cast<int>(left)) > 0) return;
  }
}

void PolicyProcess::Send(const void* bytes, std::size_t count, const Limit& limit) {
  const auto end = Clock::now() + std::chrono::seconds(limit.seconds);
  const char* next = static_cast<const char*>(bytes);
  while (count > 0) {
    Await(POLLOUT, end, limit);
    const ssize_t sent = send(socket_, next, count, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (sent <= 0) Fail(kEnded);
    next += sent;
    count -= static_cast<std::size_t>(sent);
  }
}

void PolicyProcess::Receive(void* bytes, std::size_t count, const Limit& limit) {
  const auto end = Clock::now() + std::chrono::seconds(limit.seconds);
  char* next = static_cast<char*>(bytes);
  while (count > 0) {
    Await(POLLIN, end, limit);
    const ssize_t got = recv(socket_, next, count, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) Fail(kEnded);
    next += got;
    count -= static_cast<std::size_t>(got);
  }
}

void PolicyProcess::Act(const EnvironmentSpec& spec, const StepResults& results,
                        std::vector<std::uint8_t>& actions) {
  const MutexLock lock(mutex_);
  if (!broken_.empty()) throw InputError(broken_);
  std::string reported;
  try {
    reported = Ask(spec, results, actions);
  } catch (const std::exception& error) {
    broken_ = error.what();
    shutdown(socket_, SHUT_RDWR);  // so that no later request reads the remainder of this answer
    throw;
  }
  if (!reported.empty()) Fail(reported);
}

// Sends a request and receives the actions. Returns the error that the process reports instead, or
// an empty text.
std::string PolicyProcess::Ask(const EnvironmentSpec& spec, const StepResults& results,
                               std::vector<std::uint8_t>& actions) {
  const Observations seen = ObservationsOf(observation_types_, spec, results);
  const auto rows = static_cast<std::uint32_t>(results.legal.size());
  const std::array<std::uint32_t, 4> header{rows, seen.shape[0], seen.shape[1], seen.shape[2]};
  Send(header.data(), sizeof(header), answer_limit_);
  Send(seen.data, seen.size, answer_limit_);
  Send(results.legal.data(), results.legal.size() * sizeof(ActionMask), answer_limit_);
  std::uint32_t length = 0;  // bytes of an error; 0: actions follow
  Receive(&length, sizeof(length), answer_limit_);
  if (length > kMaxWords) {
    Fail("got an error of " + std::to_string(length) + " bytes, expected at most " +
         std::to_string(kMaxWords) + ": build again, so that serve_policy.py fits this program");
  }
  if (length > 0) {
    std::string words(length, '\0');
    Receive(words.data(), words.size(), answer_limit_);
    return words;
  }
  actions.resize(rows);
  Receive(actions.data(), rows, answer_limit_);
  for (const std::uint8_t action : actions) {
    if (action >= kActionCount) Fail("got action " + std::to_string(action) + ", expected [0, 9]");
  }
  return "";
}

std::unique_ptr<Policy> MakePythonPolicy(std::shared_ptr<PolicyProcess> process,
                                         const EnvironmentSpec& spec) {
  return std::make_unique<PythonPolicy>(std::move(process), spec);
}

}  // namespace aquafarm::agents
