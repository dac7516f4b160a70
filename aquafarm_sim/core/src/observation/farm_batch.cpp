// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/farm_batch.h"

#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <exception>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "aquafarm/base/cbor.h"
#include "aquafarm/base/check.h"
#include "aquafarm/observation/for_each_farm.h"

namespace aquafarm {
namespace {

// Returns whether this process may use OpenMP. OpenMP's threads do not survive a fork: if the
// parent process has started them, a parallel region in the child waits for them forever. Returns
// false in a process if its parent or an earlier ancestor called this function before the fork.
bool MayUseThreads() {
  static std::atomic<pid_t> owner{0};
  pid_t expected = 0;
  const pid_t self = getpid();
  return owner.compare_exchange_strong(expected, self) || expected == self;
}

}  // namespace

void ForEachFarm(std::int32_t count, std::int32_t threads,
                 const std::function<void(std::int32_t i, std::int32_t thread)>& body) {
  if (threads == 1 || !MayUseThreads()) {
    for (std::int32_t i = 0; i < count; ++i) body(i, 0);
    return;
  }
  std::exception_ptr failure;  // exceptions must not leave the parallel region
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::int32_t i = 0; i < count; ++i) {
    try {
      body(i, omp_get_thread_num());
    } catch (...) {
#pragma omp critical(aquafarm_for_each_farm_failure)
      failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

FarmBatch::FarmBatch(std::shared_ptr<const Scenario> scenario, std::int32_t farms,
                     std::int32_t threads)
    : scenario_(std::move(scenario)),
      encoder_(*scenario_),
      agents_(scenario_->AgentCount()),
      threads_(std::max(1, std::min(threads, farms))) {
  AQUAFARM_CHECK_GE(farms, 1);
  if (scenario_->family) {
    throw InputError("scenario " + scenario_->name +
                     ": is a family of ranches, expected one ranch; aquafarm_train and "
                     "aquafarm_evaluate draw ranches of a family");
  }
  farms_.reserve(static_cast<std::size_t>(farms));
  farms_.emplace_back(scenario_);
  const bool fixed = scenario_->layout == LayoutMode::kFixed;
  const std::shared_ptr<const Layout> layout = fixed ? farms_[0].shared_layout() : nullptr;
  for (std::int32_t i = 1; i < farms; ++i) farms_.emplace_back(scenario_, layout);
  strides_.assign(farms_.size(), static_cast<std::uint64_t>(farms));
  views_.resize(static_cast<std::size_t>(threads_));
}

StepShape FarmBatch::shape() const {
  return {farms_.size(), static_cast<std::size_t>(agents_),
          static_cast<std::size_t>(encoder_.feature_count()), encoder_.planes_size()};
}

void FarmBatch::Reset(std::uint64_t seed, std::uint64_t first_episode, const BatchOutput& output,
                      std::uint64_t stride) {
  if (stride == 0) stride = static_cast<std::uint64_t>(farms());
  for (std::int32_t i = 0; i < farms(); ++i) {
    Start(i, seed, first_episode + static_cast<std::uint64_t>(i), stride, output);
  }
}

void FarmBatch::Start(std::int32_t i, std::uint64_t seed, std::uint64_t episode,
                      std::uint64_t stride, const BatchOutput& output) {
  set_stride(i, stride);
  farm(i).Reset(seed, episode);
  WriteOne(i, 0, true, output);
}

void FarmBatch::set_stride(std::int32_t i, std::uint64_t stride) {
  AQUAFARM_CHECK_GE(stride, 1U);
  strides_[static_cast<std::size_t>(i)] = stride;
}

void FarmBatch::StartNext(std::int32_t i) {
  Farm& next = farm(i);
  next.Reset(next.seed(), next.episode() + stride(i));
}

void FarmBatch::StartNext(std::int32_t i, const BatchOutput& output) {
  StartNext(i);
  WriteOne(i, 0, true, output);
}

void FarmBatch::Step(const std::uint8_t* actions, const BatchOutput& output) {
  if (threads_ == 1) {  // faster than ForEachFarm, which calls a std::function for each farm
    for (std::int32_t i = 0; i < farms(); ++i) {
      if (i + 1 < farms()) farm(i + 1).Prefetch();
      StepOne(i, 0, actions, output);
    }
    return;
  }
  const auto step = [&](std::int32_t i, std::int32_t thread) {
    StepOne(i, thread, actions, output);
  };
  ForEachFarm(farms(), threads_, std::cref(step));
}

void FarmBatch::StepOne(std::int32_t i, std::int32_t thread, const std::uint8_t* actions,
                        const BatchOutput& output) {
  const bool starts = farm(i).over();
  if (starts) {
    StartNext(i);
  } else {
    farm(i).Step(actions + static_cast<std::ptrdiff_t>(i) * agents_);
  }
  WriteOne(i, thread, starts, output);
}

void FarmBatch::Write(const BatchOutput& output) {
  for (std::int32_t i = 0; i < farms(); ++i) WriteOne(i, 0, farm(i).step() == 0, output);
}

void FarmBatch::WriteOne(std::int32_t i, std::int32_t thread, bool is_first,
                         const BatchOutput& output) {
  WriteFarm(farm(i), encoder_, static_cast<std::size_t>(i), is_first,
            views_[static_cast<std::size_t>(thread)], output);
}

void WriteFarm(const Farm& farm, const Encoder& encoder, std::size_t n, bool is_first, View& view,
               const BatchOutput& output) {
  if (output.end_reasons != nullptr) {
    output.end_reasons[n] = static_cast<std::uint8_t>(farm.record().reason);
  }
  if (output.is_first != nullptr) output.is_first[n] = is_first ? 1 : 0;
  if (output.hashes != nullptr) output.hashes[n] = farm.Hash();
  const std::vector<Ship>& ships = farm.ships();
  for (std::size_t id = 0; id < ships.size(); ++id) {
    const Ship& ship = ships[id];
    const auto agent = static_cast<std::int32_t>(id);
    const std::size_t k = n * ships.size() + id;
    if (output.rewards != nullptr) output.rewards[k] = ship.reward;
    if (output.terms != nullptr) {
      std::memcpy(output.terms + k * kRewardTermCount, &ship.terms, sizeof(ship.terms));
    }
    if (output.energy != nullptr) output.energy[k] = static_cast<float>(ship.energy);
    if (output.distance != nullptr) output.distance[k] = static_cast<float>(ship.distance);
    if (output.outcomes != nullptr) output.outcomes[k] = static_cast<std::uint8_t>(ship.outcome);
    if (output.legal != nullptr) output.legal[k] = farm.LegalActions(agent);
    if (output.active != nullptr) output.active[k] = ship.active ? 1 : 0;
    if (output.index != nullptr) output.index[k] = encoder.Index(farm, agent);
    if (output.features == nullptr && output.planes == nullptr) continue;
    Observe(farm, agent, view);
    if (output.features != nullptr) {
      encoder.Features(view,
                       output.features + k * static_cast<std::size_t>(encoder.feature_count()));
    }
    if (output.planes != nullptr) {
      encoder.Planes(view, output.planes + k * encoder.planes_size());
    }
  }
}

std::string FarmBatch::Save() const {
  nlohmann::json states = nlohmann::json::array();
  for (const Farm& one : farms_) {
    const std::string bytes = one.Save();
    states.push_back(nlohmann::json::binary({bytes.begin(), bytes.end()}));
  }
  std::string bytes;
  nlohmann::json::to_cbor(states, bytes);
  return bytes;
}

void FarmBatch::Load(const std::string& bytes) {
  std::vector<Farm> loaded;
  try {
    const nlohmann::json states = ParseCbor(bytes);
    if (!states.is_array() || states.size() != farms_.size()) {
      throw InputError("state: got " + std::to_string(states.size()) + " farms, expected " +
                       std::to_string(farms_.size()));
    }
    loaded.reserve(farms_.size());
    for (std::size_t i = 0; i < farms_.size(); ++i) {
      const auto& state = states[i].get_binary();
      const bool fixed = scenario_->layout == LayoutMode::kFixed;
      loaded.emplace_back(scenario_, fixed ? farms_[0].shared_layout() : nullptr);
      loaded.back().Load(std::string(state.begin(), state.end()));
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(std::string("state: damaged bytes: ") + error.what());
  }
  farms_ = std::move(loaded);
}

}  // namespace aquafarm
