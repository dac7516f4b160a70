// SPDX-License-Identifier: BSD-3-Clause
#include <dlfcn.h>
#include <gloo/rendezvous/context.h>
#include <gloo/transport/buffer.h>
#include <gloo/transport/pair.h>
#include <netdb.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <future>
#include <numeric>
#include <thread>
#include <torch/csrc/distributed/c10d/ProcessGroupGloo.hpp>
#include <torch/csrc/distributed/c10d/TCPStore.hpp>
#include <utility>

#include "aquafarm/agents/ranks/process_group.h"
#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

using Clock = std::chrono::steady_clock;
using Store = c10d::TCPStore;

// The store is in the process of rank 0. After a failure rank 0 keeps it open for this time, so
// that the other ranks can read which rank was lost.
constexpr std::chrono::seconds kStoreKept{2};
constexpr std::chrono::seconds kReportLimit{3};  // max wait for the store after a failure
constexpr int kNameTries = 5;                    // max look-ups if the name server fails at first
constexpr std::chrono::seconds kNamePause{1};    // between two look-ups
constexpr const char* kLost = "lost";  // key in the store: the first rank that was found lost
constexpr int kSlot = 0;               // one slot is enough: messages of a pair arrive in order

std::chrono::milliseconds Milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * seconds));
}

std::string Here(int rank) { return "here/" + std::to_string(rank); }

std::string RankOf(int rank, int size) {
  return "rank " + std::to_string(rank) + " of " + std::to_string(size);
}

std::string PlaceOf(const RankVariables& variables) {
  return variables.master_addr + " port " + std::to_string(variables.master_port);
}

// Silences glog, with which c10d logs each attempt to connect. The messages of this file contain
// the address anyway. If the user sets GLOG_minloglevel, that level applies.
void SilenceLog() {
  if (std::getenv("GLOG_minloglevel") != nullptr) return;
  constexpr int kFatal = 3;
  auto* const level = static_cast<int*>(dlsym(RTLD_DEFAULT, "_ZN3fLI17FLAGS_minloglevelE"));
  if (level != nullptr) *level = kFatal;
}

// Returns the first line of an error of c10d. Further lines contain its stack trace.
std::string FirstLine(const std::exception& error) {
  const std::string text = error.what();
  return text.substr(0, text.find('\n'));
}

// Returns the address of the interface through which this host reaches `host`; `host` itself if
// this address cannot be determined. The name of this host cannot be used, because it is often an
// alias of the loopback interface, which other hosts cannot reach.
std::string LocalAddress(const std::string& host) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), "9", &hints, &found) != 0) return host;
  char address[NI_MAXHOST] = "";
  for (const addrinfo* one = found; one != nullptr && address[0] == '\0'; one = one->ai_next) {
    const int s = socket(one->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_storage self{};
    socklen_t size = sizeof(self);
    // Connecting a datagram socket sends nothing; it selects the route.
    if (s >= 0 && connect(s, one->ai_addr, one->ai_addrlen) == 0 &&
        getsockname(s, reinterpret_cast<sockaddr*>(&self), &size) == 0) {
      getnameinfo(reinterpret_cast<sockaddr*>(&self), size, address, sizeof(address), nullptr, 0,
                  NI_NUMERICHOST);
    }
    if (s >= 0) close(s);
  }
  freeaddrinfo(found);
  return address[0] == '\0' ? host : address;
}

// Throws InputError if a name cannot be resolved. c10d would retry an unknown name until its time
// limit and not report the reason. The look-up runs in a thread, which may outlive the limit: a
// look-up cannot be interrupted if the name server does not answer.
void RequireKnownName(const std::string& host, double limit_s) {
  std::packaged_task<int()> task([host] {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    int code = EAI_AGAIN;
    for (int tries = 0; code == EAI_AGAIN && tries < kNameTries; ++tries) {
      if (tries > 0) std::this_thread::sleep_for(kNamePause);
      code = getaddrinfo(host.c_str(), nullptr, &hints, &found);
    }
    if (code == 0) freeaddrinfo(found);
    return code;
  });
  std::future<int> answer = task.get_future();
  std::thread(std::move(task)).detach();
  std::string reason = "the name server does not answer";
  if (answer.wait_for(Milliseconds(limit_s)) == std::future_status::ready) {
    const int code = answer.get();
    if (code == 0) return;
    reason = gai_strerror(code);
  }
  throw InputError("MASTER_ADDR: got '" + host + "', which this host cannot resolve (" + reason +
                   "); expected the address or name of the host of rank 0, as all ranks know it");
}

