// SPDX-License-Identifier: BSD-3-Clause
#include "training/pending_steps.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

static_assert(std::is_trivially_copyable_v<EpisodeSummary>);

template <typename T>
void Append(const std::vector<T>& values, std::string& bytes) {
  const std::uint64_t count = values.size();
  bytes.append(reinterpret_cast<const char*>(&count), sizeof(count));
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

template <typename T>
void Take(const std::string& bytes, std::size_t& at, std::vector<T>& values) {
  std::uint64_t count = 0;
  if (bytes.size() - at >= sizeof(count)) std::memcpy(&count, bytes.data() + at, sizeof(count));
  at = std::min(bytes.size(), at + sizeof(count));
  if (count > (bytes.size() - at) / sizeof(T)) {
    throw InputError("ranks: got " + std::to_string(bytes.size()) +
                     " bytes of episodes, expected more: another rank runs another program; start "
                     "the same one on all hosts");
  }
  values.resize(count);
  if (count > 0) std::memcpy(values.data(), bytes.data() + at, count * sizeof(T));
  at += count * sizeof(T);
}

}  // namespace

void PendingSteps::Add(const StepResults& results) {
  for (const EpisodeSummary& episode : results.finished) {
    calls_.push_back(steps_.size());
    finished_.push_back(episode);
  }
  steps_.push_back(static_cast<std::uint64_t>(
      std::count(results.is_first.begin(), results.is_first.end(), std::uint8_t{0})));
}

void PendingSteps::Clear() {
  steps_.clear();
  calls_.clear();
  finished_.clear();
}

std::string PendingSteps::ToBytes() const {
  std::string bytes;
  Append(steps_, bytes);
  Append(calls_, bytes);
  Append(finished_, bytes);
  return bytes;
}

PendingSteps PendingSteps::FromBytes(const std::string& bytes) {
  PendingSteps pending;
  std::size_t at = 0;
  Take(bytes, at, pending.steps_);
  Take(bytes, at, pending.calls_);
  Take(bytes, at, pending.finished_);
  AQUAFARM_CHECK_EQ(pending.calls_.size(), pending.finished_.size());
  return pending;
}

}  // namespace aquafarm::agents