// Returns names of the processors on which this process may run, unique among all hosts.
std::vector<std::string> AllowedProcessors() {
  std::string boot;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), boot);
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof(allowed), &allowed) != 0) return {};
  std::vector<std::string> names;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(cpu, &allowed)) {
      names.push_back("processor/" + boot + "/" + std::to_string(cpu));
    }
  }
  return names;
}

class GlooGroup final : public ProcessGroup {
 public:
  GlooGroup(const RankVariables& variables, const GroupTimes& times);

  void Sum(std::vector<float>& values, std::vector<double>& numbers) override;
  std::vector<std::string> Gather(const std::string& bytes) override;
  std::string Broadcast(const std::string& bytes) override;
  void RunOnRank0(const std::function<void()>& work) override;

 private:
  void OpenStore(const RankVariables& variables, const GroupTimes& times);
  void ClaimProcessors();
  bool OwnsProcessors();
  void WaitForAll(const std::string& place, std::chrono::milliseconds left);
  void Connect(const RankVariables& variables, const GroupTimes& times);
  void Send(int peer, const void* data, std::size_t size) {
    gloo_->getPair(peer)->createSendBuffer(kSlot, const_cast<void*>(data), size)->send();
  }
  void Receive(int peer, void* data, std::size_t size) {
    gloo_->getPair(peer)->createRecvBuffer(kSlot, data, size)->waitRecv();
  }
  template <typename Exchange>
  void WithPeer(int peer, const Exchange& exchange);
  [[noreturn]] void Lose(int peer, const std::string& reason);

  c10::intrusive_ptr<Store> store_;
  std::shared_ptr<gloo::rendezvous::Context> gloo_;
  const std::chrono::milliseconds work_limit_;
  std::uint64_t works_{};  // number of calls of RunOnRank0
  std::vector<char> own_;  // scratch of Sum
  std::vector<char> other_;
};

GlooGroup::GlooGroup(const RankVariables& variables, const GroupTimes& times)
    : ProcessGroup(variables.rank, variables.world_size), work_limit_(Milliseconds(times.work_s)) {
  if ((size_ & (size_ - 1)) != 0) {
    throw InputError(variables.launcher + ": got " + std::to_string(size_) +
                     " ranks, expected a power of two: 1, 2, 4, 8, …");
  }
  SilenceLog();
  std::signal(SIGPIPE, SIG_IGN);  // Gloo may write to a rank that has ended
  const auto start = Clock::now();
  RequireKnownName(variables.master_addr, times.start_s);
  OpenStore(variables, times);
  const auto used = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - start);
  const auto left = Milliseconds(times.start_s) - used;
  WaitForAll(PlaceOf(variables), std::max(left, std::chrono::milliseconds(100)));
  Connect(variables, times);
}

void GlooGroup::OpenStore(const RankVariables& variables, const GroupTimes& times) {
  const std::string place = PlaceOf(variables);
  c10d::TCPStoreOptions options;
  options.port = static_cast<std::uint16_t>(variables.master_port);
  options.isServer = rank_ == 0;
  options.waitWorkers = false;
  options.timeout = Milliseconds(times.start_s);
  try {
    store_ = c10::make_intrusive<Store>(variables.master_addr, options);
    ClaimProcessors();
    store_->set(Here(rank_), std::vector<std::uint8_t>{1});
  } catch (const std::exception& error) {
    if (rank_ == 0) {
      throw RankLost("ranks: rank 0 cannot open " + place +
                     " (MASTER_ADDR, MASTER_PORT): expected an address of this host and a free "
                     "port: " +
                     FirstLine(error));
    }
    throw RankLost("ranks: " + RankOf(rank_, size_) + " cannot reach rank 0 at " + place +
                   " (MASTER_ADDR, MASTER_PORT) within " +
                   std::to_string(static_cast<int>(times.start_s)) +
                   " s: check that rank 0 runs there and that no firewall closes the port");
  }
}

// The store counts, for each processor, the ranks that may run on it. Adds 1 to the counts of the
// processors of this rank.
void GlooGroup::ClaimProcessors() {
  for (const std::string& processor : AllowedProcessors()) store_->add(processor, 1);
}

// Returns whether this rank shares none of its processors with another rank. If so, it polls while
// it waits, which avoids the delay of a wake-up. Ranks that share a processor must not poll,
// because a polling rank takes processor time from the ranks that work.
bool GlooGroup::OwnsProcessors() {
  const std::vector<std::string> processors = AllowedProcessors();
  return !processors.empty() && std::all_of(processors.begin(), processors.end(),
                                            [&](const auto& p) { return store_->add(p, 0) == 1; });
}

void GlooGroup::WaitForAll(const std::string& place, std::chrono::milliseconds left) {
  std::vector<std::string> keys;
  keys.reserve(static_cast<std::size_t>(size_));
  for (int rank = 0; rank < size_; ++rank) keys.push_back(Here(rank));
  try {
    store_->wait(keys, left);
    return;
  } catch (const std::exception&) {
  }
  std::string missing;
  try {
    for (int rank = 0; rank < size_; ++rank) {
      if (!store_->check({Here(rank)})) missing += " " + std::to_string(rank);
    }
  } catch (const std::exception&) {  // the store ended with rank 0
    throw RankLost("ranks: " + RankOf(0, size_) + " at " + place +
                   " (MASTER_ADDR, MASTER_PORT) ended at the start, or another program answers "
                   "there; see its output");
  }
  if (missing.empty()) return;  // the last rank started after the time limit of wait
  if (rank_ == 0) std::this_thread::sleep_for(kStoreKept);
  throw RankLost("ranks: of " + std::to_string(size_) +
                 " ranks these have not started in time:" + missing +
                 "; check their hosts and their output, or give more time by --rank-start "
                 "(rank_start_s in ROS)");
}

void GlooGroup::Connect(const RankVariables& variables, const GroupTimes& times) {
  try {
    store_->setTimeout(Milliseconds(times.start_s));
    const char* const interface = std::getenv("GLOO_SOCKET_IFNAME");
    std::shared_ptr<gloo::transport::Device> device =
        interface != nullptr
            ? c10d::ProcessGroupGloo::createDeviceForInterface(interface)
            : c10d::ProcessGroupGloo::createDeviceForHostname(LocalAddress(variables.master_addr));
    gloo_ = std::make_shared<gloo::rendezvous::Context>(rank_, size_);
    gloo_->setTimeout(Milliseconds(times.answer_s));
    c10d::ProcessGroupGloo::GlooStore store(store_);
    gloo_->connectFullMesh(store, device);
    // In sync mode the calling thread reads and writes. Without it the thread of the device does,
    // and each message waits for the wake-up of that thread (docs/decisions/ranks.md).
    const bool polls = OwnsProcessors();
    for (int peer = 0; peer < size_; ++peer) {
      if (peer != rank_) gloo_->getPair(peer)->setSync(true, polls);
    }
  } catch (const std::exception& error) {
    if (rank_ == 0) std::this_thread::sleep_for(kStoreKept);
    throw RankLost("ranks: " + RankOf(rank_, size_) +
                   " cannot connect with the other ranks; name the network interface by "
                   "GLOO_SOCKET_IFNAME: " +
                   FirstLine(error));
  }
}

template <typename Exchange>
void GlooGroup::WithPeer(int peer, const Exchange& exchange) {
  const auto start = Clock::now();
  std::string failure;
  try {
    exchange();
  } catch (const std::exception& error) {
    failure = FirstLine(error);
  }
  exchange_s_ += std::chrono::duration<double>(Clock::now() - start).count();
  if (!failure.empty()) Lose(peer, failure);
}

// Reports a lost rank in the store and throws RankLost. A rank that ends because another one was
// lost appears lost, too. Therefore all ranks name the rank that was reported first. The report
// runs in a thread, which may outlive kReportLimit: calls of the store have no time limit if the
// host of rank 0 does not answer.
void GlooGroup::Lose(int peer, const std::string& reason) {
  std::packaged_task<int()> report([store = store_, text = std::to_string(peer)] {
    const std::vector<std::uint8_t> first =
        store->compareSet(kLost, {}, std::vector<std::uint8_t>(text.begin(), text.end()));
    return std::atoi(std::string(first.begin(), first.end()).c_str());
  });
  std::future<int> answer = report.get_future();
  std::thread(std::move(report)).detach();
  int lost = 0;  // rank 0 is lost if its store does not answer
  try {
    if (answer.wait_for(kReportLimit) == std::future_status::ready) lost = answer.get();
  } catch (const std::exception&) {  // the store ended with rank 0
  }
  gloo_.reset();  // the peers notice the closed connection at once, and then read the report
  if (rank_ == 0) std::this_thread::sleep_for(kStoreKept);
  throw RankLost("ranks: " + RankOf(lost, size_) +
                 " has ended or does not answer; see its output, then resume the run with any "
                 "number of ranks (" +
                 reason + ")");
}

// Recursive doubling: after round k each rank has the sum of its block of 2^k ranks. Both ranks of
// a pair compute the same bits, since the sum of two floats does not depend on their order.
void GlooGroup::Sum(std::vector<float>& values, std::vector<double>& numbers) {
  const std::size_t value_bytes = values.size() * sizeof(float);
  const std::size_t bytes = value_bytes + numbers.size() * sizeof(double);
  if (bytes == 0) return;
  own_.resize(bytes);
  other_.resize(bytes);
  for (int step = 1; step < size_; step *= 2) {
    const int peer = rank_ ^ step;
    std::memcpy(own_.data(), values.data(), value_bytes);
    std::memcpy(own_.data() + value_bytes, numbers.data(), bytes - value_bytes);
    // One rank sends first, the other one receives first. If both sent first, and the message were
    // larger than the buffers of the sockets, both would wait forever.
    WithPeer(peer, [&] {
      if (rank_ < peer) Send(peer, own_.data(), bytes);
      Receive(peer, other_.data(), bytes);
      if (rank_ > peer) Send(peer, own_.data(), bytes);
    });
    const char* from = other_.data();
    for (float& value : values) {
      float added = 0.0F;
      std::memcpy(&added, from, sizeof(added));
      value += added;
      from += sizeof(added);
    }
    for (double& number : numbers) {
      double added = 0.0;
      std::memcpy(&added, from, sizeof(added));
      number += added;
      from += sizeof(added);
    }
  }
}

// Sends the bytes up the binary tree of ranks, so that rank 0 receives from log2(size) ranks. With
// 4 ranks: 1 → 0 and 3 → 2, then 2 → 0. After round k a receiver has the bytes of its own rank and
// of the next 2^k − 1 ranks.
std::vector<std::string> GlooGroup::Gather(const std::string& bytes) {
  std::vector<std::string> block{bytes};
  for (int step = 1; step < size_; step *= 2) {
    std::vector<std::uint64_t> sizes(static_cast<std::size_t>(step));
    const std::size_t header = sizes.size() * sizeof(sizes[0]);
    std::string all;
    if ((rank_ & step) != 0) {
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        sizes[i] = block[i].size();
        all += block[i];
      }
      const int peer = rank_ - step;
      WithPeer(peer, [&] {
        Send(peer, sizes.data(), header);
        if (!all.empty()) Send(peer, all.data(), all.size());
      });
      return {};
    }
    const int peer = rank_ + step;
    WithPeer(peer, [&] {
      Receive(peer, sizes.data(), header);
      all.resize(std::accumulate(sizes.begin(), sizes.end(), std::size_t{0}));
      if (!all.empty()) Receive(peer, all.data(), all.size());
    });
    std::size_t begin = 0;
    for (const std::uint64_t size : sizes) {
      block.push_back(all.substr(begin, size));
      begin += size;
    }
  }
  return block;
}

// Sends the bytes down the binary tree of ranks. With 8 ranks: 0 → 4, then 0 → 2 and 4 → 6, ….
std::string GlooGroup::Broadcast(const std::string& bytes) {
  std::string all = rank_ == 0 ? bytes : std::string();
  for (int step = size_ / 2; step > 0; step /= 2) {
    const int place = rank_ % (2 * step);
    std::uint64_t size = all.size();
    if (place == 0) {
      const int peer = rank_ + step;
      WithPeer(peer, [&] {
        Send(peer, &size, sizeof(size));
        if (size > 0) Send(peer, all.data(), all.size());
      });
    } else if (place == step) {
      const int peer = rank_ - step;
      WithPeer(peer, [&] {
        Receive(peer, &size, sizeof(size));
        all.resize(size);
        if (size > 0) Receive(peer, all.data(), all.size());
      });
    }
  }
  return all;
}

// The other ranks wait for a key of the store, because such a wait has its own time limit. A thread
// of rank 0 serves the store, so the other ranks notice at once if that process ends.
void GlooGroup::RunOnRank0(const std::function<void()>& work) {
  const std::string done = "work/" + std::to_string(works_++);
  if (rank_ == 0) {
    work();
    WithPeer(0, [&] { store_->set(done, std::vector<std::uint8_t>{1}); });
    return;
  }
  WithPeer(0, [&] {
    try {
      store_->wait({done}, work_limit_);
    } catch (const std::exception& error) {
      throw std::runtime_error("it did not read or write the run folder within " +
                               std::to_string(work_limit_.count() / 1000) +
                               " s: " + FirstLine(error));
    }
  });
}

}  // namespace

std::unique_ptr<ProcessGroup> JoinProcessGroup(const RankVariables& variables,
                                               const GroupTimes& times) {
  return std::make_unique<GlooGroup>(variables, times);
}

}  // namespace aquafarm::agents
